"""Measures what each pass of the planner saves and what error it adds, on three scenes each.

    python3 benches/passes.py BINARY [--only TEXT] [--csv FILE] [--repeats N]

A scene is run with all passes and without one of them (`--without`, or with the setting that the pass would choose written out). A line each: the
seconds of both runs (medians), their ratio, and the largest difference of the settlement of any sleeper / the largest settlement. Passes for a law
run on `transition`, `usp` and `bridge` with `tolerance = 5 %`; passes for grains on a small track on coarse spheres before a slab, on soil, on softer
soil and under heavier axles. Beds are packed before the clock starts. Use a release build on a quiet machine.
"""

import argparse
import csv
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from program import program
from small_track import SMALL_TRACK

here = pathlib.Path(__file__).resolve().parent.parent
arguments = argparse.ArgumentParser()
arguments.add_argument("binary", type=program)
arguments.add_argument("--only", default="", help="passes whose name has this text")
arguments.add_argument("--csv", help="file for the table")
arguments.add_argument("--repeats", type=int, default=3, help="runs of each scene by a law")
arguments.add_argument("--threads", default="2")
asked = arguments.parse_args()

STATED = re.compile(r"^\s*(update_every|time_step|elements_per_bay)\s*=.*\n", re.M)
COARSE = SMALL_TRACK + """track line { sections = [open: 27 m, stiff: 18 m], transitions = [edge: soft_to_stiff] }
vehicle wagon : vehicles.ore_wagon_20t { length = 12 m }
train ore { vehicles = wagon, speed = 200 km/h, direction = forward }
traffic { trains = ore, total = 40 axles }
solve { substructure = cells, passages = continuous, update_every = 8 axles, seed = 1 }
"""
ON_LAW = {name: [] for name in ["transition", "usp", "bridge"]}
ON_GRAINS = {"coarse": [], "coarse, soil of 20 MPa": ["clay.youngs_modulus=20 MPa"], "coarse, 25 t axles": ["wagon.axle_load=25 t"]}

# name of the pass, its scenes, edits of both runs, and the words of the run without it
PASSES = [
    ("mesh: two elements a bay", ON_LAW, [], ["--without", "mesh"]),
    ("time step: from the tolerance", ON_LAW, [], ["--set", "solve.time_step=0.1 ms"]),
    ("exchange: blocks from the tolerance", ON_LAW, [], ["--without", "exchange"]),
    ("compare: one finer passage", ON_LAW, [], ["--without", "compare"]),
    ("share: one passage for equal trains", ON_LAW, [], ["--without", "share"]),
    ("cells: alike sleepers share, trains are left out", ON_GRAINS, ["solve.substructure=cells", "solve.tolerance=10 %"], ["--set", "solve.tolerance=0.1 %"]),
    ("bays: grains where settlement differs", ON_GRAINS, ["solve.substructure=zone", "solve.tolerance=10 %"], ["--without", "bays"]),
    ("cells for the whole bed", ON_GRAINS, ["solve.substructure=cells", "solve.tolerance=10 %"], ["--set", "solve.substructure=full"]),
]


def run(scene, out, words, folder):
    shutil.rmtree(out, ignore_errors=True)
    command = [asked.binary, "run", scene, "--threads", asked.threads, "--cache", folder / "cache", "--out", out, *words]
    began = time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True)
    # 1: an expectation of the scene is missed
    if done.returncode not in (0, 1) or not (out / "summary.json").exists():
        sys.exit(f"{scene} {words}: {done.stderr[-2000:]}")
    return time.monotonic() - began


def settlement(out):
    with open(out / "sleepers.csv") as file:
        rows = list(csv.DictReader(file))
    last = max(int(row["axles"]) for row in rows)
    return {row["x_m"]: float(row["settlement_m"]) for row in rows if int(row["axles"]) == last}


def difference(out, other):
    a, b = settlement(out), settlement(other)
    return max(abs(a[x] - b[x]) for x in b) / max(abs(value) for value in b.values())


table = []
with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    shutil.copytree(here / "scenarios", folder / "scenes")
    for file in (folder / "scenes").rglob("*.track"):
        file.write_text(STATED.sub("\n", file.read_text()))
    (folder / "scenes" / "coarse.track").write_text(COARSE)
    print(f"{'pass':<50}{'scene':<26}{'s':>8}{'s without':>11}{'ratio':>8}{'error added':>13}")
    for name, scenes, both, without in PASSES:
        if asked.only not in name:
            continue
        for label, edits in scenes.items():
            scene = folder / "scenes" / f"{label.split(',')[0]}.track"
            sets = [word for edit in [*both, *edits] for word in ("--set", edit)]
            on_law = scenes is ON_LAW
            if on_law:
                sets += ["--set", "solve.tolerance=5 %"]
            outs = folder / "with", folder / "without"
            words = sets, [*sets, *without]
            if not on_law:
                # packs the bed, and builds what is kept
                [run(scene, out, word, folder) for out, word in zip(outs, words)]
            times = [[], []]
            for _ in range(asked.repeats if on_law else 1):
                for seconds, out, word in zip(times, outs, words):
                    seconds.append(run(scene, out, word, folder))
            a, b = map(statistics.median, times)
            error = difference(*outs)
            print(f"{name:<50}{label:<26}{a:>8.2f}{b:>11.2f}{b / a:>8.2f}{100 * error:>11.3f} %", flush=True)
            table.append([name, label, round(a, 3), round(b, 3), error])
if asked.csv:
    with open(asked.csv, "w") as file:
        writer = csv.writer(file)
        writer.writerow(["pass", "scene", "seconds", "seconds_without", "error_added"])
        writer.writerows(table)
