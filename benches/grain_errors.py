"""Holds the error, the seconds and the memory that `trackbed plan` states for scenes on grains against those that their runs have.

    python3 benches/grain_errors.py BINARY DIR [--only TEXT] [--axles 8] [--seed 10] [--csv FILE]

Eight scenes, none of which was used to choose the constants of the planner: `transition_short` with other beds, loads, speeds, sleepers and ground,
each with its own packing, grains of 45 mm and more, and nine bays of grains. The reference of each is `full` (its numerics: the scene's own). The
tiers `zone`, `cells` and `law` are compared with it: errors of the settlement of the worst sleeper, of their mean, and of the step at the structure /
largest settlement; error of the largest seat load. DIR keeps the runs: what is finished there is not run again.
"""

import argparse
import csv
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import time

from program import program

here = pathlib.Path(__file__).resolve().parent.parent
arguments = argparse.ArgumentParser()
arguments.add_argument("binary", type=program)
arguments.add_argument("folder", type=pathlib.Path)
arguments.add_argument("--only", default="", help="scenes whose name has this text")
arguments.add_argument("--axles", default=8, type=int)
arguments.add_argument("--seed", default=10, type=int, help="of the first scene; each other scene has the next one")
arguments.add_argument("--csv", help="file for the table")
asked = arguments.parse_args()
asked.folder.mkdir(parents=True, exist_ok=True)

COARSE = [
    "ballast.grading=gradings.ballast_32_80 { cut_below = 45 mm }", "subballast.grading=gradings.subballast_0_150 { cut_below = 45 mm }",
    f"traffic.total={asked.axles} axles", f"track_response.after=[0, {asked.axles}] axles",
]
TAMPED = ["ballast.packing.restored=eased", "ballast.packing.friction=0.2", "subballast.packing.friction=0"]
SCENES = {
    "as shipped": [],
    "as tamped": TAMPED,
    "30 t axles": ["wagon.axle_load=30 t"],
    "80 km/h": ["ore.speed=80 km/h"],
    "closer sleepers": ["open.spacing=0.55 m"],
    "pads under sleepers": ["open.sleeper=sleepers.concrete { mass = 150 kg per seat, length = 2.4 m }", "open.usp=usps.medium", "stiff.usp=none"],
    "soft subgrade, as tamped": [*TAMPED, "subgrade.youngs_modulus=60 MPa"],
    "ballast alone, spheres": ["open.layers=[ballast: 450 mm, subgrade: 1 m]", "ballast.shape=spheres"],
}
TIERS = ["full", "zone", "cells", "law"]


def sets(edits):
    return [part for edit in edits for part in ("--set", edit)]


def planned(edits):
    done = subprocess.run([asked.binary, "plan", "transition_short.track", "--format", "json", *sets(edits)], capture_output=True, text=True, cwd=here / "scenarios")
    if done.returncode != 0:
        sys.exit(f"{edits}: {done.stderr[-3000:]}")
    plan = json.loads(done.stdout)
    parts = [plan["error"].get(part) or 0.0 for part in ("numerical", "of_tier")]
    return (parts[0] ** 2 + parts[1] ** 2) ** 0.5, plan["cost"]["seconds_on_two_cores"], plan["cost"]["bytes"]


def run(edits, seed, out):
    """Seconds and bytes of a run, kept beside it."""
    kept = out.with_suffix(".took.json")
    if not kept.exists():
        # beds are made anew: the plan counts them
        cache = out.with_suffix(".cache")
        command = [asked.binary, "run", "transition_short.track", "--seed", str(seed), "--threads", "2", "--out", out, "--cache", cache, *sets(edits)]
        if out.exists():
            command.append("--resume")
        began = time.monotonic()
        child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, cwd=here / "scenarios")
        said = child.stderr.read()
        _, status, used = os.wait4(child.pid, 0)
        # 1: an expectation of the scene is missed
        if status not in (0, 256) or not (out / "sleepers.csv").exists():
            sys.exit(f"{edits}: {said[-3000:]}")
        kept.write_text(json.dumps([time.monotonic() - began, 1024 * used.ru_maxrss]))
        shutil.rmtree(cache, ignore_errors=True)
    return json.loads(kept.read_text())


def rows(out):
    with open(out / "sleepers.csv") as file:
        all_rows = list(csv.DictReader(file))
    last = max(int(row["axles"]) for row in all_rows)
    return {row["x_m"]: row for row in all_rows if int(row["axles"]) == last}


def step(out):
    value = json.loads((out / "summary.json").read_text()).get("settlement_step")
    return value["value"] if isinstance(value, dict) else value


def errors(out, reference):
    """Of the settlement of any sleeper, of their mean, of the step at the structure and of the largest seat load."""
    a, b = rows(out), rows(reference)
    settled = lambda row: float(row["settlement_m"])
    largest = max(abs(settled(row)) for row in b.values())
    off = [(settled(a[x]) - settled(b[x])) / largest for x in b if -5.4 < float(x) < 0]
    seat = lambda table: max(float(row["max_rail_seat_load_N"]) for row in table.values())
    return max(map(abs, off)), statistics.mean(off), abs(step(out) - step(reference)) / largest, abs(seat(a) / seat(b) - 1), largest


table = []
print(f"{'scene':<28}{'tier':<8}{'expected':>10}{'sleeper':>10}{'mean':>10}{'step':>10}{'seat load':>10}{'planned s':>11}{'s':>8}{'planned MiB':>13}{'MiB':>8}")
for number, (name, edits) in enumerate(SCENES.items()):
    if asked.only not in name:
        continue
    seed, reference = asked.seed + number, None
    for tier in TIERS:
        out = asked.folder / f"{name} {seed} {tier}".replace(" ", "_").replace("/", "_").replace(",", "")
        of_tier = [*COARSE, *edits, f"solve.substructure={tier}"]
        share, seconds, size = planned(of_tier)
        if tier == "zone" and size == table[-1][10]:
            continue  # it has grains under all bays of this window, as `full` has
        took, used = run(of_tier, seed, out)
        reference = reference or out
        found = errors(out, reference)
        print(f"{name:<28}{tier:<8}" + f"{100 * share:>8.1f} %" + "".join(f"{100 * e:>8.1f} %" for e in found[:4])
              + f"{seconds:>11.0f}{took:>8.0f}{size / 2**20:>13.0f}{used / 2**20:>8.0f}", flush=True)
        table.append([name, tier, share, *found, seconds, took, size, used])

for tier in TIERS[1:]:
    of_tier = [row for row in table if row[1] == tier]
    if of_tier:
        covered = sum(row[2] >= row[3] for row in of_tier)
        medians = statistics.median(row[2] for row in of_tier), statistics.median(row[3] for row in of_tier)
        print(f"{tier}: {covered} of {len(of_tier)} expected errors cover the measured one; medians {100 * medians[0]:.1f} and {100 * medians[1]:.1f} %")
for tier in TIERS:
    of_tier = [row for row in table if row[1] == tier]
    near = lambda a, b, factor: sum(1 / factor <= row[a] / row[b] <= factor for row in of_tier)
    print(f"{tier}: seconds of {near(8, 9, 1.5)} of {len(of_tier)} within a factor of 1.5, memory of {near(10, 11, 1.2)} within 1.2")
if asked.csv:
    with open(asked.csv, "w") as file:
        writer = csv.writer(file)
        writer.writerow(["scene", "tier", "expected", "settlement", "mean", "step", "seat_load", "largest_m", "planned_s", "seconds", "planned_bytes", "bytes"])
        writer.writerows(table)
