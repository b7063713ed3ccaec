"""Holds what `trackbed plan` expects of a run against what the run takes.

    python3 benches/estimates.py BINARY [--only TEXT] [--long] [--threads N]

Plans and runs every shipped scene, and mixes of what users change: other trains, laws, records, steps, lengths. A line each: counts planned and
counts done (passages and steps of a track; packings and steps of a bed are not told by a run), seconds planned, seconds on the clock and of the
processor, and the ratio of seconds done to seconds planned. At the end stands the share of scenes that the plan was right for within a factor
of 1.5. A bed is packed anew in every run. Use a release build on a quiet machine; scenes of more than ten minutes run with --long only.
"""

import argparse
import csv
import json
import os
import pathlib
import resource
import subprocess
import tempfile
import time

from program import program

here = pathlib.Path(__file__).resolve().parent.parent
scenes = here / "scenarios"
arguments = argparse.ArgumentParser()
arguments.add_argument("binary", type=program)
arguments.add_argument("--only", default="", help="scenes whose name has this text")
arguments.add_argument("--long", action="store_true", help="also what is planned to take more than ten minutes")
arguments.add_argument("--threads", default="2")
asked = arguments.parse_args()

BRIDGE = "bridge"
SHORT_BRIDGE = ["line.sections=[deck: 18 m, ballasted: 40 sleepers, deck: 18 m]"]
COARSE = ["solve.elements_per_bay=1", "solve.time_step=2e-4 s"]
ADAPTIVE = ["solve.update_every=adaptive(0.003 mm)"]
SMALL_RIG = ["stone.scale=1.6"]
EVERY_SEAT = ", ".join(str(number) for number in range(-60, 31) if number)

# name, scene, edited lines
MIXES = [
    ("mix, more passengers", BRIDGE, SHORT_BRIDGE + COARSE + ["traffic.trains=[freight: 30 %, passenger: 70 %]"]),
    ("mix, one way", BRIDGE, SHORT_BRIDGE + COARSE + ["freight.direction=forward", "passenger.direction=forward"]),
    ("mix, in turn", BRIDGE, SHORT_BRIDGE + COARSE + ["traffic.order=in_turn"]),
    ("mix, fine blocks", BRIDGE, SHORT_BRIDGE + COARSE + ADAPTIVE),
    ("mix, five times the axles", BRIDGE, SHORT_BRIDGE + COARSE + ["traffic.total=0.25 MGT"]),
    ("mix, blocks of 400", BRIDGE, SHORT_BRIDGE + COARSE + ["solve.update_every=400 axles", "traffic.total=4000 axles", "at_the_ends.after=[0, 4000] axles"]),
    ("mix, freight alone", BRIDGE, SHORT_BRIDGE + COARSE + ["traffic.trains=freight"]),
    ("mix, Selig and Waters", BRIDGE, SHORT_BRIDGE + COARSE + ["solve.law=laws.selig_waters_1994"]),
    ("mix, Shenton", BRIDGE, SHORT_BRIDGE + COARSE + ["solve.law=laws.shenton_1985"]),
    ("mix, Hettler", BRIDGE, SHORT_BRIDGE + COARSE + ["solve.law=laws.hettler_1984"]),
    ("mix, Nasrollahi", BRIDGE, SHORT_BRIDGE + COARSE + ["solve.law=laws.nasrollahi_2023"]),
    ("transition, adaptive", "transition", ADAPTIVE),
    ("transition, adaptive steps", "transition", ADAPTIVE + ["solve.time_step=adaptive"]),
    ("transition, Selig and Waters", "transition", ADAPTIVE + COARSE + ["solve.law=laws.selig_waters_1994"]),
    ("transition, Shenton", "transition", ADAPTIVE + COARSE + ["solve.law=laws.shenton_1985"]),
    ("transition, 60 km/h", "transition", ADAPTIVE + COARSE + ["ore.speed=60 km/h"]),
    ("transition, four wagons", "transition", ADAPTIVE + COARSE + ["ore.vehicles=[wagon, wagon, wagon, wagon]", "wagon.length=12 m", "line.sections=[open: 90 m, stiff: 90 m]", "traffic.total=480 axles", "track_response.after=[0, 480] axles"]),
    ("transition, 400 m", "transition", ADAPTIVE + COARSE + ["line.sections=[open: 300 m, stiff: 100 m]"]),
    ("transition, every seat recorded", "transition", COARSE + [f"track_response.at=[{EVERY_SEAT}] sleepers", "track_response.every=1e-4 s"]),
    ("transition, states", "transition", COARSE + ["track_response.states=vtk"]),
    ("transition, one train", "transition", ["traffic.total=4 axles", "track_response.after=[0, 4] axles", "solve.update_every=4 axles"]),
    ("oedometer, larger grains", "oedometer", SMALL_RIG),
    ("box, ten cycles", "box_test", SMALL_RIG + ["actuator.total=10 cycles", "pressure.after=[1, 10] cycles", "expect.that=[max(settlement) < 50 mm]"]),
    ("triaxial, larger grains", "triaxial", ["stone.scale=1.15"]),
]


