"""The example computations of Fig. 1d."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from fiberweb.meanings import explained
from fiberweb.scoring.capacity import TRACES, traces
from fiberweb.simulation import dataset
from fiberweb.simulation.response import ATTRIBUTES


@explained(TRACES, attributes=ATTRIBUTES)
def example_traces(response_path: str | Path, **scoring) -> xr.Dataset:
    """Targets and their estimates over time, of one run.

    `fiberweb.scoring.capacity.traces`; without variables if the run is unstable, because such a run
    estimates nothing.
    """
    response = dataset.load(response_path)
    return traces(response, **scoring) if response.attrs["status"] == "ok" else response[[]]
