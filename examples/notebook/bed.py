# %% [markdown]
# # A bed of grains in a notebook
#
# The cells read the grains and contacts that `trackbed pack SCENE --out bed`, a test rig, or a run with a record of
# `states = vtk` wrote. `python examples/notebook/bed.py bed/bodies.vtp bed/contacts.vtp bed.png` runs this file as a
# program, without its last argument it draws nothing.

# %%
import sys
from pathlib import Path

import numpy as np
import pyvista as pv

GIVEN = [Path(name) for name in sys.argv[1:] if name.endswith((".vtp", ".png"))]
GRAINS, CONTACTS = GIVEN[:2] or [Path("bed/bodies.vtp"), Path("bed/contacts.vtp")]
PICTURE = next(iter(GIVEN[2:]), None)

# %% [markdown]
# ## Grains
#
# A point is a pebble; a grain is one pebble or several of the same `body`. Numbers are SI.

# %%
pebbles = pv.read(GRAINS)
radius, body = pebbles["radius"], pebbles["body"]
x0, x1, y0, y1, z0, z1 = pebbles.bounds
print(f"{len(np.unique(body))} grains of {pebbles.n_points} pebbles, {1e3 * radius.min():.3g} to {1e3 * radius.max():.3g} mm in radius")
print(f"centres fill {x1 - x0:.3g} m x {y1 - y0:.3g} m x {z1 - z0:.3g} m")
_, first = np.unique(body, return_index=True)
print(f"neighbours of a grain: {pebbles['coordination'][first].mean():.2f} in the mean")

# %% [markdown]
# ## Contacts
#
# A line is a contact, from one middle to the other.

# %%
contacts = pv.read(CONTACTS)
force = contacts["force"]
carrying = np.sort(force)[::-1].cumsum() / force.sum()
print(f"{contacts.n_cells} contacts, {force.mean():.3g} N in the mean, {force.max():.3g} N at most")
print(f"half of the force is in {np.searchsorted(carrying, 0.5) / len(force):.0%} of the contacts")

# %% [markdown]
# ## A picture
#
# Grains in their true size, the strong contacts as tubes. VTK needs OpenGL, but no display; in a notebook write
# `plotter.show()` in the place of `plotter.screenshot(PICTURE)`.

# %%
if PICTURE:
    strong = contacts.extract_cells(force > force.mean()).extract_surface(algorithm="dataset_surface")
    plotter = pv.Plotter(off_screen=True, window_size=(900, 600))
    spheres = pebbles.glyph(geom=pv.Sphere(radius=1.0), scale="radius", orient=False)
    plotter.add_mesh(spheres, color="tan", opacity=0.3)
    plotter.add_mesh(strong.tube(radius=0.1 * radius.mean()), scalars="force", scalar_bar_args={"title": "contact force [N]"})
    plotter.camera_position = "xz"
    plotter.screenshot(PICTURE)
    print(f"drawn into {PICTURE.name}")
