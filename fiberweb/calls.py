"""Calls of the workflow in a folder: which of them did not come to their end, and who is at work.

Snakemake locks a folder with files, which stay when it is killed. Here everybody at work, Snakemake
and each of its jobs, holds a lock of the system instead, which is gone with its holder however that
ends. Both lie in `.snakemake/`, as all that Snakemake knows of a folder.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import platform
import shlex
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

FOLDER = Path(".snakemake", "fiberweb")  # of the folder that Snakemake works in
SNAKEMAKES = Path(".snakemake", "locks")
KINDS = {"arguments": list, "from": str, "process": int, "host": str}  # what a note holds
_held = []  # locks, until this process ends


def begin(arguments: Sequence[str], directory: str | Path | None = None) -> Path:
    """Note a call of Snakemake that starts; the note, to be removed when all of it is done.

    Args:
        arguments: of the call.
        directory: what Snakemake took as `--directory`, which profiles may name as well.
    """
    join()
    name = hashlib.sha256(repr([*arguments]).encode()).hexdigest()[:16]
    call = {
        "arguments": [*arguments],
        # it leads elsewhere, and the files that the call names are seen from here
        "from": os.getcwd() if directory is None else os.environ.get("PWD", os.getcwd()),
        "process": os.getpid(),
        "host": platform.node(),
    }
    note = FOLDER / f"{name}.json"
    note.write_text(json.dumps(call), encoding="utf-8")
    return note


def unfinished() -> tuple[Path, dict] | None:
    """The note of the last call that did not come to its end, and what it says; None without."""
    notes = _notes()
    return max(notes, key=lambda each: each[0].stat().st_mtime_ns) if notes else None


def join() -> None:
    """Hold the lock of those at work in this folder until this process ends."""
    try:
        FOLDER.mkdir(parents=True, exist_ok=True)
        file = (FOLDER / "lock").open("a")
        _held.append(file)
        fcntl.flock(file, fcntl.LOCK_SH)
    except OSError:  # a disk without locks, or one that is full
        return


def at_work(call: dict) -> str | None:
    """A sentence on those at work in this folder, and on what to do; None if there are none.

    Args:
        call: the one that is to be resumed.
    """
    here = os.getcwd()
    by_hand = "if nobody is, give `snakemake --unlock` and then the same command as before"
    if SNAKEMAKES.is_dir() and call["host"] != platform.node():  # not every disk's locks go so far
        return (
            f"{here} was locked by a call on {call['host']}, and whether that is still at work can "
            f"only be told there: {by_hand}"
        )
    if queued := _queued(call, here):
        return (
            f"SLURM still has jobs of a call in {here}: wait for their end, or "
            f"`scancel {' '.join(queued)}`, before it is resumed"
        )
    with (FOLDER / "lock").open("a") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return None
        except BlockingIOError:
            holders = _holders(FOLDER / "lock")
        except OSError as error:
            return f"who is at work in {here} cannot be told ({error.strerror}): {by_hand}"
    for _, other in _notes():
        if other["process"] in holders:
            return (
                f"`{shlex.join(['snakemake', *other['arguments']])}` is at work in {here} (process "
                f"{other['process']}): wait for its end, or stop it by Ctrl-C, before it is resumed"
            )
    whose = f"processes {', '.join(map(str, holders))}" if holders else "of another user or machine"
    return (
        f"jobs are still at work in {here} ({whose}), though the call that started them was "
        "killed: wait for their end, or kill them, before it is resumed"
    )


def _notes() -> list[tuple[Path, dict]]:
    found = []
    for note in FOLDER.glob("*.json"):
        try:
            found.append((note, _read(note)))
        except ValueError:  # cut short, as by a full disk, or written by something else
            note.unlink()
    return found


def _read(note: Path) -> dict:
    """What a note says; ValueError if `begin` does not write such."""
    call = json.loads(note.read_text(encoding="utf-8"))
    if not isinstance(call, dict) or {key: type(call.get(key)) for key in KINDS} != KINDS:
        raise ValueError(f"{note} is no note of a call")
    return call | {"arguments": [*map(str, call["arguments"])]}


def _queued(call: dict, folder: str) -> list[str]:
    """Numbers of the jobs that SLURM has of a folder, of a call through it; one that waits holds no
    lock, and whether one that runs does, hangs on the disk."""
    if "slurm" not in " ".join(call["arguments"]) or not shutil.which("squeue"):
        return []
    asked = ["squeue", "--me", "--noheader", "--format=%i %Z"]
    lines = subprocess.run(asked, capture_output=True, text=True).stdout.splitlines()
    return [
        number for number, _, where in (line.partition(" ") for line in lines) if where == folder
    ]


def _holders(path: Path) -> list[int]:
    """Processes that have a file open."""
    import psutil

    wanted, found = str(path.absolute()), []
    for process in psutil.process_iter():
        try:
            if any(file.path == wanted for file in process.open_files()):
                found.append(process.pid)
        except psutil.Error:  # it has ended, or is somebody else's
            continue
    return [pid for pid in found if pid != os.getpid()]
