"""Shows what longer steps of the grains cost and save: light grains get more inertia, and sleepers settle differently.

    python3 benches/grain_inertia.py BINARY DIR [--packings 16] [--steps 42 47 56] [--axles 24] [--csv FILE]

A small track on cells of coarse spheres on soft soil, one wagon after the other; it settles by centimetres. A line for each step (us): the largest
share of the mass that is added as inertia in a whole bed under a train (`bench scene`), settlement of the far field and of sleeper -1 / with the
first step on the same packing: mean over the packings and its standard error, and seconds / with the first step. Forces that differ by a thousandth
move one packing by up to 15 %, so only a mean over many packings can tell. A packing on which a run fails is left out. DIR keeps the runs: what is
finished there is not run again.
"""

import argparse
import csv
import json
import pathlib
import statistics
import subprocess
import sys
import time

from program import program
from small_track import SMALL_TRACK

arguments = argparse.ArgumentParser()
arguments.add_argument("binary", type=program)
arguments.add_argument("folder", type=pathlib.Path)
arguments.add_argument("--packings", default=16, type=int)
arguments.add_argument("--steps", default=[42, 47, 56], nargs="+", type=float, help="us; the first is the reference")
arguments.add_argument("--axles", default=24, type=int)
arguments.add_argument("--csv", help="file for the table")
asked = arguments.parse_args()
asked.folder.mkdir(parents=True, exist_ok=True)

SCENE = SMALL_TRACK + """track line { sections = [open: 18 m, stiff: 15 m], transitions = [edge: soft_to_stiff] }
vehicle wagon : vehicles.ore_wagon_20t { length = 12 m }
train ore { vehicles = wagon, speed = 200 km/h, direction = forward }
traffic { trains = ore, total = AXLES axles }
solve { substructure = cells, passages = continuous, update_every = 8 axles, tolerance = 2 % }
"""
scene = asked.folder / "small.track"
scene.write_text(SCENE.replace("AXLES", str(asked.axles)))


def settled(step, seed):
    """Settlement of the far field and of sleeper -1, m, and seconds of a run; `None` if it fails."""
    out = asked.folder / f"{step:g}_{seed}"
    took = out.with_suffix(".seconds")
    if not took.exists():
        began = time.monotonic()
        words = [asked.binary, "run", scene, "--seed", str(seed), "--threads", "2", "--set", f"solve.grain_step={step} us", "--out", out]
        done = subprocess.run([*words, "--force"] if out.exists() else words, capture_output=True, text=True)
        took.write_text(str(time.monotonic() - began) if (out / "sleepers.csv").exists() else "failed: " + done.stderr[-300:])
    if took.read_text().startswith("failed"):
        return None
    with open(out / "sleepers.csv") as file:
        rows = [row for row in csv.DictReader(file) if int(row["axles"]) == asked.axles]
    last = next(row for row in rows if row["sleeper"] == "-1")
    return float(rows[0]["settlement_m"]), float(last["settlement_m"]), float(took.read_text())


def added(step):
    """Share of the mass of a whole bed that is added as inertia under a train."""
    words = ["--set", "solve.substructure=full", "--set", "solve.window=-3 .. 1.2 m", "--set", f"solve.grain_step={step} us"]
    done = subprocess.run([asked.binary, "bench", "scene", scene, "--steps", "400", "--format", "json", *words], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr[-3000:])
    return json.loads(done.stdout)["added_inertia"]


def ratio(values, reference):
    """Mean of the settlement relative to the mean of the reference, with the standard error of the paired difference."""
    mean = statistics.mean(reference)
    off = [(a - b) / mean for a, b in zip(values, reference)]
    return 1 + statistics.mean(off), statistics.stdev(off) / len(off) ** 0.5


found = {step: [settled(step, seed) for seed in range(1, asked.packings + 1)] for step in asked.steps}
sound = [at for at in range(asked.packings) if all(runs[at] for runs in found.values())]
reference, table = list(zip(*(found[asked.steps[0]][at] for at in sound))), []
print(f"{len(sound)} of {asked.packings} packings\n{'step us':>8}{'added':>9}{'far field':>18}{'sleeper -1':>18}{'seconds':>9}")
for step, runs in found.items():
    far, last, took = zip(*(runs[at] for at in sound))
    (far, far_error), (last, last_error) = ratio(far, reference[0]), ratio(last, reference[1])
    seconds, share = statistics.median(took) / statistics.median(reference[2]), added(step)
    print(f"{step:>8g}{100 * share:>7.1f} %{far:>11.3f} ± {far_error:.3f}{last:>10.3f} ± {last_error:.3f}{seconds:>9.2f}", flush=True)
    table.append([step, share, far, far_error, last, last_error, seconds])
if asked.csv:
    with open(asked.csv, "w", newline="") as file:
        csv.writer(file).writerows([["step_us", "added_inertia", "far_field", "far_field_error", "sleeper", "sleeper_error", "seconds"], *table])
