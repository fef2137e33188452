# SPDX-License-Identifier: Apache-2.0
"""How rope lies, judged by a model of its own: the law, the height field and the numbers of the
design page, written in Python from the page and nothing else."""

import itertools
import json
import math
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import rope_pictures
from levelwind.cli import app
from levelwind.core.ideal_screw import Screw
from levelwind.lay import rope, sources
from levelwind.line.points import PARAMETERS
from levelwind.show.plots import new_figure
from levelwind.simulate import picture
from typer.testing import CliRunner

EDGES_PER_REV = 2880  # 360 pulses, 2 edges, ratio 4
MM_PER_USTEP = 0.01  # 20 mm in 2000
REVERSAL_USTEPS = 8000
ROPE_MM = 5.0
ANGLES, CELL_MM = 72, 0.25
KA = 23
TURNS = 650 / 2.4


def law_positions_mm(
    nr: int, dwell_edges: int = 0, breaker_edges: int = 0, cycles: int = 0
) -> list[float]:
    """Where the carriage is at every angle, edge by edge, from the middle toward plus."""
    m, u, rested = 0, KA * nr, 0
    begin, end = (-REVERSAL_USTEPS + 1) * 65536, REVERSAL_USTEPS * 65536
    passed = {True: 0, False: 0}  # far points, by whether they are at plus
    places = []
    edges = 0
    for angle in range(round(TURNS * ANGLES)):
        while edges < round(angle * EDGES_PER_REV / ANGLES):
            edges += 1
            if u == 0:
                dwell = dwell_edges
                if cycles:
                    cycle = passed[m > 0] % cycles
                    dwell += breaker_edges * min(cycle, cycles - cycle) // (cycles // 2)
                if rested < dwell:
                    rested += 1
                    continue
                passed[m > 0] += 1
                rested = 0
            u += KA if m < begin else -KA if m >= end else 0
            m += u
        places.append(m / 65536 * MM_PER_USTEP)
    return places


def period_edges(nr: int) -> int:
    """Edges until position and slope are back."""
    start = m, u = 0, KA * nr
    begin, end = (-REVERSAL_USTEPS + 1) * 65536, REVERSAL_USTEPS * 65536
    edges = 0
    while True:
        u += KA if m < begin else -KA if m >= end else 0
        m += u
        edges += 1
        if (m, u) == start:
            return edges


def height_field(places_mm: list[float], far_point_mm: float) -> np.ndarray:
    """The page's crude field between the far points."""
    half = int(np.ceil((far_point_mm + ROPE_MM) / CELL_MM))
    surface = np.zeros((ANGLES, 2 * half + 1))
    reach = int(ROPE_MM / 2 / CELL_MM)
    across = np.arange(-reach, reach + 1) * CELL_MM
    round_side = np.sqrt((ROPE_MM / 2) ** 2 - across**2)
    for i, place in enumerate(places_mm):
        middle = half + round(place / CELL_MM)
        under = surface[i % ANGLES, middle - reach : middle + reach + 1]
        centre = np.max(under + round_side)
        np.maximum(under, centre + round_side, out=under)
    inner = int(np.ceil(far_point_mm / CELL_MM))
    return surface[:, half - inner : half + inner + 1]


def expected(nr: int, *dwell: int) -> dict[str, float]:
    far_mm = (REVERSAL_USTEPS + KA * nr * (nr - 1) / 2 / 65536) * MM_PER_USTEP
    surface = height_field(law_positions_mm(nr, *dwell), far_mm)
    return {
        "max_mm": surface.max(),
        "mean_mm": surface.mean(),
        "std_mm": surface.std(),
        "p5_mm": np.percentile(surface, 5),
    }


def levelwind(*arguments: str):
    return CliRunner().invoke(app, list(arguments))


def raw(nr: int, **more: int) -> list[str]:
    """A pattern by Ka 23 and Nr."""
    values = {
        "expert_mode": 1,
        "raw_ka": KA,
        "raw_nr": nr,
        "raw_reversal_plus_usteps": REVERSAL_USTEPS,
        "raw_reversal_minus_usteps": -REVERSAL_USTEPS,
    } | more
    return [part for name, value in values.items() for part in ("--set", f"{name}={value}")]


