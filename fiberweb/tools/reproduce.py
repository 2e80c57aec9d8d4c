"""`python -m fiberweb.tools.reproduce RUN [results]`: one run again, from its own file alone.

RUN is a run's name, its folder, or a file in it. The scene, the engine, the mesh and the step
stand in that file, and how it was scored in the capacity.nc beside it, if there is one. The run is
repeated in a temporary folder and compared value by value; nothing among the results is touched.
Ends with 0 if every value has the same bits, and with 1 if one has not; what could explain that,
another source of the engine or other versions, is printed first.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from os.path import isfile  # of a name that no disk takes as well
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import xarray as xr
from threadpoolctl import threadpool_limits

from fiberweb.errors import brief
from fiberweb.model.scene import Scene
from fiberweb.scoring.capacity import score
from fiberweb.simulation import dataset
from fiberweb.simulation.plan import plan
from fiberweb.simulation.simulate import run

MADE_BY = ("engine_source", "versions")
SCORED_BY = ("scoring_versions",)
AUTHORS = "authors"  # what a file says of the mesh that the published setup fixes
# what is read of a response and of its capacities, and how
SIMULATED = {
    "scene": Scene.from_json,
    "engine": str,
    "time_step": float,
    "elements_per_section": lambda given: None if str(given) == AUTHORS else int(given),
}
SCORED = {
    "scoring": str, "alpha": float, "horizon": float, "split": float, "skip": int, "shuffle": bool,
    "overshoot": lambda given: tuple(map(float, given)),
}  # fmt: skip


def response_of(asked: str, results: str | Path = "results") -> Path:
    """The response.nc of a run by its name, its folder or the file itself.

    Raises:
        ValueError: there is none; one sentence.
    """
    given = Path(asked)
    named = Path(results, "runs", asked)
    places = [given.with_name("response.nc")] if isfile(given) else []
    places += [given / "response.nc", named / "response.nc"]
    for place in places:
        if isfile(place):
            return place
    raise ValueError(
        f"RUN = {brief(asked)} is no file, no folder with a response.nc and no run of "
        f"{results}: give the path of a response.nc"
    )


def attributes(kept: xr.Dataset, path: Path, reads: Mapping[str, Callable]) -> dict:
    """Attributes of a file, each as its function reads it.

    Raises:
        ValueError: one is missing or damaged; one sentence.
    """
    read = {}
    for key, as_meant in reads.items():
        if key not in kept.attrs:
            raise ValueError(f"{path} has no attribute {key!r}: it is no file of a simulation")
        try:
            read[key] = as_meant(kept.attrs[key])
        except (KeyError, TypeError, AttributeError, ValueError, OverflowError) as error:
            raise ValueError(f"{path}: its attribute {key} cannot be read: {error}") from error
    return read


def repeated(kept: xr.Dataset, path: Path) -> xr.Dataset:
    """The response that the attributes of another one ask for.

    Raises:
        ValueError: it is no simulation of this project, such as a recording, or damaged; one
            sentence.
    """
    numerics = attributes(kept, path, SIMULATED)
    try:
        planned = plan(numerics.pop("scene"), force_time_step=True, **numerics)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error
    return run(planned)


def scored(response: xr.Dataset, kept: xr.Dataset, path: Path) -> xr.Dataset:
    """The capacities that the attributes of others ask for; errors as for `repeated`."""
    options = attributes(kept, path, SCORED)
    try:
        return score(response, orders=kept.sizes.get("order", 0), **options)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error


def apart(kept: xr.Dataset, again: xr.Dataset) -> list[str]:
    """What differs, a line a variable; empty if all bits agree."""
    lines = [f"{name}: only one of them has it" for name in set(kept.variables) ^ set(again)]
    lines = [line for line in lines if line.partition(":")[0] not in again.coords]
    for name in sorted(set(kept.variables) & set(again.variables)):
        one, other = kept[name].values, again[name].values
        if one.shape != other.shape:
            lines.append(f"{name}: shape {one.shape} and {other.shape}")
        elif one.dtype.kind not in "iuf":
            lines += [f"{name}: other names"] if list(one.ravel()) != list(other.ravel()) else []
        elif (differ := (one != other) & ~(np.isnan(one) & np.isnan(other))).any():
            most = np.nanmax(np.abs(one[differ] - other[differ]))
            share = np.mean(differ)
            lines.append(f"{name}: {share:.1%} of its values differ, by {most:.3g} at most")
    return lines


def reproduce(path: Path) -> bool:
    """Run and score again what a response.nc and the capacity.nc beside it hold, and print what
    agrees; whether all does."""
    kept = dataset.load(path)
    response = repeated(kept, path)
    print(f"{path}: {kept.attrs['engine']}, {kept.sizes.get('time', 0)} frames")
    _tell_makers(kept, response, MADE_BY)
    with TemporaryDirectory() as folder:
        # by way of a file, since a file rounds motions
        dataset.save(response, Path(folder, "response.nc"))
        again = dataset.load(Path(folder, "response.nc"))
    same = _told("response.nc", apart(kept, again))
    scores = path.with_name("capacity.nc")
    if scores.exists():
        before = dataset.load(scores)
        with threadpool_limits(1):  # as in the workflow: more would add in another order
            after = scored(again, before, scores)
        _tell_makers(before, after, SCORED_BY)
        for name in ("c_nl", "c_m"):
            if name in before:
                print(f"{name}: {float(before[name]):.10g}, again {float(after[name]):.10g}")
        same &= _told(scores.name, apart(before, after))
    return same


def _tell_makers(kept: xr.Dataset, again: xr.Dataset, keys: tuple[str, ...]) -> None:
    for key in keys:
        if (was := str(kept.attrs.get(key))) != (now := str(again.attrs[key])):
            print(f"{key} was {was}, and is {now} here: other digits are no surprise")


def _told(name: str, lines: list[str]) -> bool:
    print(f"{name}: {'differs' if lines else 'every value has the same bits'}")
    for line in lines:
        print(f"  {line}")
    return not lines


def main() -> None:
    """What is asked for on the command line."""
    asked = sys.argv[1:3]
    if not asked:
        sys.exit("RUN is missing: give a run's name, as in make reproduce RUN=name, or a path")
    try:
        same = reproduce(response_of(*asked))
    except ValueError as error:
        sys.exit(str(error))
    sys.exit(0 if same else 1)


if __name__ == "__main__":
    main()
