# SPDX-License-Identifier: Apache-2.0
"""Who may do what, asked without a browser; and how the server says that it cannot begin."""

import asyncio
import http.client
import json
import socket
import subprocess
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Callable
from contextlib import suppress
from ipaddress import ip_network
from pathlib import Path
from types import SimpleNamespace

import pytest
import uvicorn
from levelwind.errors import ToolError
from levelwind.line.port import Line, tcp_address
from levelwind.serve import guard, web
from levelwind.serve.gateway import networks
from levelwind.serve.guard import TRIES, PinFile
from levelwind.serve.run import Setting, warnings
from served import PIN, TOOL, RawTcp, Served, free_port, wait
from starlette.responses import Response
from starlette.types import Receive, Scope, Send
from websockets.exceptions import WebSocketException
from websockets.sync.client import connect

Start = Callable[..., Served]


def post(served: Served, path: str, body: object, **headers: str) -> tuple[int, dict, str]:
    """Status, answer, cookie."""
    data = body if isinstance(body, bytes) else json.dumps(body).encode()
    request = urllib.request.Request(served.url + path, data, headers)
    try:
        with urllib.request.urlopen(request, timeout=60) as answer:
            return answer.status, json.loads(answer.read()), answer.headers.get("set-cookie", "")
    except urllib.error.HTTPError as error:
        text = error.read()
        return error.code, json.loads(text) if text.startswith(b"{") else {"text": text}, ""


def status_of(served: Served, path: str, **headers: str) -> int:
    try:
        served.get(path, headers)
    except urllib.error.HTTPError as error:
        return error.code
    return 200


def test_host_and_origin(start: Start) -> None:
    served = start("--allow-commands", "--name", "Winch.local")
    here = f"127.0.0.1:{served.web}"
    for host in (
        here,
        f"localhost:{served.web}",
        f"winch.local:{served.web}",
        "WINCH.local.",
        f"[::1]:{served.web}",
    ):
        assert status_of(served, "", Host=host) == 200, host
    for host in (
        "evil.example",
        f"evil.example:{served.web}",
        "10.0.0.1",
        "",
        "127.0.0.1.evil.example",
    ):
        assert status_of(served, "", Host=host) in (400, 421), host
    assert status_of(served, "", Origin=f"http://{here}") == 200
    for origin in ("http://evil.example", "null", f"http://localhost:{served.web}", "http://[::1"):
        assert status_of(served, "", Origin=origin) == 403, origin
        assert post(served, "api/pin", {"pin": PIN}, Origin=origin)[0] == 403
        with pytest.raises(WebSocketException):
            connect(f"ws://{here}/live", origin=origin)
    with connect(f"ws://{here}/live", origin=f"http://{here}") as live:
        assert "trend" in json.loads(live.recv(5))


def test_nothing_without_the_pin(start: Start) -> None:
    served = start("--allow-commands")
    wait(served.sees)
    for body in ({"name": "index"}, {"name": "stage", "values": {"pitch_um": 11000}}, {}, [], b"x"):
        assert post(served, "api/act", body)[0] == 403
        assert post(served, "api/act", body, Cookie="levelwind=guess")[0] == 403
    with connect(f"ws://127.0.0.1:{served.web}/live") as live:
        for text in ('{"jog": 1}', "[]", "x", '{"jog": "1"}', "{}"):
            live.send(text)
        for _ in range(5):
            live.recv(5)
    with served.device() as device:
        assert device.value("command_sequence") == 0
        assert device.value("pitch_um") == 12_000


def test_look_only_refuses_the_right_pin(start: Start) -> None:
    served = start()
    status, said, cookie = post(served, "api/pin", {"pin": PIN})
    assert (status, cookie) == (403, "")
    assert "only look" in said["text"]


def test_pin_session_and_actions(start: Start) -> None:
    served = start("--allow-commands")
    status, _, cookie = post(served, "api/pin", {"pin": PIN})
    assert status == 200
    assert "HttpOnly" in cookie
    assert "samesite=strict" in cookie.lower()
    mine = cookie.partition(";")[0]
    assert post(served, "api/act", {"name": "index"}, Cookie=mine)[0] == 200
    status, said, _ = post(served, "api/act", {"name": "save"}, Cookie=mine)
    assert status == 409, "the carriage follows: no save"
    assert said["text"]
    for bad in ("../etc", "none", "", "factory_all"):
        assert post(served, "api/act", {"name": bad}, Cookie=mine)[0] == 409
    assert post(served, "api/leave", {}, Cookie=mine)[0] == 200
    assert post(served, "api/act", {"name": "stop"}, Cookie=mine)[0] == 403