def document(*arguments: str) -> dict:
    result = levelwind("lay", "--rope-mm", "5", "--json", *arguments)
    assert result.exit_code == 0, result.stderr
    return json.loads(result.stdout)


@pytest.mark.parametrize(("nr", "dwell_millirev"), [(1187, 0), (1000, 100), (400, 0)])
def test_evenness_is_that_of_an_independent_model(nr: int, dwell_millirev: int):
    dwell = {"dwell_plus_millirev": dwell_millirev, "dwell_minus_millirev": dwell_millirev}
    told = document(*raw(nr, **dwell), "--patterns", "0")["evenness"]
    model = expected(nr, dwell_millirev * EDGES_PER_REV // 1000)
    # The compiled field keeps 24 bits: a tie at a column's border may fall the other way.
    for name, mm in model.items():
        assert told[name] == pytest.approx(mm, rel=2e-3, abs=0.02), name


@pytest.mark.parametrize(("amplitude_millirev", "cycles"), [(300, 12), (150, 3)])
def test_a_ribbon_breaker_is_laid_as_by_an_independent_model(amplitude_millirev: int, cycles: int):
    breaker = {"breaker_millirev": amplitude_millirev, "breaker_cycles": cycles}
    told = document(*raw(1000, **breaker), "--patterns", "0")
    edges = amplitude_millirev * EDGES_PER_REV // 1000
    for name, mm in expected(1000, 0, edges, cycles).items():
        assert told["evenness"][name] == pytest.approx(mm, rel=2e-3, abs=0.02), name
    # Two sides, each the mean of its cycles longer.
    steps = [edges * min(k, cycles - k) // (cycles // 2) for k in range(cycles)]
    assert told["period_edges"] == pytest.approx(95_176 + 2 * sum(steps) / cycles, abs=1e-5)
    assert 1 not in told["ribbons"]


@pytest.mark.parametrize(
    ("nr", "dwell_millirev", "page"),
    [
        (1187, 0, (68.7, 58.2, 5.1, 49.1)),
        (1098, 0, (67.6, 59.8, 4.1, 50.8)),
        (1000, 0, (76.7, 57.0, 18.4, 11.3)),
        (1000, 100, (70.3, 60.2, 5.5, 49.7)),
        (600, 0, (52.0, 46.5, 2.6, 41.6)),
        (400, 0, (808, 725, 48, 664)),
    ],
)
def test_evenness_is_that_of_the_design(nr: int, dwell_millirev: int, page: tuple[float, ...]):
    dwell = {"dwell_plus_millirev": dwell_millirev, "dwell_minus_millirev": dwell_millirev}
    told = document(*raw(nr, **dwell), "--patterns", "0")["evenness"]
    highest, mean, std, low = page
    assert told["max_mm"] == pytest.approx(highest, rel=0.03)
    assert told["mean_mm"] == pytest.approx(mean, rel=0.02)
    assert told["std_mm"] == pytest.approx(std, rel=0.04)
    assert told["p5_mm"] == pytest.approx(low, rel=0.04)


def test_the_wind_ratio_of_the_factory_set_is_exact():
    told = document("--patterns", "0")
    assert told["period_edges"] == period_edges(1187) == 81_558
    assert told["edges_per_drum_rev"] == EDGES_PER_REV
    assert Fraction(told["wind_ratio"]) == Fraction(81_558, EDGES_PER_REV)
    assert float(Fraction(told["wind_ratio"])) == 28.31875
    assert told["displacements_mm"][:3] == pytest.approx([3.824, -4.349, -0.525], abs=5e-4)
    assert told["ribbons"] == [3]
    assert told["recommended"] == []
    assert list(told) == [
        *("wind_ratio", "period_edges", "edges_per_drum_rev", "displacements_mm", "ribbons"),
        *("evenness", "recommended"),
    ]
    assert list(told["evenness"]) == ["max_mm", "mean_mm", "std_mm", "p5_mm"]


@pytest.mark.parametrize("nr", [1187, 1000, 1254, 892])
def test_displacements_are_the_places_of_coils(nr: int):
    """Not from W: the carriage's places themselves, whole turns apart, in the upward sweep."""
    told = document(*raw(nr), "--patterns", "0")
    ks_mm = KA * nr / 65536 * MM_PER_USTEP
    pitch_mm = ks_mm * EDGES_PER_REV
    period = period_edges(nr)
    assert told["period_edges"] == period
    for order, mm in enumerate(told["displacements_mm"], 1):
        # After `order` periods the carriage is back; the drum is this much past a whole turn.
        past = (order * period) % EDGES_PER_REV
        nearest = past if past <= EDGES_PER_REV / 2 else past - EDGES_PER_REV
        assert mm == pytest.approx(nearest * ks_mm, abs=1e-6)
        assert abs(mm) <= pitch_mm / 2 + 1e-9


def test_a_dwell_counts_in_the_wind_ratio():
    told = document("--set", "dwell_plus_millirev=100", "--patterns", "0")
    assert told["period_edges"] == 81_558 + 288


def test_an_encoder_that_does_not_divide():
    told = document(
        "--set", "encoder_ratio_denominator=7", "--set", "pitch_um=2000", "--patterns", "0",
        "--rope-m", "50",
    )  # fmt: skip
    assert told["edges_per_drum_rev"] == pytest.approx(2880 / 7, abs=1e-6)
    assert Fraction(told["wind_ratio"]) == told["period_edges"] / Fraction(2880, 7)


def test_the_pitch_of_the_worst_ribbon_and_what_is_recommended():
    told = document(*raw(1000))
    assert told["evenness"]["std_mm"] > 12
    assert told["ribbons"] == [1]
    assert len(told["recommended"]) >= 3
    for best in told["recommended"][:3]:
        assert best["evenness"]["std_mm"] < 6
        assert 1 not in best["ribbons"]
        # What is recommended is what comes out of it.
        line = best["set"].removeprefix("levelwind set ").split()
        given = [part for assignment in line for part in ("--set", assignment)]
        again = document(*raw(1000), *given, "--patterns", "0")
        assert again == {n: v for n, v in best.items() if n in again} | {"recommended": []}
    breaker = told["recommended"][-1]
    assert set(breaker["changes"]) == {"breaker_millirev", "breaker_cycles"}
    assert breaker["evenness"]["std_mm"] < 6
    assert breaker["near_std_mm"] < 6
    assert 1 not in breaker["ribbons"]
    model = expected(
        1000,
        0,
        round(breaker["changes"]["breaker_millirev"] * EDGES_PER_REV / 1000),
        breaker["changes"]["breaker_cycles"],
    )
    assert model["std_mm"] < 6


def test_a_band_keeps_what_is_recommended_inside():
    told = document("--band-pitch", "11.9/12.3", "--band-dwell", "50/60", "--patterns", "50")
    factory = {"pitch_um": 12_000, "dwell_plus_millirev": 0}
    for best in told["recommended"][:-1]:
        changes = factory | best["changes"]
        assert 11_900 <= changes["pitch_um"] <= 12_300
        assert 50 <= changes["dwell_plus_millirev"] <= 60
        assert best["changes"]["dwell_minus_millirev"] == changes["dwell_plus_millirev"]


def test_recommended_is_the_most_even_of_the_band():
    """By hand: the same settings one by one, without any search."""
    told = document("--band-pitch", "11.6/11.8", "--band-dwell", "0/0", "--patterns", "5")
    by_hand = {
        pitch: document("--set", f"pitch_um={pitch}", "--patterns", "0")["evenness"]["std_mm"]
        for pitch in (11_600, 11_650, 11_700, 11_750, 11_800)
    }
    best = told["recommended"][0]
    assert best["changes"]["pitch_um"] == min(by_hand, key=by_hand.get)
    assert best["evenness"]["std_mm"] == min(by_hand.values())


def test_near_by_is_the_worst_of_a_little_more_and_less_dwell():
    told = document("--band-pitch", "12/12", "--band-dwell", "0/20", "--patterns", "9")
    by_hand = [
        document(
            "--set", f"dwell_plus_millirev={dwell}", "--set", f"dwell_minus_millirev={dwell}",
            "--patterns", "0",
        )["evenness"]["std_mm"]
        for dwell in (0, 10, 20)
    ]  # fmt: skip
    near = [max(by_hand[:2]), max(by_hand), max(by_hand[1:])]
    best = told["recommended"][0]
    assert best["near_std_mm"] == min(near)
    assert best["evenness"]["std_mm"] == by_hand[near.index(min(near))]
    assert best["evenness"]["std_mm"] < best["near_std_mm"]


def test_what_is_recommended_are_changes_and_a_choice():
    told = document("--rope-m", "300")
    factory = {p.name: p.default for p in PARAMETERS}
    best = told["recommended"][:3]
    assert len(best) == 3
    assert all(factory[n] != v for entry in best for n, v in entry["changes"].items())
    pitches = sorted(entry["changes"].get("pitch_um", 12_000) for entry in best)
    # 10 % around 12 mm in 20 pitches: at least two of them apart.
    assert min(b - a for a, b in itertools.pairwise(pitches)) >= 2 * 2400 // 20


def test_in_expert_mode_nr_is_changed_and_not_the_pitch():
    told = document(*raw(1000), "--band-dwell", "0/0", "--patterns", "20")
    changed = {name for best in told["recommended"] for name in best["changes"]}
    assert changed == {"raw_nr"}


def test_a_ribbon_needs_rope_for_three_coils():
    """Two double traverses of 33.05 turns after the first coil: 158.6 m."""
    assert document(*raw(1000), "--rope-m", "155", "--patterns", "0")["ribbons"] == []
    assert document(*raw(1000), "--rope-m", "162", "--patterns", "0")["ribbons"] == [1]


def test_more_rope_is_higher():
    short, long = (document("--rope-m", m, "--patterns", "0")["evenness"] for m in ("300", "900"))
    assert long["mean_mm"] > 2.5 * short["mean_mm"]


def test_a_drum_that_grows_needs_fewer_turns():
    grown = ("--set", "drum_core_diameter_um=763944", "--set", "rope_packing_permille=700")
    said = levelwind("lay", "--rope-mm", "5", "--patterns", "0", *grown).stdout
    turns = float(said.split(" mm thick: ")[1].split()[0])
    # By the page: L = 2 pi R0 N + pi^2 c N^2.
    width_m = 2 * (0.080 + KA * 1187 * 1186 / 2 / 65536 * 1e-5)
    c = 0.005**2 / (4 * 0.7 * width_m)
    length = math.pi * 0.763944 * turns + math.pi**2 * c * turns**2
    assert length == pytest.approx(650, abs=0.2)
    assert turns < TURNS - 5


def test_the_table_names_ribbons_and_the_set_line():
    said = levelwind("lay", "--rope-mm", "5", *raw(1000), "--patterns", "60").stdout
    assert "11897/360" in said
    assert "RIBBON" in said
    assert "every double traverse the coils come to lie on earlier ones, +0.48 mm" in said
    assert "walls, with valleys between" in said
    assert said.count("levelwind set ") >= 3
    climbing = levelwind("lay", "--rope-mm", "5", *raw(400), "--patterns", "0").stdout
    assert "The pitch, 4.04 mm, is less than the rope is thick, 5 mm" in climbing


def test_the_diameter_of_the_set_counts_and_the_option_wins(tmp_path: Path):
    assert document("--patterns", "0") == json.loads(
        levelwind("lay", "--set", "rope_diameter_um=5000", "--patterns", "0", "--json").stdout
    )
    thick = json.loads(
        levelwind(
            "lay", "--set", "rope_diameter_um=5000", "--rope-mm", "9", "--patterns", "0", "--json"
        ).stdout
    )
    assert thick["evenness"]["mean_mm"] > 100


def test_a_trim_in_expert_mode_is_in_microsteps():
    parameters = sources.FACTORY | {
        "expert_mode": 1,
        "raw_reversal_plus_usteps": 8000,
        "raw_reversal_minus_usteps": -8000,
    }
    trimmed = sources.trimmed(parameters, 204, -100)
    assert trimmed["raw_reversal_plus_usteps"] == 8020  # 10 um each
    assert trimmed["raw_reversal_minus_usteps"] == -8010
    assert trimmed["reversal_plus_um"] == parameters["reversal_plus_um"]


def test_a_cam_is_not_what_is_laid():
    said = levelwind("lay", "--rope-mm", "5", "--patterns", "0", "--set", "motion_profile=cam")
    assert said.exit_code == 0
    assert "motion_profile is cam" in said.stderr


def test_a_file_gives_the_set(tmp_path: Path):
    planned = levelwind("plan", "--pitch-mm", "10.1", "--set", "rope_diameter_um=5000", "--json")
    path = tmp_path / "set.json"
    path.write_text(planned.stdout)
    from_file = levelwind("lay", str(path), "--patterns", "0", "--json")
    assert from_file.exit_code == 0, from_file.stderr
    assert from_file.stderr == ""
    assert json.loads(from_file.stdout) == document("--set", "pitch_um=10100", "--patterns", "0")
    path.write_text("parameters: {pitch_um: 10100, rope_diameter_um: 5000}\n")
    older = levelwind("lay", str(path), "--patterns", "0", "--json")
    assert older.stdout == from_file.stdout
    assert "lacks" in older.stderr
    assert "screw_lead_um" in older.stderr


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('{"wind_ratio": "1/2"}', "holds no parameters"),
        ("[1, 2]", "holds no parameters"),
        ("12", "holds no parameters"),
        ('{"parameters": [1]}', "holds no parameters"),
        ('{"parameters": {"pitch_um": 0}}', "pitch_um=0 is outside its limits: 10 to"),
        ('{"parameters": {"pitch_um": 12.5}}', "give a whole number"),
        ('{"parameters": {"pitch_um": null}}', "give a whole number"),
        ('{"parameters": {"pitch": 12000}}', "unknown pitch."),
        ('{"parameters": {"pitch_um": 1, "pitch_um": 2}}', "stands twice"),
        ('{"levelwind_backup": "99", "parameters": {}}', "map version 99"),
        ('{"parameters": {"pitch_um"', "line 1"),
        ("", "holds no parameters"),
    ],
)
def test_a_file_that_is_not_ours_is_refused_by_name(text: str, said: str, tmp_path: Path):
    path = tmp_path / "other.json"
    path.write_text(text)
    result = levelwind("lay", str(path), "--rope-mm", "5")
    assert result.exit_code == 1
    assert said in result.stderr
    assert str(path) in result.stderr


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((), "The rope's diameter is not known"),
        (("--rope-mm", "0"), "--rope-mm 0"),
        (("--rope-mm", "-5"), "--rope-mm -5"),
        (("--rope-mm", "nan"), "--rope-mm nan"),
        (("--rope-mm", "51"), "limits 0.001 to 50 mm"),
        (("--rope-mm", "5", "--set", "pitch_um=0"), "pitch_um=0 is outside its limits"),
        (("--rope-mm", "5", "--set", "position_um=1"), "position_um"),
        (("--rope-mm", "5", "--set", "jog=1"), "jog is no parameter"),
        (("--rope-mm", "5", "--rope-m", "0"), "--rope-m 0"),
        (("--rope-mm", "5", "--rope-m", "-1"), "--rope-m -1"),
        (("--rope-mm", "5", "--rope-m", "1e9"), "at most 20000 m"),
        (("--rope-mm", "5", "--rope-m", "inf"), "--rope-m inf"),
        (
            ("--rope-mm", "5", "--rope-m", "20000", "--set", "rope_per_drum_rev_um=1000"),
            "2e+07 drum turns, limit 50000",
        ),
        (
            (
                *("--rope-mm", "5", "--rope-m", "20000"),
                *("--set", "encoder_pulses_per_rev=10000", "--set", "encoder_ratio_numerator=100"),
            ),
            "edges of this encoder",
        ),
        (("--rope-mm", "5", "--band-pitch", "12"), "as in 10.5/13"),
        (("--rope-mm", "5", "--band-pitch", "13/12"), "lower number first"),
        (("--rope-mm", "5", "--band-pitch", "nan/12"), "lower number first"),
        (("--rope-mm", "5", "--band-pitch", "0/12"), "limits 0.01 to 100 mm"),
        (("--rope-mm", "5", "--band-dwell", "-1/12"), "limits 0 to 10000"),
        (("--rope-mm", "5", "--band-dwell", "0/0.5"), "whole thousandths"),
        (("--rope-mm", "5", "--set", "flange_plus_um=80000"), "flange_plus_um"),
        (("--rope-mm", "5", "nowhere.yaml"), "nowhere.yaml: No such file"),
        (("--rope-mm", "5", "nowhere.yaml", "--from-device"), "not both"),
        (("--rope-mm", "5", "--plot", "out.nonsense"), "out.nonsense cannot be written"),
    ],
)
def test_what_cannot_be_laid_is_refused_in_a_sentence(
    arguments: tuple[str, ...], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.chdir(tmp_path)
    result = levelwind("lay", "--patterns", "4", *arguments)
    assert result.exit_code == 1
    assert result.stdout == ""
    assert said in result.stderr
    assert result.stderr.startswith("levelwind: ")


def test_a_band_that_the_core_refuses_everywhere_says_so():
    said = levelwind(
        "lay", "--rope-mm", "5", "--band-pitch", "99/100", "--band-dwell", "0/0", "--patterns", "2"
    )
    assert said.exit_code == 0
    assert "The controller takes none of the settings in this band." in said.stdout


def test_the_picture(tmp_path: Path):
    path = tmp_path / "lay.png"
    result = levelwind("lay", "--rope-mm", "5", *raw(1000), "--patterns", "20", "--plot", str(path))
    assert result.exit_code == 0
    assert path.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "warned"),
    [
        ((), ""),
        (("--set", "rope_diameter_um=5000"), "Every 3rd double traverse lays rope -0.52 mm beside"),
        ((*raw(1000), "--set", "rope_diameter_um=5000"), "Every double traverse lays rope +0.48"),
        ((*raw(1098, rope_diameter_um=2000),), ""),
        (("--pitch-mm", "4", "--set", "rope_diameter_um=5000"), "is less than the rope is thick"),
    ],
)
def test_plan_warns_of_a_ribbon_in_one_line(arguments: tuple[str, ...], warned: str):
    said = levelwind("plan", *arguments).stderr
    assert (
        (said.count("\n") == 1 and warned in said and "`levelwind lay`" in said)
        if warned
        else (said == "")
    )


