# %% [markdown]
# # A run in a notebook
#
# The cells read a directory that `trackbed run SCENE --out out` wrote. Jupyter (with Jupytext) and VS Code open this file
# as a notebook; `python examples/notebook/run.py out` runs it as a program.

# %%
import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("agg")  # pictures go to files; leave this line out in a notebook
import matplotlib.pyplot as plt
import pandas as pd
import polars as pl

OUT = Path(sys.argv[1] if len(sys.argv) == 2 else "out")

# %% [markdown]
# ## The histories, with pandas
#
# One row is one value. The file says its units and what made it: pandas has both in `attrs`.

# %%
histories = pd.read_parquet(OUT / "histories.parquet")
about = histories.attrs
units = about["units"]
print(f"{about['file']}, seed {about['seed']}, trackbed {about['version']}, scene {about['source_sha256'][:12]}")
for line in about["overrides"]:
    print(f"  with {line}")
for quantity, rows in histories.groupby("quantity"):
    print(f"  {quantity} [{units[quantity]}]: {len(rows)} values")

# %% [markdown]
# ## Settlement along the track

# %%
settlement = histories[histories["quantity"] == "settlement"]
along = settlement.pivot_table(index="x_m", columns="axles", values="value")
last = along.columns.max()
print(f"largest settlement after {last} axles: {along[last].max():.9g} {units['settlement']} at {along[last].idxmax():g} {units['x_m']}")

figure, axes = plt.subplots(layout="constrained")
for axles in along.columns[:: max(1, len(along.columns) // 5)].union([last]):
    axes.plot(along.index, along[axles] * 1e3, label=f"{axles} axles")
axes.set(xlabel=f"chainage [{units['x_m']}]", ylabel="settlement [mm]", title=about["file"])
axes.invert_yaxis()  # downward is positive
axes.legend()
figure.savefig(OUT / "settlement.png")

# %% [markdown]
# ## The same with polars
#
# polars gives the metadata apart from the table, as texts.

# %%
metadata = pl.read_parquet_metadata(OUT / "histories.parquet")
units = json.loads(metadata["trackbed.units"])
largest = (
    pl.scan_parquet(OUT / "histories.parquet")
    .filter(pl.col("time_s") > 0)
    .group_by("quantity")
    .agg(pl.col("value").max())
    .sort("quantity")
    .collect()
)
for quantity, value in largest.iter_rows():
    print(f"largest {quantity} of a passage: {value:.6g} {units[quantity]}")

# %% [markdown]
# ## Tables and summary
#
# Columns of a table end in their unit. Each number of `summary.json` has its unit beside it.

# %%
sleepers = pd.read_csv(OUT / "sleepers.csv")
summary = json.loads((OUT / "summary.json").read_text())
print(sleepers.groupby("axles")[["settlement_m", "void_m", "max_contact_force_N"]].max())
print(f"summary: max_settlement = {summary['max_settlement']['value']:.9g} {summary['max_settlement']['unit']}")
assert summary["provenance"]["source_sha256"] == metadata["trackbed.source_sha256"], "the files are of one run"