def test_two_servers_of_a_machine_have_a_session_each(start: Start) -> None:
    """Two drums: a browser keeps one cookie of a name for a host, whatever the port."""
    names = [
        post(start("--allow-commands"), "api/pin", {"pin": PIN})[2].partition("=")[0]
        for _ in range(2)
    ]
    assert names[0] != names[1]


NO_JSON = [b"[" * 16_000, b'{"pin": "\\ud800"}', b"\xff", b"", b"[]", b"{}", b'{"pin": 2468}']


def test_what_is_no_request_is_told_so(start: Start) -> None:
    """Nothing of it is a fault of the server, a try of the PIN, or the end of a connection."""
    served = start("--allow-commands", write=False)
    for body in NO_JSON:
        assert post(served, "api/pin", body)[:2] == (403, {"text": "Give the PIN."}), body
    with socket.create_connection(("127.0.0.1", served.web), 5) as cut:  # in its body
        head = (
            f"POST /api/pin HTTP/1.1\r\nHost: 127.0.0.1:{served.web}\r\nContent-Length: 9\r\n\r\n"
        )
        cut.sendall(head.encode() + b"123")
    mine = post(served, "api/pin", {"pin": PIN})[2].partition(";")[0]
    for body in NO_JSON:
        assert post(served, "api/act", body, Cookie=mine)[0] == 409, body
    for metres in ("\ud800", "NaN", "1e400", "", None, [], {}):
        body = {"name": "set_rope", "metres": metres}
        assert post(served, "api/act", body, Cookie=mine)[0] == 409, metres
    for values in ({"pitch_um": "\ud800"}, {"\ud800": 1}, {"pitch_um": 1e400}, {"pitch_um": [[]]}):
        body = {"name": "stage", "values": values}
        assert post(served, "api/act", body, Cookie=mine)[0] == 409, values
    at = f"ws://127.0.0.1:{served.web}/live"
    with connect(at, additional_headers={"Cookie": mine}) as live:
        for text in ("[" * 4000, '{"jog": 1e999}', '{"jog": NaN}', '{"jog": "\\ud800"}', "\0"):
            live.send(text)
        for _ in range(5):
            live.recv(5)
    assert served.stop() in (0, 130)
    assert (served.folder / "stderr").read_text() == ""


def test_wrong_pins_are_slowed_down(start: Start) -> None:
    served = start("--allow-commands")
    codes = [post(served, "api/pin", {"pin": f"{n:04}"})[0] for n in range(TRIES + 2)]
    assert codes == [403] * TRIES + [429] * 2
    assert post(served, "api/pin", {"pin": PIN})[0] == 429, "the right one has to wait, too"


def test_pin_is_kept_hashed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    modes = []
    replace = Path.replace

    def look(self: Path, target: Path) -> Path:
        modes.append(self.stat().st_mode & 0o777)
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", look)
    pin = PinFile(tmp_path / "folder" / "pin.json")
    for bad in ("123", "x" * 65):
        with pytest.raises(ToolError):
            pin.set(bad)
    pin.set("2468")
    first = pin.path.read_text()
    assert "2468" not in first
    assert modes == [0o600], "not even for a moment"
    assert pin.fits("2468")
    assert not pin.fits("2469")
    pin.set("2468")
    assert pin.path.read_text() != first, "salted"
    pin.path.write_text("{}")
    assert not pin.fits("2468")


def test_sizes_and_paths(start: Start, tmp_path: Path) -> None:
    served = start("--allow-commands", "--record", str(tmp_path / "launches.sqlite"))
    assert post(served, "api/pin", {"pin": "9" * 20_000})[0] == 413
    assert post(served, "api/pin", [[[]]])[0] == 403
    with socket.create_connection(("127.0.0.1", served.web), 5) as raw:  # a body without an end
        head = f"POST /api/pin HTTP/1.1\r\nHost: 127.0.0.1:{served.web}\r\n"
        head += "Transfer-Encoding: chunked\r\n\r\n"
        raw.sendall(head.encode())
        piece = b"1000\r\n" + b"9" * 0x1000 + b"\r\n"
        raw.settimeout(5)
        with pytest.raises(OSError):
            for _ in range(2000):
                raw.sendall(piece)
            raise AssertionError("it takes everything")
    for path in (
        "../pin.json", "..%2f..%2fpin.json", "%2e%2e/pin.json", "page/../web.py", "web.py",
        "api/launches/1/../../pin.json", "api/launches/-1/picture.png",
        "api/launches/x/samples.csv",
        "api/launches/999/samples.csv", "api/launches/99999999999999999999/samples.csv",
    ):  # fmt: skip
        assert status_of(served, path) in (400, 404), path
    with connect(f"ws://127.0.0.1:{served.web}/live") as live:
        live.send("x" * 5000)
        with pytest.raises(WebSocketException):
            for _ in range(100):
                live.recv(5)
    wait(served.sees)


