# SPDX-License-Identifier: Apache-2.0
"""Step 7: how fast the stepper follows, and where it falls out of step.

The law's ramps belong to its speed: at twice the rate of edges a jog of the same set goes twice as
fast and accelerates four times as hard, as a reversal does at that drum speed. So rising rates try
speed and acceleration together. A try is a jog in the middle of the way, far from both ends: a
motor that falls out of step there stays behind, and runs into nothing. A slow indexing before and
after says how many steps it has lost.
"""

from levelwind.commission.bench import CALM_MM_PER_S, USTEP, Bench, wrong
from levelwind.commission.repeat import usual_steps
from levelwind.commission.session import Finding, Result
from levelwind.errors import RefusedError
from levelwind.lay import wind
from levelwind.map_table import POINTS

FULL_STEPS_PER_REV = 200
BEGIN_PART = 0.4  # of the rate that the fastest rope asks for
RISE = 1.2
FINE = 1.02
SLOPE_MAX = 0.95
TRIP_PART, WARNING_PART = 0.70, 0.62  # of the pull-out
TRIP_PART_MAX = 0.77  # what is found lies up to 4 % above the real one, and 20 % are wanted
REACH = 1.05  # above the fastest rope
AWAY_PART = 0.35  # of the way between the switches, from its middle to either side
HOLD_MS = 300
RATE_MAX = 50_000
FURTHEST = 6.0  # times the fastest rope: further up nobody needs to know


class Tries:
    """Jogs at rising rates."""

    def __init__(self, bench: Bench, result: Result) -> None:
        self._bench, self._result = bench, result
        active = bench.active()
        self._pitch_um = active["pitch_um"]
        self._span_um = active["switch_plus_um"] - active["switch_minus_um"]
        self._um_per_ustep = bench.um_per_ustep()
        self.full_step = active["microsteps_per_rev"] / FULL_STEPS_PER_REV
        law = bench.device.read_names("ks")
        self._steepest = SLOPE_MAX * USTEP / law["ks"]
        self._steeper = 0.0  # as of the set in force, indexed; 0: none is

    @property
    def highest(self) -> float:
        """The highest drum speed that can be tried."""
        return RATE_MAX * self._steepest

    def lost(self, edges_per_s: float) -> float:
        """Microsteps that a jog as at this drum speed loses."""
        bench = self._bench
        # Faster than a jog may be: a steeper law over the same overshoot is the same motion.
        steeper = max(1.0, edges_per_s / RATE_MAX)
        rate = round(edges_per_s / steeper)
        if steeper != self._steeper:
            bench.apply({"pitch_um": round(self._pitch_um * steeper)})
            bench.apply({"index_rate_edges_per_s": bench.rate_for(CALM_MM_PER_S)})
            bench.index("pull_out")
            self._steeper = steeper
        bench.apply({"jog_rate_edges_per_s": rate})
        speed = bench.speed_mm_per_s(rate)
        from_usteps = bench.live()["position_usteps"]
        bench.jog(1, 2 * AWAY_PART * self._span_um / 1000 / speed)
        to_usteps = bench.live()["position_usteps"]
        bench.rest()
        usual = usual_steps(bench) - (to_usteps - from_usteps)
        lost = bench.index("pull_out").steps - usual
        self._result.series.setdefault("tried_edges_per_s", []).append(round(edges_per_s))
        self._result.series.setdefault("lost_usteps", []).append(lost)
        bench.human.say(
            f"    {speed:6.1f} mm/s ({edges_per_s:.0f} edges/s): "
            + (f"lost {lost:.0f} microsteps" if self.is_lost(lost) else "followed")
        )
        return lost

    def is_lost(self, usteps: float) -> bool:
        """More than a full step is no scatter of a switch."""
        return abs(usteps) > self.full_step