def wind_turn_by_turn(radius_m: float, packing: float, turns: float) -> float:
    """Metres on a drum whose radius grows with every hundredth of a turn: no formula of a whole."""
    width_m = 2 * (0.080 + KA * 1187 * 1186 / 2 / 65536 * 1e-5)
    area_m2 = math.pi * radius_m**2
    length_m = 0.0
    for _ in range(round(turns * 100)):
        laid = 2 * math.pi * math.sqrt(area_m2 / math.pi) / 100
        length_m += laid
        area_m2 += laid * math.pi / 4 * 0.005**2 / (packing * width_m)
    return length_m


ROPE_AND_DRUM = (
    *("--set", "rope_diameter_um=5000"),
    *("--set", "drum_core_diameter_um=400000"),
)


@pytest.mark.parametrize("packing", [0.45, 0.72, 0.9])
def test_the_packing_is_fitted_from_two_lengths(packing: float):
    first_m, second_m = (wind_turn_by_turn(0.2, packing, turns) for turns in (60, 420))
    result = levelwind(
        "rope", "--fit", f"{first_m:.3f}/{second_m:.3f}", "--turns", "360", "--json", *ROPE_AND_DRUM
    )
    told = json.loads(result.stdout)
    assert told["rope_packing_permille"] == pytest.approx(packing * 1000, abs=3)
    assert told["set"] == f"levelwind set rope_packing_permille={told['rope_packing_permille']}"
    low, high = told["rope_packing_permille_within"]
    assert low < told["rope_packing_permille"] < high
    # So fitted, a third length is right, too: 1,000 m and more, within 0.3 %.
    fitted = rope.Drum(0.2, 0.005, 2 * (0.080 + KA * 1187 * 1186 / 2 / 65536 * 1e-5))
    permille = told["rope_packing_permille"]
    long_m = wind_turn_by_turn(0.2, packing, 700)
    assert long_m > 1000
    assert fitted.length_m(700, permille / 1000) == pytest.approx(long_m, rel=0.003)