def test_too_many_clients_keep_nobody_out(start: Start) -> None:
    """The one that has asked nothing for the longest goes, not one that asks."""
    served = start()
    wait(served.sees)
    plc = RawTcp(served.gate)
    idle = [socket.create_connection(("127.0.0.1", served.gate), 5) for _ in range(40)]
    assert plc.request(bytes([4, 0, 100, 0, 1]))[0] == 4
    idle += [socket.create_connection(("127.0.0.1", served.gate), 5) for _ in range(40)]
    wait(lambda: sum(_is_hung_up(one) for one in idle) >= 17, what="room")
    assert plc.request(bytes([4, 0, 100, 0, 1]))[0] == 4
    late = RawTcp(served.gate)
    assert late.request(bytes([4, 0, 100, 0, 1]))[0] == 4
    for one in (*idle, plc, late):
        one.close()


def silent(number: int, port: int) -> list[socket.socket]:
    """Connections that say nothing, or begin a request, or its body."""
    head = f"POST /api/pin HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: 100\r\n\r\n"
    begun = [socket.create_connection(("127.0.0.1", port), 5) for _ in range(number)]
    for index, one in enumerate(begun):
        one.sendall(head.encode()[: (0, 30, 200)[index % 3]])
    return begun


def test_connections_that_say_nothing_keep_nobody_out(start: Start) -> None:
    served = start("--allow-commands")
    wait(served.sees)
    idle = silent(300, served.web)
    assert served.sees()
    assert post(served, "api/pin", {"pin": PIN})[0] == 200, "they count as no tries"
    assert len(list(Path(f"/proc/{served.process.pid}/fd").iterdir())) < 200
    for one in idle:
        one.close()


