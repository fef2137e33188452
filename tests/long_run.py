# SPDX-License-Identifier: Apache-2.0
"""Does it ever drift? `./dev longrun`: a day of winch time, and a billion edges of the bare law.

Both end where a closed form says, computed with Python's integers from the number of net edges
alone (levelwind.core.ideal_screw), to the last bit.
"""

import argparse
import random
import sys
import time

from levelwind.core.ideal_screw import Screw, State
from levelwind.core.native import replay
from world import World

# Ka, Nr, L+, L-, dwell plus, dwell minus
SCREWS = (
    Screw(23, 1187, 8000, -8000),  # the example machine
    Screw(23, 1187, 8000, -8000, 1440, 720),
    Screw(65535, 1, 31_990, -31_990),  # the steepest slope
    Screw(1, 32_767, 9000, -9000),  # the gentlest reversal
    Screw(7, 4001, 5001, -12_345, 3, 0),
)
REST_S = 3.0


def law(screw: Screw, edges: int, seed: int) -> int:
    """Run the law over random motions of the drum; the edges taken, either direction."""
    rng = random.Random(seed)
    start = State(screw.sweep_begin + rng.randrange(screw.sweep_end - screw.sweep_begin), screw.ks)
    runs = []
    left = edges
    while left > 0:
        # Short rocking as well as launches of a million edges, forward more than backward.
        run = min(left, int(10 ** rng.uniform(0, 6)))
        runs.append(run if rng.random() < 0.6 else -run)
        left -= run
    setup = {
        "ka": screw.ka,
        "nr": screw.nr,
        "lplus_usteps": screw.reversal_plus_usteps,
        "lminus_usteps": screw.reversal_minus_usteps,
        "m": start.m,
        "u": start.u,
        "dwell_plus_edges": screw.dwell_plus_edges,
        "dwell_minus_edges": screw.dwell_minus_edges,
    }
    result, _, _ = replay(setup, runs)
    ideal = screw.orbit(start).after(sum(runs))
    assert result.edges == edges
    assert (result.m, result.u) == (ideal.m, ideal.u), f"{screw} after {sum(runs)} net edges"
    assert result.steps == ideal.pos_usteps - start.pos_usteps
    return result.edges


def day(hours: float, seed: int) -> tuple[float, int]:
    """Operate a winch; hours of virtual time and edges followed, from one hand-over."""
    rng = random.Random(seed)
    world = World(seed).index()
    orbit = world.orbit()
    edges = abs_edges = 0
    seconds = 0.0
    while seconds < hours * 3600:
        # A launch, the rope pulled out again by hand or by a car, and now and then a rocked drum.
        for speed, duration_s in (
            (rng.uniform(20_000, 48_000), rng.uniform(20, 50)),
            (0, REST_S),
            (-rng.uniform(2_000, 25_000), rng.uniform(20, 80)),
            (rng.choice((0, 700, -700)), rng.uniform(1, 5)),
        ):
            world.drum(speed)
            world.run(duration_s)
            seconds += duration_s
            before, edges = edges, check(world, orbit)
            abs_edges += abs(edges - before)
    return seconds / 3600, abs_edges


def check(world: World, orbit) -> int:
    """All is as it should be; the net edges followed."""
    world.check_follows(orbit)
    truth = world.truth
    # Two edges per pulse: every transition of channel A.
    assert world.value("net_edges") == (truth.drum_transitions + 1) // 2
    assert world.permit, f"{world}"
    assert "los" not in world.flags
    assert abs(world.error_usteps) < 20
    assert truth.pole_slips == 0
    return world.value("pattern_edges")


def main() -> int:
    """Both, with their duration."""
    parser = argparse.ArgumentParser(prog="./dev longrun", description=__doc__)
    parser.add_argument("--hours", type=float, default=24.0, help="of winch time (24)")
    parser.add_argument("--edges", type=int, default=10**9, help="of the bare law (1000000000)")
    arguments = parser.parse_args()

    began = time.monotonic()
    edges = sum(
        law(screw, arguments.edges // len(SCREWS), seed) for seed, screw in enumerate(SCREWS)
    )
    took_s = time.monotonic() - began
    print(f"ok  bare law: {edges:,} edges of {len(SCREWS)} patterns, {took_s:.0f} s", flush=True)
    began = time.monotonic()
    hours, edges = day(arguments.hours, seed=1)
    took_s = time.monotonic() - began
    print(f"ok  winch: {hours:.2f} h, more than {edges:,} edges from one hand-over, {took_s:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
