"""Makes the recordings in takes/: no body was filmed, they are runs of the default engine.

    python examples/recordings/make.py

A 2x2 crosshatch of fibres 0.5 m long, driven at random at its corner, seen at six of its readouts
by a camera of 10 frames a second with 10 um of noise.
"""

from pathlib import Path

import numpy as np
import pandas as pd

from fiberweb import Scene, crosshatch, simulate

FOLDER = Path(__file__).parent / "takes"
READOUTS = (0, 1, 2, 3, 6, 9)  # the four crossings and two midpoints
NOISE = 1e-5  # m

for seed in (1, 2):
    # below buckling: past it runs are chaotic, and another machine's round-off makes others
    scene = Scene(crosshatch(2, length=0.5), force=0.05, duration=60.0, sample_rate=10.0, seed=seed)
    response = simulate(scene)
    table = {"time": response["time"].values, "input": response["input"].values}
    noise = np.random.default_rng(seed)
    for readout in READOUTS:
        moved = response.isel(readout=readout)
        for axis in "xy":
            where = moved["displacement"].sel(axis=axis).values + float(moved[f"rest_{axis}"])
            seen = 1e3 * (where + NOISE * noise.standard_normal(len(where)))
            table[f"m{readout}_{axis}"] = seen.round(3)
    frame = pd.DataFrame(table).round({"time": 1, "input": 6})
    frame.to_csv(FOLDER / f"take{seed}.csv", index=False, lineterminator="\n")