def test_a_request_has_to_come_whole_in_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """And an answer to be taken up; who asks again and again stays, as does a long answer."""
    monkeypatch.setattr(guard, "REQUEST_S", 0.3)
    monkeypatch.setattr(guard, "LOOK_S", 0.05)

    async def app(scope: Scope, receive: Receive, send: Send) -> None:
        await receive()
        long = scope["path"] == "/long"
        await asyncio.sleep(0.6 if long else 0)
        await Response(b"1" if long else b"1" * 30_000_000)(scope, receive, send)

    with socket.create_server(("127.0.0.1", 0)) as listening:
        port = listening.getsockname()[1]
        server = uvicorn.Server(uvicorn.Config(app, http=guard.PatientHttp, lifespan="off"))
        thread = threading.Thread(target=server.run, args=([listening],), daemon=True)
        thread.start()
        deaf = socket.create_connection(("127.0.0.1", port), 5)
        deaf.sendall(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n")
        for one in silent(3, port):
            one.settimeout(3)
            with suppress(ConnectionResetError):
                assert one.recv(1) == b""
        asking = http.client.HTTPConnection("127.0.0.1", port, timeout=5)
        for _ in range(3):
            asking.request("GET", "/long")
            assert asking.getresponse().read() == b"1"
        taken = 0
        with suppress(ConnectionResetError):
            while piece := deaf.recv(1 << 20):
                taken += len(piece)
        assert taken < 20_000_000, "hung up on"
        asking.close()
        server.should_exit = True
        thread.join(10)


def test_records_and_parameters_are_asked_for_one_at_a_time() -> None:
    """Thirty pictures at once would take the processor from the live values."""
    page = web.Page(web.Served(None, SimpleNamespace(look_again=lambda: None), None, None))
    busy, most = 0, 0

    def work(*_: object) -> str:
        nonlocal busy, most
        busy += 1
        most = max(most, busy)
        time.sleep(0.02)  # work, that others could be beside
        busy -= 1
        return "1"

    page._launches = lambda: SimpleNamespace(picture=work, csv=work, list=work)
    request = SimpleNamespace(path_params={"number": 1})

    async def ask(*what: Callable) -> int:
        nonlocal most
        most = 0
        await asyncio.gather(*(one(request) for one in what for _ in range(5)))
        return most

    assert asyncio.run(ask(page.launch_picture, page.launch_csv, page.launches)) == 1
    page.operator.parameters = work
    assert asyncio.run(ask(page.parameters)) == 1


def _is_hung_up(connection: socket.socket) -> bool:
    connection.settimeout(0.05)
    try:
        return connection.recv(1) == b""
    except TimeoutError:
        return False
    except OSError:
        return True


def test_no_other_site_may_frame_it(start: Start) -> None:
    served = start()
    with urllib.request.urlopen(served.url, timeout=5) as answer:
        assert "default-src 'self'" in answer.headers["content-security-policy"]
        assert "frame-ancestors 'none'" in answer.headers["content-security-policy"]
        assert "server" not in answer.headers


def test_networks_of_either_form() -> None:
    assert networks(["10.0.0.0/8", "192.168.1.7", "10.0.0.0/255.255.0.0", "::1"]) == [
        *map(ip_network, ("10.0.0.0/8", "192.168.1.7", "10.0.0.0/16", "::1"))
    ]
    assert networks(["::ffff:10.0.0.0/104"]) == [ip_network("10.0.0.0/8")]
    for bad in ("10.0.0.5/24", "10.0.0.0/33", "localhost", "10.0.0.0/255.0.255.0", "", "/8", "*"):
        with pytest.raises(ToolError, match="--write-from"):
            networks([bad])


def test_warnings_in_words() -> None:
    line = Line("/tmp/levelwind")
    assert warnings(Setting(line, "127.0.0.1:8080", "localhost:1502")) == []
    open_ = warnings(Setting(line, "0.0.0.0:8080", "[::]:1502"))
    assert len(open_) == 2
    assert "Nothing is encrypted" in open_[0]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--port", "/nowhere/port"], "There is no port /nowhere/port"),
        (["--port", "tcp://127.0.0.1:1"], "cannot be reached: Connection refused"),
        (["--listen", "8080"], "--listen 8080: give HOST:PORT"),
        (["--listen", "127.0.0.1:99999"], "give HOST:PORT"),
        (["--listen", "no.such.name.invalid:8080"], "--listen no.such.name.invalid:8080"),
        (["--listen", "BUSY"], "Address already in use"),
        (["--modbus-tcp", "BUSY"], "--modbus-tcp 127.0.0.1"),
        (["--record", "/nowhere/launches.sqlite"], "--record /nowhere/launches.sqlite: unable"),
        (["--write-from", "10.0.0.0/8"], "--write-from: it is for clients of --modbus-tcp"),
        (["--modbus-tcp", "127.0.0.1:0", "--write-from", "10.0.0.0/99"], "Give one as 192.168"),
        (["--name", "winch.local:8080"], "--name winch.local:8080: give the name alone"),
        (["--allow-commands", "--pin-file", "/nowhere/pin"], "there is no PIN in /nowhere/pin"),
    ],
)
def test_it_says_in_one_line_why_it_cannot_begin(
    start: Start, options: list[str], said: str
) -> None:
    served = start()
    served.stop()
    with socket.create_server(("127.0.0.1", 0)) as busy:
        at = f"127.0.0.1:{busy.getsockname()[1]}"
        given = [at if option == "BUSY" else option for option in options]
        port = [] if "--port" in given else ["--port", str(served.port)]
        listen = [] if "--listen" in given else ["--listen", f"127.0.0.1:{free_port()}"]
        done = subprocess.run(
            [str(TOOL), "serve", *port, *listen, *given],
            capture_output=True, text=True, timeout=20, check=False,
        )  # fmt: skip
    assert done.returncode == 1
    assert said in done.stderr
    assert len(done.stderr.splitlines()) == (2 if "invalid" in said else 1), (
        done.stderr
    )  # a warning
    assert "ready" not in done.stdout


def test_a_port_in_use(start: Start) -> None:
    served = start()
    done = subprocess.run(
        [str(TOOL), "serve", "--port", str(served.port), "--listen", f"127.0.0.1:{free_port()}"],
        capture_output=True, text=True, timeout=20, check=False,
    )  # fmt: skip
    assert done.returncode == 1
    assert "in use by another program" in done.stderr


@pytest.mark.parametrize(
    ("port", "address"),
    [
        ("/dev/ttyUSB0", None),
        ("COM3", None),
        ("tcp://winch", ("tcp", "winch", 502)),
        ("tcp://[::1]:1502/", ("tcp", "::1", 1502)),
        ("rtu+tcp://10.0.0.2:4001", ("rtu+tcp", "10.0.0.2", 4001)),
    ],
)
def test_names_of_ports(port: str, address: object) -> None:
    assert tcp_address(port) == address


@pytest.mark.parametrize(
    "port",
    ["tcp://", "tcp://h:0", "tcp://h:99999", "tcp://h/x", "rtu+tcp://h", "udp://h:1", "tcp://u@h"],
)
def test_what_is_no_port(port: str) -> None:
    with pytest.raises(ToolError, match="--port"):
        tcp_address(port)


def test_stop_ends_it_in_time(start: Start) -> None:
    served = start()
    with connect(f"ws://127.0.0.1:{served.web}/live"):
        began = time.monotonic()
        assert served.stop() == 0  # Ctrl-C is how it is ended
    assert time.monotonic() - began < 5
