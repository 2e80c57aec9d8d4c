"""`python -m fiberweb.tools.crate [results]`: describe results as a Workflow Run RO-Crate.

The folder of the results becomes the crate: `source/` gets a copy of the workflow, and
`ro-crate-metadata.json` names every file with its size and SHA-256, what ran, when, with which
versions, and which tables and figures came out (https://w3id.org/ro/wfrun/workflow/0.5). What ran
is read from `provenance.json`. `make crate` installs the package rocrate, which this needs.
"""

from __future__ import annotations

import hashlib
import json
import shutil
import sys
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

from fiberweb.progress import FILE, FINISHED

ROOT = Path(__file__).parents[2]
SOURCE = "source"  # folder of the copy
WORKFLOW = f"{SOURCE}/Snakefile"
COPIED = (
    "Snakefile", "workflow", "fiberweb", "config", "envs", "profiles", "pyproject.toml", "LICENSE",
    "CITATION.cff", "codemeta.json",
)  # fmt: skip
WORKFLOW_CRATE = "https://w3id.org/workflowhub/workflow-ro-crate/1.0"
PROFILES = {
    "https://w3id.org/ro/wfrun/process/0.5": ("Process Run Crate", "0.5"),
    "https://w3id.org/ro/wfrun/workflow/0.5": ("Workflow Run Crate", "0.5"),
    WORKFLOW_CRATE: ("Workflow RO-Crate", "1.0"),
}
MADE = ("figures", "tables", "recordings")  # folders of what the run was for
FORMATS = {
    ".csv": "text/csv", ".gif": "image/gif", ".html": "text/html", ".json": "application/json",
    ".nc": "application/x-netcdf", ".pdf": "application/pdf", ".png": "image/png",
    ".zip": "application/zip",
}  # fmt: skip
MIT = "https://spdx.org/licenses/MIT"


def describe(results: str | Path) -> Path:
    """Make a folder of results a crate, and return the path of its metadata.

    Raises:
        ValueError: the workflow never ran there; one sentence.
    """
    from rocrate.rocrate import ROCrate

    results = Path(results)
    record = results / "provenance.json"
    if not record.is_file():
        raise ValueError(
            f"results = {str(results)!r} has no provenance.json: run the workflow first"
        )
    calls = json.loads(record.read_text(encoding="utf-8"))
    metadata = results / "ro-crate-metadata.json"
    metadata.unlink(missing_ok=True)
    _copy_source(results / SOURCE)

    crate = ROCrate(version="1.1")
    crate.metadata.extra_contexts.append(
        {"sha256": "https://w3id.org/ro/terms/workflow-run#sha256"}
    )
    files = {path: _add_file(crate, results, path) for path in sorted(_files(results))}
    workflow = _add_workflow(crate, calls)
    made = [entity for path, entity in files.items() if path.relative_to(results).parts[0] in MADE]
    last = max(path.stat().st_mtime for path in files)
    done = json.loads((results / FILE).read_text(encoding="utf-8"))["ended"] == FINISHED
    _add_run(crate, calls, workflow, made, last, done)
    root = crate.root_dataset
    root["conformsTo"] = [
        crate.add_jsonld({"@id": at, "@type": "CreativeWork", "name": name, "version": version})
        for at, (name, version) in PROFILES.items()
    ]
    root["name"] = "Results of fiberweb-reservoirs"
    root["description"] = (
        "Simulations, capacities, tables and figures of fibre networks as physical reservoirs, "
        "with the workflow that made them"
    )
    root["datePublished"] = _time(last)
    root["license"] = crate.add_jsonld({"@id": MIT, "@type": "CreativeWork", "name": "MIT License"})
    authors = {"@id": "#authors", "@type": "Organization", "name": "The fiberweb authors"}
    root["author"] = root["publisher"] = crate.add_jsonld(authors)
    crate.metadata.append_to("conformsTo", {"@id": WORKFLOW_CRATE})
    # not crate.write, which would copy every file
    text = json.dumps(crate.metadata.generate(), indent=1)
    metadata.write_text(text, encoding="utf-8")
    return metadata