def run(bench: Bench, result: Result) -> None:
    """Up until it falls out of step, then back to find where."""
    bench.current_on()
    active = bench.active()
    told = bench.session.told
    wanted = float(told["rope_m_per_s"] / told["rope_m_per_rev"] * wind.edges_per_drum_rev(active))
    bench.human.say("    The carriage jogs fast in the middle of its way. Keep hands away.")
    bench.human.when_done("pull_out.free", "Nobody near the carriage?")
    middle = {
        "park_at": 1,
        "park_position_um": round(
            (active["switch_plus_um"] + active["switch_minus_um"]) / 2
            - AWAY_PART * (active["switch_plus_um"] - active["switch_minus_um"])
        ),
        "jog_hold_ms": HOLD_MS,
        "overspeed_warning_edges_per_s": active["overspeed_warning_edges_per_s"],
        "span_tolerance_um": max(active["span_tolerance_um"], 2000),
    }
    tried = {name: active[name] for name in
             ("pitch_um", "index_rate_edges_per_s", "jog_rate_edges_per_s")}  # fmt: skip
    with bench.for_now(tried | middle):
        follows, loses = _search(bench, result, wanted)
    result.measured["fastest drum speed that it followed, edges/s"] = round(follows)
    result.measured["falls out of step at, edges/s"] = (
        round(loses) if loses else f"above {follows:.0f}, the fastest that can be tried"
    )
    result.measured["the fastest rope asks for, edges/s"] = round(wanted)
    if loses and wanted > TRIP_PART_MAX * loses:
        raise wrong(
            "pull_out.weak",
            f"The stepper falls out of step at {loses:.0f} edges/s; {told['rope_m_per_s']:g} m/s "
            f"of rope are {wanted:.0f}, and must stay below {TRIP_PART_MAX * loses:.0f}.",
            "A coupling that slips; else more current or supply voltage, less friction; more "
            "overshoot, or a smaller pitch: then it need not run so fast. Step 5 asks for both.",
        )
    if loses:
        trip = max(TRIP_PART * loses, min(TRIP_PART_MAX * loses, REACH * wanted))
    else:
        trip = max(follows, REACH * wanted)
        if trip > follows:
            result.findings.append(
                Finding(
                    "pull_out.not_tried",
                    f"A jog goes up to {follows:.0f} edges/s with this set, less than the rope "
                    "asks for: beyond that nothing is known.",
                    "Watch the first fast launches for LOS, or take a coarser microstep.",
                    wrong=False,
                )
            )
    values = {
        "overspeed_trip_edges_per_s": min(round(trip), 1_000_000),
        "overspeed_warning_edges_per_s": min(round(WARNING_PART / TRIP_PART * trip), 1_000_000),
    }
    while True:
        try:
            bench.apply(values)
            break
        except RefusedError as refused:
            lower = round(0.9 * values["overspeed_warning_edges_per_s"])
            if lower < (POINTS["overspeed_warning_edges_per_s"].min or 1):
                raise
            values["overspeed_warning_edges_per_s"] = lower
            result.findings = [
                Finding("pull_out.warning", f"The warning is lower than it might be: {refused}",
                        "A reversal point further outside of its switch allows more.",
                        wrong=False)
            ]  # fmt: skip
    bench.index("pull_out")
    result.proposed.update(values)


def _search(bench: Bench, result: Result, wanted: float) -> tuple[float, float]:
    """The fastest that was followed, and the slowest that was not (0: there was none)."""
    tries = Tries(bench, result)
    follows = 0.0
    loses = 0.0
    rate = BEGIN_PART * wanted
    highest = min(tries.highest, FURTHEST * wanted)
    while not loses:
        rate = min(rate, highest)
        if tries.is_lost(tries.lost(rate)):
            loses = rate
        else:
            follows = rate
            if rate >= highest:
                return follows, 0.0
            rate *= RISE
    if not follows:
        raise wrong(
            "pull_out.weak",
            f"Already at {loses:.0f} edges/s the stepper falls out of step.",
            "More current or supply voltage at the driver; look for what brakes the carriage.",
        )
    while loses / follows > FINE:
        middle = (loses * follows) ** 0.5
        if tries.is_lost(tries.lost(middle)):
            loses = middle
        else:
            follows = middle
    return follows, loses