def test_the_fit_says_what_to_set():
    said = levelwind("rope", "--fit", "0/600", "--turns", "400", *ROPE_AND_DRUM).stdout
    assert said.splitlines()[-1].startswith("levelwind set rope_packing_permille=")
    assert "bare 200.0 mm" in said


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((), "Give --fit"),
        (("--fit", "100/800"), "Give --turns, or --from-device"),
        (("--fit", "800/100", "--turns", "9"), "lower number first"),
        (("--fit", "100", "--turns", "9"), "as in 100/800"),
        (("--fit", "100/100", "--turns", "9"), "the shorter first"),
        (("--fit", "-1/100", "--turns", "9"), "the shorter first"),
        (("--fit", "0/30000", "--turns", "9"), "0 to 20000 m"),
        (("--fit", "0/600", "--turns", "nan"), "--turns nan"),
        (("--fit", "0/600", "--turns", "-3"), "--turns -3"),
        (("--fit", "0/600", "--turns", "480"), "fit no packing from 0.1 to 1"),
        (("--fit", "0/600", "--turns", "40"), "Check the lengths, the turns, and the diameters"),
    ],
)
def test_a_fit_that_cannot_be_is_refused(arguments: tuple[str, ...], said: str):
    result = levelwind("rope", *arguments, *ROPE_AND_DRUM)
    assert result.exit_code == 1
    assert result.stdout == ""
    assert said in result.stderr


