"""`python -m fiberweb.tools.status [results]`: how far the workflow is that writes there; without a
folder, in results/ or one folder deeper, whichever was written to last."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import psutil

from fiberweb.progress import FAILED, FILE, clock

AGAIN = "`make resume` goes on from here."


def status(results: str | Path) -> str:
    """A line or two: how far a call is and when it will be finished, or how the last one ended.

    Raises:
        ValueError: no call has written there, or it is damaged; one sentence.
    """
    path = Path(results) / FILE
    try:
        return _told(json.loads(path.read_text(encoding="utf-8")))
    except FileNotFoundError:
        raise ValueError(f"{path} is not there: no workflow has begun to write to it") from None
    except OSError as error:
        raise ValueError(
            f"{path} cannot be read ({error.strerror}): name the folder of the results"
        ) from None
    except (KeyError, TypeError, AttributeError, ValueError, OverflowError) as error:
        raise ValueError(
            f"{path} is not as a call writes it ({type(error).__name__}: {error}): the next call "
            "writes it anew"
        ) from error


def _told(state: dict) -> str:
    if _alive(state):
        return f"{state['line']} (as of {clock(state['at'])})"
    command = " ".join(["snakemake", *state["command"][1:]])
    if state["ended"]:
        more = f"\n{AGAIN}" if state["ended"] == FAILED else ""
        return f"{state['ended']} at {clock(state['at'])}: {state['line']}\n{command}{more}"
    done = state["line"].split(", now ")[0]
    return f"nothing is running: killed after {clock(state['at'])}: {done}\n{command}\n{AGAIN}"


def _alive(state: dict) -> bool:
    """Whether the process is still there, and is no other one of the same number."""
    try:
        return not state["ended"] and psutil.Process(state["pid"]).create_time() <= state["begun"]
    except psutil.NoSuchProcess:
        return False


def latest(results: str | Path) -> Path:
    """That folder or one in it, such as results/smoke: where a call wrote last."""
    found = [*Path(results).glob(FILE), *Path(results).glob(f"*/{FILE}")]
    return max(found, key=lambda path: path.stat().st_mtime_ns).parent if found else Path(results)


def main() -> None:
    """Print it."""
    try:
        print(status(sys.argv[1] if len(sys.argv) > 1 else latest("results")))
    except ValueError as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
