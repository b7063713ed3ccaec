# Spheres or clumps under the law of `trackbed bench grains`, for YADE 2023.
# KIND=spheres|clumps FILE=... SIZE='lx ly' SKIN=m WARM=n STEPS=n yade -n -x -j1 yade.py
# Stiffness and dashpot belong to bodies here, and two in series make a contact: bodies have twice the contact's. The dashpot
# may not pull, and friction is a share of the spring's force. The floor stands inside the cell, away from its own image.
from math import atan, pi, sin
from os import environ
from time import time

FLOOR = 0.5
kind = environ["KIND"]
lx, ly = (float(v) for v in environ["SIZE"].split())
skin, warm, steps = float(environ["SKIN"]), int(environ["WARM"]), int(environ["STEPS"])

grain = O.materials.append(ViscElMat(kn=2 * 1.3e7, ks=2 * 1.3e7, cn=2 * 829, cs=0, frictionAngle=atan(0.7), density=2700))
O.periodic = True
O.cell.setBox(lx, ly, 5)
O.bodies.append(wall(FLOOR, axis=2, sense=1, material=grain))

groups = {}
with open(environ["FILE"]) as lines:
    for number, line in enumerate(l for l in lines if not l.startswith("#")):
        words = line.split()
        x, y, z, radius = (float(w) for w in words[-4:])
        name = words[0] if kind == "clumps" else number
        groups.setdefault(name, []).append(sphere((x, y, z + FLOOR), radius, material=grain))
for pebbles in groups.values():
    if kind == "clumps":
        O.bodies.appendClumped(pebbles, discretization=0)
    else:
        O.bodies.append(pebbles)


def shake():
    motion.gravity = (0, 0, -9.81 * (1 + 0.3 * sin(40 * pi * O.time)))


O.dt = 1e-5
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=skin / 2, allowBiggerThanPeriod=True),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
        [Ip2_ViscElMat_ViscElMat_ViscElPhys()],
        [Law2_ScGeom_ViscElPhys_Basic()],
    ),
    PyRunner(command="shake()", iterPeriod=10),  # called less often: Python is not what is measured
    NewtonIntegrator(gravity=(0, 0, -9.81), damping=0, label="motion"),
]
O.run(max(warm, 1), True)
start = time()
O.run(steps, True)
print("Loop time of %.6f s for %d steps" % (time() - start, steps))
