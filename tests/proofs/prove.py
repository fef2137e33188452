# SPDX-License-Identifier: Apache-2.0
"""Prove what doc/control-law.md and doc/architecture.md call proved: `./dev proof`.

Frama-C's WP makes goals of the annotated C and has them proved by Z3 and CVC4. A proof that would
also pass on broken code is none: with --mutants the code is broken, and each proof must fail.
"""

import argparse
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "build" / "proof"
PROVE_TIMEOUT_S = 60  # of one prover for one goal; what is proved takes about a second
MUTANT_TIMEOUT_S = 4

# C11, 6.3.1.3, which WP does not know; where C leaves it to the compiler, conversions.c tries it.
AXIOMS = {"uint32_below", "uint32_above", "int32_above", "uint16_of_uint32", "uint32_of_uint64"}
BYTES = "lw_record_open,erased,lw_crc32,lw_crc32_add,lw_crc16,"
BYTES += "lw_rtu_receive,lw_rtu_poll,lw_rtu_drop,is_complete,lw_rtu_deadline_us,lw_rtu_seal,"
BYTES += "lw_param_record_decode,is_schema_1,decode_1,decode_2,take,get32_1"
BANK = "lw_bank_read_registers,lw_bank_read_bits,lw_point_allows,"
BANK += "check_known,find,find_in,point_before,registers_of,load,lw_refuse,lw_clamp32"
CAM = "lw_cam_inside_straight,lw_cam_inside_curved,lw_cam_inside_wide,lw_cam_numerator,"
CAM += "straight_there_and_back,curved_there_and_back"
TOGETHER = "lw_law_short_edges,lw_law_edges_to_step"
PROOFS = {
    # A shift, which WP has no rules for when negative: conversions.c tries it on every value. And
    # edges taken together, which the tests compare with the edges one by one.
    "law.c": (f"-wp-skip-fct=lw_law_pos_usteps,{TOGETHER}",),
    "bytes.c": (f"-wp-fct={BYTES}",),
    # That a called pointer is a function, WP knows from the annotation `calls`.
    "bank.c": (f"-wp-fct={BANK}", "-rte-no-pointer-call"),
    "orbit.c": (),
    "cam.c": (f"-wp-fct={CAM}",),
}
# Z3 adds nothing for the bank but time.
PROVERS = {"bank.c": "cvc4"}
# What WP prints of a goal, with several provers and with one; and at the end.
NOT_PROVED = re.compile(r"\[Failed\] Goal|\] Goal \S+ : (?!Valid)")
ALL_PROVED = re.compile(r"^\[wp\] Proved goals: +([1-9]\d*) / \1$", re.MULTILINE)


@dataclass
class Mutant:
    """One way to break the code."""

    file: str
    old: str
    new: str
    function: str
    proof: str = "law.c"
    properties: str = "@ensures"


