"""What made the results: the commit and the versions of each call of the workflow."""

from __future__ import annotations

import json
import os
import platform
import shlex
import subprocess
import sys
from collections.abc import Iterable
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from fiberweb.files import CALLS
from fiberweb.pages import of_calls
from fiberweb.source import source_hash

PACKAGES = ("snakemake", "numpy", "scipy", "numba", "pyelastica", "xarray", "pandas", "matplotlib")

MEANINGS = {
    "[].started": "when the call started, UTC",
    "[].command": "the call, as it was typed",
    "[].config": "text of each config file that it laid over config/config.yaml, by path",
    "[].commit": "of the code; null where there is no repository",
    "[].uncommitted_changes": "whether the code differed from that commit",
    "[].engine_source": "digest of all code that the motion depends on",
    "[].python": "version of Python",
    "[].machine": "operating system and processor",
    "[].versions": "version of each package",
}


def add_call(results: str | Path, laid: Iterable[str | Path] = ()) -> None:
    """Add one call to <results>/provenance.json, and show all on a page of the report.

    Args:
        results: folder of all results.
        laid: config files that the call lays over config/config.yaml; their text is kept.
    """
    path = Path(results) / "provenance.json"
    changes = _git("status", "--porcelain")
    call = {
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        "command": _letters(shlex.join(["snakemake", *sys.argv[1:]])),
        "config": {
            _letters(str(path)): Path(path).read_text(encoding="utf-8-sig") for path in laid
        },
        "commit": _git("rev-parse", "HEAD"),
        "uncommitted_changes": None if changes is None else bool(changes),
        "engine_source": source_hash(),
        "python": platform.python_version(),
        "machine": platform.platform(),
        "versions": {package: _installed(package) for package in PACKAGES},
    }
    calls = [*_earlier(path), call]
    _write(path, json.dumps(calls, indent=2))
    _write(Path(results, CALLS), of_calls(calls))


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_suffix(".partial")
    partial.write_text(text, encoding="utf-8")
    partial.replace(path)


def _earlier(path: Path) -> list[dict]:
    """The calls so far; a file that is broken is set aside."""
    try:
        calls = json.loads(path.read_text(encoding="utf-8"))
        if not isinstance(calls, list) or not all(isinstance(call, dict) for call in calls):
            raise ValueError(f"{path} is no list of calls")
        return calls
    except FileNotFoundError:
        return []
    except ValueError:
        aside = path.replace(path.with_suffix(".broken"))
        print(f"{path} is broken: it is now {aside}, and a new one begins.", file=sys.stderr)
        return []


def _letters(given: str) -> str:
    """What was typed; where the locale knows ASCII alone, Python has other letters as bytes."""
    return os.fsencode(given).decode("utf-8", errors="replace")


def _git(*arguments: str) -> str | None:
    """Output of git where this code is; None where there is no repository or no git."""
    command = ["git", "-C", str(Path(__file__).parent), *arguments]
    try:
        called = subprocess.run(command, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return called.stdout.strip()


def _installed(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None
