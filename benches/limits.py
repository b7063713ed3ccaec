"""Measures what large input costs the program, and what it refuses.

    python3 benches/limits.py BINARY [--times N]

Growth: each command reads one input and one ten times as large, N times in turn (3 where it is not said). A line gives the medians of seconds
and their ratio: 10 is linear, 100 is the square. The time of an empty scene is taken off both. Refusals: seconds, memory and what is said of
works that no machine can hold, of modules that never end, and of a file of nothing but mistakes.
"""

import argparse
import os
import pathlib
import re
import resource
import statistics
import subprocess
import tempfile
import time

from program import program

here = pathlib.Path(__file__).resolve().parent.parent
arguments = argparse.ArgumentParser()
arguments.add_argument("binary", type=program)
arguments.add_argument("--times", type=int, default=3)
asked = arguments.parse_args()
binary = asked.binary
TRACK = (here / "scenarios/transition.track").read_text()
BOX = (here / "scenarios/box_test.track").read_text()


def run(folder, words):
    """Seconds, MiB at most, exit code and what was said."""
    begun = time.perf_counter()
    child = subprocess.Popen([binary, *words], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    said = child.stdout.read().decode(errors="replace")
    _, status, usage = os.wait4(child.pid, 0)
    return time.perf_counter() - begun, usage.ru_maxrss / 1024, os.waitstatus_to_exitcode(status), said


def lets(folder, count):
    (folder / "a.track").write_text("".join(f"let   a{k} = {k} mm\n" for k in range(count)))
    return ["fmt", "a.track"]


def level(folder, count):
    step = 68.0 / count
    rows = "".join(f"{-43 + k * step:.6f},{0.001 * (k % 7):.3f}\n" for k in range(count))
    (folder / "level.csv").write_text("x_m,level_mm\n" + rows)
    track = TRACK.replace("track line {", 'track line {\n  irregularity = file("level.csv")')
    (folder / "a.track").write_text(track)
    return ["check", "a.track"]


def templates(folder, count):
    shape = f"clumps(2 .. 3, ratio = 0.8, distance = 110 deg, templates = {count})"
    (folder / "a.track").write_text(BOX.replace("grading.cut_below = 40 mm", f"shape = {shape}, grading.cut_below = 40 mm"))
    return ["plan", "a.track"]


def points(folder, count):
    study = f"""
study pads_and_speed {{
  vary = [open.pad.stiffness: 20 .. 80 MN/m, ore.speed: 100 .. 200 km/h]
  sampling = sobol({count})
  minimise = max(settlement)
}}
"""
    (folder / "a.track").write_text(TRACK + study)
    return ["check", "a.track"]


def mistakes(folder, count):
    (folder / "a.track").write_text("".join(f"rail m{k} : r{k} {{ mass = 60 kgg/m }}\n" for k in range(count)))
    return ["check", "a.track"]


def page(folder, count):
    seats = ", ".join(str(k) for k in range(-count // 2, count // 2 + 1) if k)
    track = TRACK.replace("at         = [-20, -13, -5, -3, +1, +7] sleepers", f"at = [{seats}] sleepers")
    track = track.replace("[0, 100, 500]", "[0, 40]").replace("total = 500 axles", "total = 40 axles")
    track = track.replace("open: 42 m, stiff: 24 m", "open: 90 m, stiff: 90 m")
    (folder / "a.track").write_text(track)
    out = folder / f"out{count}"
    if not out.exists():
        assert "report" in run(folder, ["run", "a.track", "--out", out])[3]
    return ["report", out]


GROWTH = [
    ("`fmt`, `let`s", lets, 4_000),
    ("`check`, rows of a measured level", level, 40_000),
    ("`check`, mistakes", mistakes, 4_000),
    ("`plan`, templates of clumps", templates, 20),
    ("`check`, points of a Sobol study", points, 1_000),
    ("`report`, recorded seats", page, 8),
]


def growth():
    print("| what | size | s | ten times the size, s | ratio |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "empty.track").write_text("scenario { title = \"nothing\" }\n")
        empty = statistics.median(run(folder, ["check", "empty.track"])[0] for _ in range(5))
        for what, make, size in GROWTH:
            times = {size: [], 10 * size: []}
            for _ in range(asked.times):
                for count in times:
                    words = make(folder, count)
                    seconds, _, code, said = run(folder, words)
                    assert code in (0, 1) and "panicked" not in said, said[-600:]
                    times[count].append(seconds)
            small, large = (statistics.median(of) for of in times.values())
            print(f"| {what} | {size:,} | {small:.2f} | {large:.2f} | {(large - empty) / max(small - empty, 1e-3):.1f} |", flush=True)


LONG = ["--set", "line.sections=[open: 100 km, stiff: 100 km]", "--set", "solve.elements_per_bay=32", "--set", "solve.time_step=1e-6 s"]
WIDE = ["--set", "box.sections=[bed: 50000 sleepers]", "--set", "box.bed_width=20 m per track"]


def refusals():
    print("\n| what | exit | s | MiB | said |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        os.mkfifo(folder / "pipe.track")
        (folder / "device.track").symlink_to("/dev/zero")
        (folder / "outside.track").symlink_to("/etc/passwd")
        works = [
            ("200 km of track, 32 elements a bay, 1 us", ["run", here / "scenarios/transition.track", *LONG, "--out", folder / "long"]),
            ("a test rig of 50,000 sleepers, 20 m wide", ["run", here / "scenarios/box_test.track", *WIDE, "--out", folder / "wide"]),
        ]
        for module in ("pipe", "device", "outside"):
            scene = folder / f"uses_{module}.track"
            scene.write_text(f"use {module}\n")
            works.append((f"`use {module}`", ["check", scene]))
        works.append(("8 MB of mistakes", mistakes(folder, 200_000)))
        for what, words in works:
            seconds, mebibytes, code, said = run(folder, words)
            plain = re.sub(r"\x1b\[[0-9;]*m", "", said)
            first = re.search(r"E\d{4}", plain)
            size = f", {len(said) / 1e6:.2f} MB of text" if len(said) > 1e5 else ""
            print(f"| {what} | {code} | {seconds:.2f} | {mebibytes:.0f} | {first.group() if first else plain[:60]}{size} |", flush=True)


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    growth()
    refusals()