LAW_H = "lib/lw_core/include/lw/motion/law.h"
LAW_C = "lib/lw_core/src/motion/law.c"
RECORD_C = "lib/lw_core/src/storage/record.c"
RTU_C = "lib/lw_core/src/modbus/rtu.c"
BANK_C = "lib/lw_core/src/modbus/bank.c"
PARAMS_C = "lib/lw_core/src/storage/param_record.c"
CRC16_C = "lib/lw_core/src/modbus/crc16.c"
CAM_H = "lib/lw_core/include/lw/cam/cam.h"
ORBIT_H = "tests/proofs/orbit.h"
FAR_POINT = ("far_point_is_on_orbit", "orbit.c")
EDGE = "lw_law_short_edge"
RECORD = ("lw_record_open", "bytes.c", "-@ensures")
RECEIVE = ("lw_rtu_receive", "bytes.c", "-@ensures")
TAKE = ("take", "bytes.c", "-@ensures")
DECODE = ("decode_2", "bytes.c", "-@ensures")
IS_SCHEMA_1 = ("is_schema_1", "bytes.c", "-@ensures")
FIND_IN = ("find_in", "bank.c", "@ensures")
FIND = ("find", "bank.c", "@invariant")
LOAD = ("load", "bank.c", "-@ensures")
READ = ("lw_bank_read_registers", "bank.c", "@requires")
CHANGE = "lw_law_slope_change"
RESTS = "lw_law_rests"
PASS = "pass_far_point"
STRAIGHT = ("lw_cam_inside_straight", "cam.c")
CURVED = ("lw_cam_inside_curved", "cam.c")
WIDE = ("lw_cam_inside_wide", "cam.c")
TRIANGLE = ("breaker_adds", "law.c", "triangle")
MUTANTS = (
    Mutant(LAW_H, "? law->ka : -law->ka", "? -law->ka : law->ka", CHANGE),
    Mutant(LAW_H, "at >= law->below_from", "at > law->below_from", CHANGE),
    Mutant(LAW_H, "if (rel >= span) {", "if (rel > span) {", EDGE),
    Mutant(LAW_H, "moved += change;", "moved -= change;", EDGE),
    Mutant(LAW_H, "slope_change(law, to)", "slope_change(law, rel)", EDGE),
    Mutant(LAW_H, "to = rel - (uint32_t)u;", "to = rel - (uint32_t)law->ka;", EDGE),
    Mutant(LAW_H, "(uint16_t)rel - u)", "(uint16_t)rel - u - 1)", EDGE),
    Mutant(LAW_C, "edges < dwell_of", "edges <= dwell_of", RESTS),
    # The ribbon breaker: its triangle, and the numbers of the cycle.
    Mutant(LAW_C, "(cycle < down ? cycle : down)", "cycle", *TRIANGLE),
    Mutant(LAW_C, "? cycle + 1 : 0", "? cycle + 1 : 1", "cycle_then"),
    Mutant(LAW_C, "cycle > 0 ? cycle - 1", "cycle > 1 ? cycle - 1", "cycle_then"),
    Mutant(LAW_C, "cycle_minus = cycle_then(law, law->cycle_minus, dd)", "cycle_minus = 0", PASS),
    Mutant(LAW_C, "if (dd < 0 && law->u == lw", "if (law->u == lw", RESTS),
    # The paper's law: the same change of slope in both directions.
    Mutant(ORBIT_H, ": -region(", ": region(", "orbit_is_kept", "orbit.c", "@assert"),
    # The far point that a turning drum is taken up from.
    Mutant(ORBIT_H, "(begin - m) == ka * (nr * (nr + 1))", "(begin - m) == 0", *FAR_POINT),
    Mutant(ORBIT_H, "(m - end) == ka * (nr * (nr - 1))", "(m - end) == ka", *FAR_POINT),
    Mutant(RECORD_C, "length > size - LW", "length > size + LW", *RECORD),
    Mutant(RECORD_C, "size < LW_RECORD_OVERHEAD", "size < 4", *RECORD),
    Mutant(RTU_C, "count > LW_RTU_FRAME_MAX - rtu->length", "count > LW_RTU_FRAME_MAX", *RECEIVE),
    Mutant(PARAMS_C, "*next < LW_MAP", "*next <= LW_MAP", *TAKE),
    Mutant(PARAMS_C, "% ENTRY_SIZE == 0 ?", "% 2 == 0 ?", *DECODE),
    Mutant(PARAMS_C, "size >= SIZE_1", "size >= SIZE_1 - 4", *IS_SCHEMA_1),
    Mutant(BANK_C, "if (distance >= (uint", "if (distance > (uint", *FIND_IN),
    Mutant(BANK_C, "sections[i].space == space", "sections[i].space != space", *FIND),
    Mutant(BANK_C, "at + element * sizeof(wide)", "at + 2 + element * sizeof(wide)", *LOAD),
    Mutant(BANK_C, "lw_put16(&out[2 * i],", "lw_put16(&out[2 * i + 1],", *READ),
    # A cam's edge inside of a piece.
    Mutant(CAM_H, "steps = -point->numbers.whole;", "steps = point->numbers.whole;", *STRAIGHT),
    Mutant(
        CAM_H,
        "slope += curve;\n\t\tif (slope >= den) {\n\t\t\tslope -= den;\n\t\t\twhole++;\n"
        "\t\t}\n\t\tpoint",
        "slope += curve;\n\t\tpoint",
        *CURVED,
    ),
    Mutant(
        CAM_H, "return lw_cam_inside_straight(cam, dd);\n}\n\n/**", "return 0;\n}\n\n/**", *CURVED
    ),
    Mutant(
        CAM_H, "slope -= curve;\n\t\tif (slope < 0)", "slope -= curve;\n\t\tif (slope <= 0)", *WIDE
    ),
    Mutant(CAM_H, "(uint64_t)slope / 0x100000000", "(uint64_t)slope / 0x80000000", *WIDE),
    Mutant(CRC16_C, "i < count", "i <= count", "lw_crc16", "bytes.c", "-@ensures"),
)


