"""`python -m fiberweb.tools.status [results]`: how far the workflow is that writes there."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import psutil

from fiberweb.progress import FILE, clock


def status(results: str | Path) -> str:
    """A line or two: how far a call is and when it will be finished, or how the last one ended.

    Raises:
        ValueError: no call has written there.
    """
    path = Path(results) / FILE
    try:
        state = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise ValueError(f"{path} is not there: no workflow has begun to write to it") from None
    if _alive(state):
        return f"{state['line']} (as of {clock(state['at'])})"
    command = " ".join(["snakemake", *state["command"][1:]])
    if state["ended"]:
        return f"{state['ended']} at {clock(state['at'])}: {state['line']}\n{command}"
    return (
        f"nothing is running; the last call was killed after {clock(state['at'])}: "
        f"{state['line'].split(', now ')[0]}. To go on: snakemake --unlock, then\n{command}"
    )


def _alive(state: dict) -> bool:
    """Whether the process is still there, and is no other one of the same number."""
    try:
        return not state["ended"] and psutil.Process(state["pid"]).create_time() <= state["begun"]
    except psutil.NoSuchProcess:
        return False


def main() -> None:
    """Print it."""
    try:
        print(status(sys.argv[1] if len(sys.argv) > 1 else "results"))
    except ValueError as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
