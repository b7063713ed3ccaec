"""Compares soil at rest with CalculiX on the same mesh.

    cargo build --example soil_layer
    python3 benches/soil_calculix.py target/debug/examples/soil_layer [--ccx ccx]

A pressure of 100 kPa on a rectangle of 0.6 m by 1.0 m, on 0.4 m of a soft layer over 0.8 m of a stiffer one on rock; a quarter of it. CalculiX
(Debian `calculix-ccx`) takes elements C3D8I, whose incompatible modes keep them from locking, and C3D8, which have none. A line each: size of the
elements, the settlement of the middle of the load, of its corner and 1 m beside its middle in millimetres, and the largest difference of any node's
displacement to C3D8I as a part of the largest displacement.
"""

import argparse
import csv
import pathlib
import shutil
import subprocess
import sys
import tempfile

from program import program

arguments = argparse.ArgumentParser()
arguments.add_argument("binary", type=program, help="the example soil_layer")
arguments.add_argument("--ccx", default="ccx")
arguments.add_argument("--sizes", default="0.1")
asked = arguments.parse_args()
if shutil.which(asked.ccx) is None:
    sys.exit(f"{asked.ccx} is not installed; on Debian it is in calculix-ccx")


def ours(path):
    with open(path) as file:
        rows = [[float(row[k]) for k in "xyzuvw"] for row in csv.DictReader(file)]
    return [row[:3] for row in rows], [row[3:] for row in rows]


def calculix(directory, element):
    text = (directory / "layer.inp").read_text().replace("TYPE=C3D8I", f"TYPE={element}")
    (directory / f"{element}.inp").write_text(text)
    subprocess.run([asked.ccx, element], cwd=directory, check=True, stdout=subprocess.DEVNULL)
    rows = [line.split() for line in (directory / f"{element}.dat").read_text().splitlines()]
    rows = [row for row in rows if len(row) == 4 and row[0].isdigit()]
    return [[float(x) for x in row[1:]] for row in sorted(rows, key=lambda row: int(row[0]))]


print(f"{'size':>5} {'elements':>28} {'middle':>9} {'corner':>9} {'1 m':>9} {'difference':>11}")
for size in asked.sizes.split(","):
    with tempfile.TemporaryDirectory() as name:
        directory = pathlib.Path(name)
        subprocess.run([asked.binary, directory, size], check=True)
        found = {f"CalculiX {element}": calculix(directory, element) for element in ("C3D8I", "C3D8")}
        nodes, found["mean strain"] = ours(directory / "mean.csv")
        _, found["mixed discretisation"] = ours(directory / "mixed.csv")
    reference = found["CalculiX C3D8I"]
    largest = max(abs(x) for u in reference for x in u)
    places = [(0, 0, 1.2), (0.3, 0.5, 1.2), (1.0, 0, 1.2)]
    at = [min(range(len(nodes)), key=lambda n: sum((a - b) ** 2 for a, b in zip(nodes[n], place))) for place in places]
    for name, u in found.items():
        apart = max(abs(a - b) for p, q in zip(u, reference) for a, b in zip(p, q)) / largest
        shown = " ".join(f"{-1e3 * u[n][2]:9.5f}" for n in at)
        print(f"{size:>5} {name:>28} {shown} {100 * apart:9.2f} %")
