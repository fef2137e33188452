# SPDX-License-Identifier: Apache-2.0
"""Steps 1 and 9: what the controller is, and the first rope."""

from collections.abc import Mapping

from levelwind.commission.bench import Bench, wrong
from levelwind.commission.session import Result
from levelwind.files import backups
from levelwind.line.live import IDENTITY_POINTS, flag, image_of, version_of
from levelwind.line.parameter_sets import set_crc
from levelwind.line.points import PARAMETERS, enum_label, format_value
from levelwind.map_table import (
    MAP_VERSION,
    SELF_TEST,
    Command,
    Flag,
    Host,
    LaunchInhibit,
    Mode,
)

CHECKS = (
    ("rope.ends", "Haul in slowly. At both flanges the rope lies against the last coil: no gap, "
     "no heap?"),
    ("rope.back", "Pull rope out by hand, haul in again: did the carriage go back on the same "
     "path?"),
    ("rope.fast", "Haul in faster, step by step, up to the launch's speed: no LOS, and the "
     "switches keep their places?"),
)  # fmt: skip
BESIDE = (LaunchInhibit.NOT_TRACKING,)


def machine_of(values: Mapping[str, int]) -> dict[str, str]:
    """What a report says of the controller, by its IDENTITY_POINTS."""
    return {
        "firmware": version_of(values),
        "image": image_of(values) or "none: a simulator",
        "host": enum_label(Host, values["host"]),
    }


def identify(bench: Bench, result: Result) -> None:
    """Who answers, which firmware, and what is set; a backup before anything is changed."""
    device = bench.device
    values = device.read(IDENTITY_POINTS)
    if values["self_test"] != SELF_TEST:
        raise wrong(
            "identify.other", f"{device.line} answers, but is no levelwind.", "Check the unit id."
        )
    if values["map_version"] != MAP_VERSION:
        raise wrong(
            "identify.map",
            f"The controller has map {values['map_version']}, this tool {MAP_VERSION}.",
            "Use the tool of the same release.",
        )
    active = bench.active()
    crc = device.value("active_crc")
    if set_crc(active) != crc:
        raise wrong(
            "identify.set",
            "The controller knows other parameters than this tool: it names the set "
            f"{crc}, the tool {set_crc(active)}.",
            "Use the tool of the same release.",
        )
    if flag(bench.live(), Flag.LOCKED):
        raise wrong("identify.locked", "The write lock is closed.", "`levelwind unlock` first.")
    if not flag(bench.live(), Flag.DRUM_AT_REST):
        raise wrong("identify.drum", "The drum turns.", "Let it come to rest.")
    machine = machine_of(values)
    bench.session.machine = machine
    result.measured.update(machine)
    other = {p.name: format_value(p, active[p.name]) for p in PARAMETERS
             if active[p.name] != p.default and not p.secret}  # fmt: skip
    result.measured["parameters that differ from the factory's"] = (
        ", ".join(f"{name}={value}" for name, value in other.items()) or "none"
    )
    path = bench.session.path.with_name("before.yaml")
    if not path.exists():  # the first one is what was there before
        backups.write(device, "active", path)
    result.measured["backup of what was set before"] = path.name
    begin = bench.human.choose(
        "identify.from_factory",
        "Begin from factory values (the line settings stay)? n: keep what is set",
        "yn",
        "y",
    )
    if begin == "y":
        bench.rest()
        device.command(Command.FACTORY_MOTION)
        device.command(Command.APPLY)


def first_rope(bench: Bench, result: Result) -> None:
    """Index as for a launch, wind, look; what was trimmed becomes the set's."""
    human, device = bench.human, bench.device
    bench.current_on()
    bench.index("rope")
    if not bench.see(lambda: bench.flags(Flag.TRACKING)[0], 10.0):
        raise wrong(
            "rope.tracking",
            "The carriage does not follow the drum.",
            "`levelwind status` says why.",
        )
    inhibit = device.value("launch_inhibit")
    if inhibit:
        reasons = [bit.text for bit in LaunchInhibit if inhibit >> bit & 1]
        raise wrong("rope.permit", "No launch is permitted.", " ".join(reasons))
    result.measured["launch permit after indexing"] = "given"
    human.say("    It follows the drum now. `levelwind trim` shifts a reversal while it runs.")
    for name, text in CHECKS:
        if human.choose(name, text, "yn", "y") != "y":
            raise wrong(
                name, f"Not so: {text}",
                "A heap at a flange: reverse earlier there, a gap: later (`levelwind trim`, 0.2 mm "
                "at a time). LOS: less pitch, more overshoot, more stepper current.",
            )  # fmt: skip
    live = bench.live()
    if flag(live, Flag.LOS):
        raise wrong(
            "rope.los",
            "Synchronization was lost on the way.",
            "`levelwind status` says at which switch; steps 6 and 7 find what is loose or weak.",
        )
    result.measured["loss of synchronization"] = "none"
    result.measured["other switch at the indexing, um"] = live["span_error_um"]
    if not bench.see(lambda: bench.flags(Flag.DRUM_AT_REST)[0]):
        raise wrong("rope.drum", "The drum still turns.", "Let it come to rest, then repeat.")
    trims = device.read_names("trim_plus_um", "trim_minus_um")
    if any(trims.values()):
        active = bench.active()
        values = {
            f"reversal_{side}_um": active[f"reversal_{side}_um"] + trims[f"trim_{side}_um"]
            for side in ("plus", "minus")
        }
        bench.rest()
        device.write(dict.fromkeys(trims, 0))
        bench.apply(values)
        result.proposed.update(values)
        result.measured["trims taken into the set, um"] = ", ".join(map(str, trims.values()))


def follow(bench: Bench) -> None:
    """Leave the winch as it is used."""
    bench.device.write({"mode": int(Mode.TRACK)})
    bench.index("accept")
