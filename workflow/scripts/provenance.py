"""One call of the workflow, added to <results>/benchmarks/provenance.json: commit, versions."""

import json
import platform
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

PACKAGES = ("snakemake", "numpy", "scipy", "numba", "pyelastica", "xarray", "pandas", "matplotlib")


def git(*arguments):
    """Output of git, or None where there is no repository or no git."""
    try:
        called = subprocess.run(["git", *arguments], capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return called.stdout.strip()


def installed(package):
    try:
        return version(package)
    except PackageNotFoundError:
        return None


path = Path(sys.argv[1]) / "benchmarks" / "provenance.json"
calls = json.loads(path.read_text()) if path.exists() else []
changes = git("status", "--porcelain")
calls.append({
    "commit": git("rev-parse", "HEAD"),
    "uncommitted_changes": None if changes is None else bool(changes),
    "python": platform.python_version(), "machine": platform.platform(),
    "versions": {package: installed(package) for package in PACKAGES},
})  # fmt: skip
path.parent.mkdir(parents=True, exist_ok=True)
path.write_text(json.dumps(calls, indent=2))