def _copy_source(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    left = shutil.ignore_patterns("__pycache__", "*.pyc", ".*")
    for name in COPIED:
        place = ROOT / name
        if place.is_dir():
            shutil.copytree(place, folder / name, ignore=left)
        elif place.is_file():
            shutil.copy2(place, folder / name)


def _files(results: Path) -> Iterator[Path]:
    """All but what is hidden, such as a file that a job is writing."""
    for path in results.rglob("*"):
        hidden = any(part.startswith(".") for part in path.relative_to(results).parts)
        if path.is_file() and not hidden:
            yield path


def _add_file(crate, results: Path, path: Path):
    """The entity of a file, with its size and what its content is known by."""
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    said = {
        "name": path.name,
        "contentSize": str(path.stat().st_size),
        "encodingFormat": FORMATS.get(path.suffix, "text/plain"),
        "sha256": digest,
    }
    name = path.relative_to(results).as_posix()
    if name == WORKFLOW:
        said["@type"] = ["File", "SoftwareSourceCode", "ComputationalWorkflow"]
    return crate.add_file(path, name, properties=said)


def _add_workflow(crate, calls: list[dict]):
    """The Snakefile as the main entity, with the language and packages that it ran by."""
    workflow = crate.get(WORKFLOW)
    language = crate.add_jsonld({
        "@id": "https://w3id.org/workflowhub/workflow-ro-crate#snakemake",
        "@type": "ComputerLanguage",
        "name": "Snakemake",
        "identifier": {"@id": "https://doi.org/10.1093/bioinformatics/bts480"},
        "url": {"@id": "https://snakemake.readthedocs.io"},
        "version": calls[-1]["versions"]["snakemake"],
    })  # fmt: skip
    needed = [
        crate.add_jsonld({
            "@id": f"https://pypi.org/project/{name}/{version}/",
            "@type": "SoftwareApplication",
            "name": name,
            "softwareVersion": version,
            "url": {"@id": f"https://pypi.org/project/{name}/"},
        })
        for name, version in calls[-1]["versions"].items()
        if version
    ]  # fmt: skip
    workflow["name"] = "fiberweb-reservoirs"
    workflow["programmingLanguage"] = language
    workflow["softwareRequirements"] = needed
    workflow["conformsTo"] = {
        "@id": "https://bioschemas.org/profiles/ComputationalWorkflow/1.0-RELEASE"
    }
    workflow["version"] = calls[-1]["commit"] or "unknown"
    crate.root_dataset["mainEntity"] = workflow
    return workflow


def _add_run(crate, calls: list[dict], workflow, made: list, end: float, done: bool) -> None:
    """What was done: from the first call to the last file, and whether the last call came to its
    end."""
    # of the configs laid over the project's own, provenance.json has the text
    given = (f"{SOURCE}/config", "provenance.json")
    configs = [entity for entity in crate.data_entities if entity.id.startswith(given)]
    commands = ", then ".join(dict.fromkeys(call.get("command", "unknown") for call in calls))
    agent = crate.add_jsonld({
        "@id": "#operator", "@type": "Person", "name": "whoever ran the workflow"
    })  # fmt: skip
    action = crate.add_jsonld({
        "@id": "#run",
        "@type": "CreateAction",
        "name": "Run of the workflow",
        "description": f"{commands}; Python {calls[-1]['python']} on {calls[-1]['machine']}",
        "startTime": calls[0].get("started"),
        "endTime": _time(end),
        "actionStatus": f"http://schema.org/{'Completed' if done else 'Failed'}ActionStatus",
    })  # fmt: skip
    action["agent"], action["instrument"] = agent, workflow
    action["object"], action["result"] = configs, made
    crate.root_dataset["mentions"] = action


def _time(seconds: float) -> str:
    return datetime.fromtimestamp(seconds, UTC).isoformat(timespec="seconds")


def main() -> None:
    """Describe the results named on the command line."""
    try:
        print(f"{describe(sys.argv[1] if len(sys.argv) > 1 else 'results')}: written")
    except ValueError as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