def frama_c(proof: str, timeout_s: int, options: list[str], root: Path) -> subprocess.Popen[str]:
    """Start WP on a file of this folder, below `root`."""
    include = [
        f"-I{shlex.quote(str(root / 'lib/lw_core' / name))}" for name in ("include", "generated")
    ]
    return subprocess.Popen(
        [
            "frama-c",
            "-machdep=gcc_x86_64",
            f"-cpp-extra-args={' '.join(include)}",
            str(root / "tests" / "proofs" / proof),
            "-wp",
            "-wp-rte",
            f"-wp-prover={PROVERS.get(proof, 'z3,cvc4')}",
            f"-wp-timeout={timeout_s}",
            f"-wp-par={os.cpu_count()}",
            *options,
        ],
        cwd=root,
        env=os.environ | {"WHY3CONFIG": str(OUT / "why3.conf")},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )


def find_provers() -> None:
    """Why3 finds the provers of this machine; the user's own configuration is left alone."""
    OUT.mkdir(parents=True, exist_ok=True)
    config = OUT / "why3.conf"
    config.unlink(missing_ok=True)
    subprocess.run(
        ["why3", "config", "detect"],
        check=True,
        capture_output=True,
        env=os.environ | {"WHY3CONFIG": str(config)},
    )


def try_conversions() -> bool:
    """Run conversions.c on this machine's compiler."""
    program = OUT / "conversions"
    include = f"-I{ROOT / 'lib/lw_core/include'}"
    source = ROOT / "tests" / "proofs" / "conversions.c"
    subprocess.run(["gcc", "-O3", include, str(source), "-o", str(program)], check=True)
    holds = subprocess.run([str(program)], check=False).returncode == 0
    print(f"{source.name:14} {'every value of 32 bits' if holds else 'FAILED'}", flush=True)
    return holds


def taken_for_granted() -> list[str]:
    """What the annotations assume beyond AXIOMS, and right shifts, which WP 25 gets wrong."""
    found = []
    for name in (LAW_H, LAW_C):
        for line in (ROOT / name).read_text().splitlines():
            if ">>" in line and line.strip() != "return m >> 16;":
                found.append(f"{name}: {line.strip()}")
    for path in [*ROOT.glob("tests/proofs/*.[ch]"), *ROOT.glob("lib/lw_core/**/*.[ch]")]:
        for word, name in re.findall(r"\b(axiom|admit)\s+(\w+)", path.read_text()):
            if word == "admit" or name not in AXIOMS:
                found.append(f"{path.name}: {word} {name}")
    return found