def test_a_fit_without_diameters_names_them():
    said = levelwind("rope", "--fit", "0/600", "--turns", "400").stderr
    assert "rope_diameter_um, drum_core_diameter_um" in said
    assert "levelwind set rope_diameter_um=..." in said


def drawn(rope_um: int, left_revs: float) -> tuple[list[float], int, list[str]]:
    """Diameters of the coils that the demonstration draws, how many are dotted, and all text."""
    figure = new_figure(8, 4)
    surface, section = figure.subplots(1, 2)
    revs = np.arange(10 * ANGLES) / ANGLES
    machine = picture.Machine(
        Screw(KA, 1187, 8000, -8000),
        {
            "rope_diameter_um": rope_um,
            "rope_per_drum_rev_um": 2_400_000,
            "flange_plus_um": 83_000,
            "flange_minus_um": -83_000,
        },
        EDGES_PER_REV,
    )
    lay = picture.Lay(-60 + 12 * revs, np.zeros(len(revs), dtype=int), left_revs)
    picture._rope(surface, section, lay, machine)
    solid, dotted = [c for c in section.collections if c.get_paths()] if rope_um else ([], [])
    if not rope_um:
        return [], 0, [text.get_text() for text in (*surface.texts, *section.texts)]
    diameters = [path.get_extents().width for path in solid.get_paths()]
    return diameters, len(dotted.get_paths()), []


@pytest.mark.parametrize("rope_um", [5000, 9000])
def test_the_demonstration_draws_the_rope_of_the_parameter(rope_um: int):
    diameters, dotted, _ = drawn(rope_um, 6.5)
    assert diameters == pytest.approx([rope_um / 1000] * 7, rel=1e-3)
    assert dotted == 3


def test_the_demonstration_draws_no_rope_that_it_does_not_know():
    _, _, said = drawn(0, 6.5)
    assert said == ["rope_diameter_um is 0: the rope is not drawn"] * 2


def test_the_pictures_of_the_page_are_those_that_the_tool_makes():
    for name, text in rope_pictures.pictures().items():
        assert (rope_pictures.DOC / name).read_text() == text, "run python tests/rope_pictures.py"
        assert f"]({name})" in (rope_pictures.DOC / "rope.md").read_text()
