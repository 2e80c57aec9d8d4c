"""`python -m fiberweb.tools.reproduce RUN [results]`: one run again, from its own file alone.

RUN is a run's name, its folder, or a file in it. The scene, the engine, the mesh and the step
stand in that file, and how it was scored in the capacity.nc beside it, if there is one. The run is
repeated in a temporary folder and compared value by value; nothing among the results is touched.
Ends with 0 if every value has the same bits, and with 1 if one has not; what could explain that,
another source of the engine or other versions, is printed first.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import xarray as xr
from threadpoolctl import threadpool_limits

from fiberweb.model.scene import Scene
from fiberweb.scoring.capacity import score
from fiberweb.simulation import dataset
from fiberweb.simulation.plan import plan
from fiberweb.simulation.simulate import run

MADE_BY = ("engine_source", "versions")
SCORED_BY = ("scoring_versions",)
SCORING = ("scoring", "alpha", "horizon", "split", "skip", "shuffle", "overshoot")
AUTHORS = "authors"  # what a file says of the mesh that the published setup fixes


def response_of(asked: str, results: str | Path = "results") -> Path:
    """The response.nc of a run by its name, its folder or the file itself.

    Raises:
        ValueError: there is none; one sentence.
    """
    given = Path(asked)
    named = Path(results, "runs", asked)
    places = [given.with_name("response.nc")] if given.is_file() else []
    places += [given / "response.nc", named / "response.nc"]
    for place in places:
        if place.is_file():
            return place
    raise ValueError(
        f"RUN = {asked!r} is no file, no folder with a response.nc and no run of {results}: give "
        "the path of a response.nc"
    )


def repeated(kept: xr.Dataset, path: Path) -> xr.Dataset:
    """The response that the attributes of another one ask for.

    Raises:
        ValueError: it is no simulation of this project, such as a recording; one sentence.
    """
    given = kept.attrs
    for key in ("scene", "engine", "time_step", "elements_per_section"):
        if key not in given:
            raise ValueError(f"{path} has no attribute {key!r}: it is no simulated response")
    elements = given["elements_per_section"]
    numerics = {"elements_per_section": None if elements == AUTHORS else int(elements)}
    numerics |= {"engine": given["engine"], "time_step": float(given["time_step"])}
    planned = plan(Scene.from_json(given["scene"]), force_time_step=True, **numerics)
    return run(planned)


def scored(response: xr.Dataset, kept: xr.Dataset) -> xr.Dataset:
    """The capacities that the attributes of others ask for."""
    given = {key: kept.attrs[key] for key in SCORING}
    given |= {"overshoot": tuple(map(float, given["overshoot"]))}
    given |= {"shuffle": bool(given["shuffle"]), "skip": int(given["skip"])}
    return score(response, orders=kept.sizes["order"], **given)


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
    print(f"{path}: {kept.attrs['engine']}, {kept.sizes['time']} frames")
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
            after = scored(again, before)
        _tell_makers(before, after, SCORED_BY)
        for name in ("c_nl", "c_m"):
            print(f"{name}: {float(before[name]):.10g}, again {float(after[name]):.10g}")
        same &= _told(scores.name, apart(before, after))
    return same


def _tell_makers(kept: xr.Dataset, again: xr.Dataset, keys: tuple[str, ...]) -> None:
    for key in keys:
        if (was := kept.attrs.get(key)) != (now := again.attrs[key]):
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
