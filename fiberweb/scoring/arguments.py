"""What `score` and `baselines` are given, checked where they begin."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING

from fiberweb.arguments import check_names, shown, whole
from fiberweb.model.readouts import AXES
from fiberweb.model.scene import SETUPS, Scene
from fiberweb.scoring.regression import Options

if TYPE_CHECKING:
    import xarray as xr

INPUT, DISPLACEMENT = {"input": ("time",)}, {"displacement": ("time", "readout", "axis")}
ORIGINS = (*SETUPS, "recording")
ATTRIBUTES = {
    "status": "'ok' or 'unstable'",
    "setup": f"one of {', '.join(map(repr, ORIGINS))}",
}


def check(response, scoring: str | None, options: dict) -> None:
    """Raise ValueError, one sentence, unless this can be scored; see `capacity.score`."""
    check_input(response, scoring, options)
    _check_variables(response, DISPLACEMENT)
    axes = response["axis"].values.tolist() if "axis" in response.coords else []
    if sorted(map(str, axes)) != sorted(AXES):
        raise ValueError(
            f"response has displacement along axis = {axes}; give both of {list(AXES)}"
        )
    _check_attributes(response, ("status",))
    if (status := response.attrs["status"]) not in ("ok", "unstable"):
        raise ValueError(f"response has status = {shown(status)}; set it to {ATTRIBUTES['status']}")


def check_input(response, scoring: str | None, options: dict) -> None:
    """Raise ValueError, one sentence, unless this has an input to score; see `tables.baselines`."""
    check_names(options, [each.name for each in fields(Options)] + ["orders"])
    _check_kind(response)
    _check_variables(response, INPUT)
    # its setup says how a response is scored, unless the caller does
    _check_attributes(response, () if scoring else ("setup",))
    if not scoring and (setup := response.attrs["setup"]) not in ORIGINS:
        raise ValueError(f"response has setup = {shown(setup)}; set it to {ATTRIBUTES['setup']}")


def check_orders(orders) -> int:
    """The highest Legendre order as Python's own number; ValueError if it is none."""
    return whole("orders", orders, 1, " holds no Legendre polynomial; give a whole number from 1")


def _check_variables(response: xr.Dataset, variables: dict[str, tuple[str, ...]]) -> None:
    for name, dimensions in variables.items():
        if name not in response:
            raise ValueError(
                f"response has no variable {name!r}; give what simulate returns, with "
                f"{name}({', '.join(dimensions)})"
            )
        found = response[name].dims
        if sorted(map(str, found)) != sorted(dimensions):
            raise ValueError(
                f"response has {name}({', '.join(map(str, found))}); give "
                f"{name}({', '.join(dimensions)})"
            )


def _check_attributes(response: xr.Dataset, names: tuple[str, ...]) -> None:
    for name in names:
        if name not in response.attrs:
            raise ValueError(f"response has no attribute {name!r}; set it to {ATTRIBUTES[name]}")


def _check_kind(response: xr.Dataset) -> None:
    import xarray as xr  # slow to import

    if isinstance(response, xr.Dataset):
        return
    right = "give the Dataset that simulate returns"
    if isinstance(response, (str, Path)):
        right = f"give the Dataset in it, xarray.load_dataset({str(response)!r})"
    elif isinstance(response, Scene):
        right = "give what simulate returns for it"
    raise ValueError(f"response = {shown(response)} is not a response; {right}")