def prove(proof: str) -> bool:
    """Run one proof and print what is proved of each function."""
    report = OUT / f"{proof}.json"
    process = frama_c(
        proof,
        PROVE_TIMEOUT_S,
        [*PROOFS[proof], f"-wp-report-json={report}"],
        ROOT,
    )
    output, _ = process.communicate()
    if process.returncode != 0 or "[wp] Proved goals" not in output:
        print(output)
        return False
    functions = json.loads(report.read_text())
    rows = {name: sections["wp:section"] for name, sections in functions["wp:functions"].items()}
    lemmas = functions.get("wp:axiomatics", {}).get("")
    if lemmas:
        rows["lemmas"] = lemmas["wp:section"]
    goals = functions["wp:global"]["wp:main"]
    rows["in all"] = {"wp:main": goals}
    complete = True
    for name, section in rows.items():
        proved, total = section["wp:main"].get("valid", 0), section["wp:main"]["total"]
        complete &= proved == total
        print(f"{proof:14} {name:28} {proved:4} of {total}", flush=True)
    if not complete:
        print("\n".join(line for line in output.splitlines() if NOT_PROVED.search(line)))
    return complete


def proof_fails(mutant: Mutant, root: Path) -> bool:
    """Does the proof of the mutant's properties fail on the sources below `root`?"""
    options = [f"-wp-fct={mutant.function}", f"-wp-prop={mutant.properties}"]
    process = frama_c(mutant.proof, MUTANT_TIMEOUT_S, options, root)
    output = ""
    failed = False
    assert process.stdout is not None
    for line in process.stdout:
        output += line
        if NOT_PROVED.search(line):
            failed = True
            os.killpg(process.pid, signal.SIGTERM)
            break
    process.wait()
    if not failed and not ALL_PROVED.search(output):
        sys.exit(f"no verdict on '{mutant.new}':\n{output}")
    return failed


def is_caught(mutant: Mutant) -> bool:
    """Does the proof of the broken function fail?"""
    root = OUT / f"mutant_{MUTANTS.index(mutant)}"
    shutil.rmtree(root, ignore_errors=True)
    shutil.copytree(ROOT / "lib" / "lw_core", root / "lib" / "lw_core")
    shutil.copytree(ROOT / "tests" / "proofs", root / "tests" / "proofs")
    path = root / mutant.file
    text = path.read_text()
    if text.count(mutant.old) != 1:
        sys.exit(f"{mutant.file}: '{mutant.old}' is there {text.count(mutant.old)} times, not once")
    path.write_text(text.replace(mutant.old, mutant.new))
    return proof_fails(mutant, root)


def run_mutants() -> bool:
    """Break the code in each way; the proof must fail each time."""
    all_caught = True
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for mutant, caught in zip(MUTANTS, pool.map(is_caught, MUTANTS), strict=True):
            all_caught &= caught
            verdict = "proof fails, as it must" if caught else "STILL PROVED"
            print(f"{mutant.function:28} {mutant.new:45} {verdict}", flush=True)
    return all_caught


def run_controls() -> bool:
    """What fails on broken code must be proved, in the same short time, on the code as it is."""
    kinds = {(m.proof, m.function, m.properties): m for m in MUTANTS}.values()
    all_proved = True
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for mutant, fails in zip(
            kinds, pool.map(lambda m: proof_fails(m, ROOT), kinds), strict=True
        ):
            all_proved &= not fails
            verdict = "NOT PROVED IN TIME" if fails else "proved"
            print(f"{mutant.function:28} {'as it is':45} {verdict}", flush=True)
    return all_proved


def main() -> int:
    """Exit status 0: all goals proved, and with --mutants every broken code noticed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--mutants",
        action="store_true",
        help="also break the code and see the proofs fail, and hold on the code as it is",
    )
    parser.add_argument("--only-mutants", action="store_true", help="nothing but that")
    arguments = parser.parse_args()
    find_provers()
    assumed = taken_for_granted()
    for line in assumed:
        print(f"cannot be proved: {line}")
    complete = not assumed
    if not arguments.only_mutants:
        complete &= try_conversions()
        # WP prepares its goals on one processor: one file for each.
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            complete &= all(list(pool.map(prove, PROOFS)))
    if arguments.mutants:
        complete &= run_controls()
    if arguments.mutants or arguments.only_mutants:
        complete &= run_mutants()
    return 0 if complete else 1


if __name__ == "__main__":
    sys.exit(main())
