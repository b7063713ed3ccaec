#!/usr/bin/env python3
"""Tables of the runs that benches/paper.sh made: paper.py DIR [PATTERN]. Numbers are of the last recorded count."""
import csv
import json
import re
import sys
from pathlib import Path

FAR, NEAR = -20, (-5, -3, -2, -1)


def row(directory):
    """What one run says, as text: settlement (mm), void (mm), force without a train (kN), largest seat load (kN), seconds."""
    with open(directory / "sleepers.csv") as file:
        rows = list(csv.DictReader(file))
    last = max(int(r["axles"]) for r in rows)
    at = {int(r["sleeper"]): r for r in rows if int(r["axles"]) == last}
    settled = [f"{1e3 * float(at[s]['settlement_m']):.3f}" for s in (FAR, *NEAR)]
    void = f"{1e3 * float(at[-1]['void_m']):.3f}"
    weight = f"{1e-3 * float(at[-3]['gravity_contact_force_N']):.2f}"
    load = f"{1e-3 * max(float(r['max_rail_seat_load_N']) for r in at.values()):.1f}"
    support = f"{1e-6 * float(at[FAR]['support_stiffness_N_per_m']):.0f}"
    seconds = json.loads((directory / "timings.json").read_text()).get("solve_s")
    return [str(last), *settled, void, weight, load, support, f"{seconds:.0f}" if seconds else ""]


def main():
    if len(sys.argv) < 2 or not Path(sys.argv[1]).is_dir():
        sys.exit("usage: paper.py DIR [PATTERN]; DIR is the folder that benches/paper.sh filled")
    folder, pattern = Path(sys.argv[1]), re.compile(sys.argv[2] if len(sys.argv) > 2 else ".")
    heads = ["run", "axles", "far, mm", *(f"{s}, mm" for s in NEAR), "void of -1, mm", "-3 bears, kN", "seat load, kN", "support, MN/m", "seconds"]
    print("| " + " | ".join(heads) + " |\n|" + "---|" * len(heads))
    for directory in sorted(d for d in folder.iterdir() if (d / "sleepers.csv").is_file() and pattern.search(d.name)):
        print("| " + " | ".join([directory.name, *row(directory)]) + " |")


if __name__ == "__main__":
    main()
