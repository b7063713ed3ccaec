"""Holds the error that `trackbed plan` expects of a run by a settlement law against the error that the run has.

    python3 benches/tolerances.py BINARY [--only TEXT] [--tolerance "5 %"] [--csv FILE]

Runs scenes with `solve.tolerance` and without `update_every`, `time_step` and `elements_per_bay`, so that the planner chooses all three, and
compares each with a fine run: adaptive blocks of 3 um, steps of 0.1 ms and four elements a bay. A line each: expected and measured error of
the settlement of any sleeper / the largest settlement, errors of the step at the structure, of the largest seat load and of the wheel forces, and the
seconds of both runs. `transition` and `bridge` were used to choose the constants of the planner; the shares at the end leave them out.
"""

import argparse
import csv
import json
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from program import program

here = pathlib.Path(__file__).resolve().parent.parent
arguments = argparse.ArgumentParser()
arguments.add_argument("binary", type=program)
arguments.add_argument("--only", default="", help="scenes whose name has this text")
arguments.add_argument("--tolerance", default="5 %")
arguments.add_argument("--csv", help="file for the table")
arguments.add_argument("--threads", default="2")
asked = arguments.parse_args()

TUNED = ["transition", "bridge"]
STATED = re.compile(r"^\s*(update_every|time_step|elements_per_bay)\s*=.*\n", re.M)
FINE = ["solve.update_every=adaptive(0.003 mm)", "solve.time_step=0.1 ms", "solve.elements_per_bay=4"]
CASES = [(name, name, []) for name in [
    "transition", "bridge", "usp", "wedge", "pads", "sleepers", "study_mitigations", "study_pads", "study_spacing", "study_speed", "study_support",
    "study_usp", "study_wedge",
]]
CASES += [("cookbook " + name, "cookbook/" + name, []) for name in [
    "approach_slab", "auxiliary_rails", "ballasted_bridge", "measured_level", "mixed_traffic", "pads_over_sleepers", "sleeper_spacing",
    "tamping_intervals", "tunnel_portal", "wedge", "wide_sleepers",
]]
CASES += [("transition " + name, "transition", edits) for name, edits in {
    "at 80 km/h": ["ore.speed=80 km/h"],
    "at 300 km/h": ["ore.speed=300 km/h"],
    "20 MN/m": ["open.support.stiffness=20 MN/m per seat"],
    "120 MN/m": ["open.support.stiffness=120 MN/m per seat"],
    "5000 axles": ["traffic.total=5000 axles"],
    "30 t": ["wagon.axle_load=30 t"],
    "soft pads": ["open.pad.stiffness=15 MN/m"],
}.items()]


def run(scene, out, edits):
    sets = [part for edit in edits for part in ("--set", edit)]
    began = time.monotonic()
    done = subprocess.run([asked.binary, "run", scene, "--threads", asked.threads, "--out", out, *sets], capture_output=True, text=True)
    # 1: an expectation of the scene is missed
    if done.returncode not in (0, 1) or not (out / "summary.json").exists():
        sys.exit(f"{scene} {edits}: {done.stderr[-2000:]}")
    return time.monotonic() - began


def expected(scene, edits):
    sets = [part for edit in edits for part in ("--set", edit)]
    done = subprocess.run([asked.binary, "plan", scene, "--format", "json", *sets], capture_output=True, text=True)
    plan = json.loads(done.stdout)
    return plan["error"]["numerical"], plan["cost"]["seconds_on_two_cores"]


def rows(out):
    with open(out / "sleepers.csv") as file:
        all_rows = list(csv.DictReader(file))
    last = max(int(row["axles"]) for row in all_rows)
    # a count with tamping has two states; the last is compared
    return {row["x_m"]: row for row in all_rows if int(row["axles"]) == last}


def forces(out):
    with open(out / "blocks.csv") as file:
        last = list(csv.DictReader(file))[-1]
    return float(last["max_wheel_force_N"]), float(last["min_wheel_force_N"])


def scalar(out, name):
    value = json.loads((out / "summary.json").read_text()).get(name)
    return value["value"] if isinstance(value, dict) else value


def errors(out, fine):
    a, b = rows(out), rows(fine)
    value = lambda row, key: float(row[key])
    largest = max(abs(value(row, "settlement_m")) for row in b.values())
    settlement = max(abs(value(a[x], "settlement_m") - value(b[x], "settlement_m")) for x in b) / largest
    seat = lambda table: max(value(row, "max_rail_seat_load_N") for row in table.values())
    wheel = max(abs(p - q) for p, q in zip(forces(out), forces(fine))) / forces(fine)[0]
    steps = scalar(out, "settlement_step"), scalar(fine, "settlement_step")
    step = abs(steps[0] - steps[1]) / largest if None not in steps else None
    return settlement, step, abs(seat(a) / seat(b) - 1), wheel


def percent(share):
    return "" if share is None else f"{100 * share:.3f} %"


table = []
with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    shutil.copytree(here / "scenarios", folder / "scenes")
    for file in (folder / "scenes").rglob("*.track"):
        file.write_text(STATED.sub("\n", file.read_text()))
    print(f"{'scene':<34}{'expected':>10}{'measured':>10}{'step':>10}{'seat load':>10}{'wheel':>10}{'planned s':>10}{'s':>8}{'fine s':>8}")
    for name, file, edits in CASES:
        if asked.only not in name:
            continue
        scene, out, fine = folder / "scenes" / f"{file}.track", folder / "out", folder / "fine"
        coarse = [f"solve.tolerance={asked.tolerance}", *edits]
        share, planned = expected(scene, coarse)
        seconds, of_fine = run(scene, out, coarse), run(scene, fine, [*FINE, *edits])
        found = errors(out, fine)
        cells = [percent(share), *map(percent, found), f"{planned:.2f}", f"{seconds:.2f}", f"{of_fine:.1f}"]
        print(f"{name:<34}" + "".join(f"{cell:>{10 if k < 6 else 8}}" for k, cell in enumerate(cells)), flush=True)
        table.append([name, share, *found, planned, seconds, of_fine])
        shutil.rmtree(out), shutil.rmtree(fine)

others = [row for row in table if row[0] not in TUNED and row[1] is not None]
if others:
    covered = sum(row[1] >= row[2] for row in others)
    medians = statistics.median(row[1] for row in others), statistics.median(row[2] for row in others)
    near = sum(1 / 1.5 <= row[6] / row[7] <= 1.5 for row in others)
    print(f"\n{covered} of {len(others)} expected errors cover the measured one; medians {percent(medians[0])} and {percent(medians[1])}")
    print(f"{near} of {len(others)} seconds are planned to within a factor of 1.5")
if asked.csv:
    with open(asked.csv, "w") as file:
        writer = csv.writer(file)
        writer.writerow(["scene", "expected", "settlement", "step", "seat_load", "wheel_force", "planned_s", "seconds", "fine_s"])
        writer.writerows(table)
