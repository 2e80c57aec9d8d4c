"""The example computations of Fig. 1d."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from fiberweb.scoring.capacity import traces
from fiberweb.simulation import dataset


def example_traces(response_path: str | Path, **scoring) -> xr.Dataset:
    """Targets and their estimates over the test part of one run, by
    `fiberweb.scoring.capacity.traces`; without variables if it is unstable, because such a run
    estimates nothing."""
    response = dataset.load(response_path)
    return traces(response, **scoring) if response.attrs["status"] == "ok" else response[[]]