def plan(scene, sets):
    words = [asked.binary, "plan", str(scenes / f"{scene}.track"), *(word for line in sets for word in ("--set", line)), "--format", "json"]
    told = subprocess.run(words, capture_output=True, text=True)
    return json.loads(told.stdout)["cost"] if told.returncode == 0 else told.stderr


def run(scene, sets, folder):
    words = [asked.binary, "run", str(scenes / f"{scene}.track"), *(word for line in sets for word in ("--set", line))]
    words += ["--out", str(folder / "out"), "--threads", asked.threads, "--cache", str(folder / "cache")]
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=dict(os.environ))
    wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def done(folder):
    """Passages and steps of a track."""
    path = folder / "out" / "blocks.csv"
    if not path.exists():
        return "", ""
    rows = list(csv.DictReader(path.open()))
    return (sum(int(row[name]) for row in rows) for name in ("passages", "time_steps"))


cases = [(path.stem, path.stem, []) for path in sorted(scenes.glob("*.track"))] + MIXES
print(f"{'scene':34} {'passages':>15} {'steps':>21} {'planned s':>10} {'clock s':>9} {'processor s':>11} {'ratio':>6}")
ratios, counted = [], []
for name, scene, sets in cases:
    if asked.only not in name:
        continue
    cost = plan(scene, sets)
    if isinstance(cost, str):
        print(f"{name:34} cannot be planned: {cost.strip().splitlines()[2].strip() if cost.strip() else ''}", flush=True)
        continue
    expected = cost["seconds_on_two_cores"]
    if expected > 600 and not asked.long:
        print(f"{name:34} planned to take {expected:.0f} s: left out", flush=True)
        continue
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        wall, processor = run(scene, sets, folder)
        passages, steps = done(folder)
    work = cost["work"].get("passages", {})
    counts = [f"{work.get(key, '')} -> {value}" if value != "" else "" for key, value in (("passages", passages), ("steps", steps))]
    # what takes less than a twentieth of a second is over before anybody reads the estimate
    ratio = max(wall, 0.05) / max(expected, 0.05)
    ratios.append((name, ratio))
    if passages != "" and work.get("passages"):
        counted.append(passages / work["passages"])
    print(f"{name:34} {counts[0]:>15} {counts[1]:>21} {expected:10.2f} {wall:9.2f} {processor:11.2f} {ratio:6.2f}", flush=True)

within = [ratio for _, ratio in ratios if 1 / 1.5 <= ratio <= 1.5]
if ratios:
    print(f"{len(within)} of {len(ratios)} within a factor of 1.5: {100 * len(within) / len(ratios):.0f} %")
    print("beyond: " + ", ".join(f"{name} {ratio:.2f}" for name, ratio in ratios if not 1 / 1.5 <= ratio <= 1.5))
if counted:
    within = [ratio for ratio in counted if 1 / 1.5 <= ratio <= 1.5]
    print(f"passages: {len(within)} of {len(counted)} within a factor of 1.5")
