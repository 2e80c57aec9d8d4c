"""What a table rests on, beside it as <table>-metadata.json, the place that CSV on the Web (W3C)
gives to what is known of a CSV file.

The runs and their scenes, with the seed; the source of the engine and the versions of what ran;
and the tables that it is made of. Nothing in it depends on the clock.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path

from fiberweb.simulation import dataset
from fiberweb.written import BESIDE

CONTEXT = "http://www.w3.org/ns/csvw"
PACKAGES = ("numpy", "scipy", "pandas", "xarray", "scikit-learn")

MEANINGS = {
    "@context": "of CSV on the Web (W3C)",
    "url": "name of the table",
    "notes[].recipe": "digest of the code, the options and all that the table is made of",
    "notes[].versions": "version of each package that made it",
    "notes[].engines": "the versions that each engine ran with, by the digest of its source",
    "notes[].made_of": "names of the tables that it is made of",
    "notes[].scene": "what the scenes of all runs have in common",
    "notes[].runs": "of each run, by name, what its scene has of its own",
}


def beside(table: str | Path) -> Path:
    """Where it is said what a table rests on."""
    return Path(f"{table}{BESIDE}")


def write(table: str | Path, made_of: Iterable[str | Path], recipe: str) -> None:
    """Say what a table rests on.

    Args:
        table: that was written.
        made_of: files that it is made of: responses and capacities, certificates, other tables.
        recipe: digest of the code, the options and all that they are made of.
    """
    runs, makers, tables = {}, {}, []
    for path in map(Path, made_of):
        if path.suffix == ".nc" and "run" in (found := dataset.attributes(path)):
            # JSON proper has no Infinity
            runs[found["run"]] = json.loads(found.get("scene", "{}"), parse_constant=str)
            makers.setdefault(found.get("engine_source"), found.get("versions"))
        elif path.suffix in (".csv", ".nc"):
            tables.append(path.name)
            earlier = _read(beside(path))
            shared = earlier.get("scene", {})
            runs |= {run: shared | own for run, own in earlier.get("runs", {}).items()}
            makers |= earlier.get("engines", {})
    scene, own = _shared(runs)
    note = {
        "recipe": recipe,
        "versions": {name: version(name) for name in PACKAGES},
        "engines": {source: versions for source, versions in makers.items() if source},
        "made_of": sorted(set(tables)),
        "scene": scene,
        "runs": own,
    }
    said = {"@context": CONTEXT, "url": Path(table).name, "notes": [note]}
    text = json.dumps(said, indent=1, sort_keys=True, allow_nan=False)
    partial = Path(f"{table}.partial")
    partial.write_text(text, encoding="utf-8")
    partial.replace(beside(table))  # a later table reads it: never a half


def _read(path: Path) -> dict:
    """What is said there, or nothing, of a table that is not ours."""
    return json.loads(path.read_text(encoding="utf-8"))["notes"][0] if path.is_file() else {}


def _shared(runs: dict[str, dict]) -> tuple[dict, dict]:
    """What all scenes have alike, and of each run the rest."""
    scenes = list(runs.values())
    alike = {
        key: value
        for key, value in (scenes[0] if scenes else {}).items()
        if all(key in scene and scene[key] == value for scene in scenes)
    }
    own = {
        run: {key: value for key, value in scene.items() if key not in alike}
        for run, scene in runs.items()
    }
    return alike, own
