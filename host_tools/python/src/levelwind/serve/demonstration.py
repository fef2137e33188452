# SPDX-License-Identifier: Apache-2.0
"""The demonstration for the page: set up, indexed, then a launch now and then, until the end."""

import threading
from collections.abc import Callable, Mapping

from levelwind.errors import ToolError
from levelwind.files import profiles, script
from levelwind.line.device import Device
from levelwind.line.motion import INDEX_LIMIT_S
from levelwind.map_table import Command, Mode
from levelwind.simulate import launches

PAUSE_S = 5.0
# A 5 mm rope on a drum of 764 mm: 2.4 m a revolution, as the factory values have it.
ROPE = {
    "rope_diameter_um": 5_000,
    "drum_core_diameter_um": 764_000,
    "rope_packing_permille": 750,
}
ALL_ROPE_MM = 1_000_000
PULLED_OUT_MM = 650_000
PULL_OUT_OF_WARNING = 0.8  # of overspeed_warning_edges_per_s
LOOK_S = 0.1


class Demonstration:
    """A thread that winds launch after launch on the simulated winch."""

    def __init__(
        self,
        device: Callable[[], Device],
        say: Callable[[str], None],
        parameters: Mapping[str, int] | None = None,
    ) -> None:
        """`parameters`: the whole set, where the machine is not the default one."""
        self._device, self._say, self._parameters = device, say, parameters
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="demonstration", daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def close(self) -> None:
        """No more launches."""
        self._ended.set()

    def _pull_out(self, device: Device) -> None:
        """So much rope, as a launch wants it."""
        edges_per_s = PULL_OUT_OF_WARNING * device.value("overspeed_warning_edges_per_s")
        rpm = launches.read_gearing(device).drum_rpm("edges_per_s")(edges_per_s)
        device.write({"bench_drum_speed_millirpm": -round(1000 * rpm)})
        while device.value("rope_out_mm") < PULLED_OUT_MM and not self._ended.wait(LOOK_S):
            pass
        device.write({"bench_drum_speed_millirpm": 0})

    def _set_up(self, device: Device) -> None:
        if self._parameters is not None:
            device.write({**self._parameters, **ROPE})
            device.command(Command.APPLY)
            device.write({"mode": Mode.TRACK})
            device.command(Command.INDEX, limit_s=INDEX_LIMIT_S)
            return
        device.write(ROPE)  # the set-up applies it with its own
        for step in script.load(profiles.find("field_setup.yaml")):
            step.run(device)

    def _run(self) -> None:
        try:
            device = self._device()
            self._set_up(device)
            device.write({"set_rope_mm": ALL_ROPE_MM})
            device.command(Command.SET_ROPE)
        except ToolError as error:
            self._say(f"the demonstration has ended: {error}")
            return
        while not self._ended.wait(PAUSE_S):
            try:
                self._pull_out(device)
                gearing = launches.read_gearing(device)
                profile = profiles.read(profiles.find("ground_launch.csv"), gearing)
                launches.upload(device, profile)
                launches.play(device, profile, lambda _: None)
            except ToolError as error:
                self._say(f"a launch of the demonstration was cut: {error}")
