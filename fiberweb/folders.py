"""Names of folders as people write them in a config."""

from __future__ import annotations

import os
from datetime import date
from glob import glob
from pathlib import Path

from fiberweb.errors import brief

# where disks appear once they are mounted, each in a folder of its own or of its user's
MOUNTS = (Path("/mnt"), Path("/media"), Path("/run/media"), Path("/Volumes"))
TABLE_OF_DISKS = Path("/etc/fstab")
MARKS = "{}<>*?[]"  # patterns to Snakemake
LONGEST = 1000  # characters; no file system takes much more


def folder(value: object, key: str) -> object:
    """A folder's name in the one form that names it: without ~, variables, ./, // and / at the end.

    Raises:
        ValueError: it is no text, is too long, or has characters that mean something else or cannot
            be printed; one sentence.
    """
    if value is None or value == "":
        return value
    if isinstance(value, (bool, int, float, date)):  # not as it was written: 1e3 came as 1000.0
        raise ValueError(
            f"{key} = {value!s}: that was read as a {type(value).__name__} and not as a name: "
            "write ./ before the name"
        )
    if not isinstance(value, (str, Path)):
        return value
    if len(str(value)) > LONGEST or not str(value).isprintable():
        raise ValueError(
            f"{key} = {brief(str(value))}: a name has at most {LONGEST} characters, all of which "
            "can be printed"
        )
    text = os.path.normpath(os.path.expanduser(os.path.expandvars(value)))
    if found := [mark for mark in MARKS if mark in text]:
        raise ValueError(
            f"{key} = {value!r}: {found[0]!r} stands for something else where files are named: "
            "take a folder without it"
        )
    if text.startswith("~") or "$" in text:
        raise ValueError(
            f"{key} = {value!r}: there is no such home folder or variable: spell it out"
        )
    if text == os.path.dirname(text):
        raise ValueError(f"{key} = {value!r}: that is the whole disk: name a folder on it")
    return os.getcwd() if text == "." else text


def tables_in(place: str | None) -> list[str]:
    """The CSV files of a folder, if one is given."""
    return sorted(glob(f"{place}/*.csv")) if place else []


def missing_disk(path: Path) -> Path | None:
    """The place of the disk that a path is on, if it is not mounted: a folder made there would lie
    on another disk, and hide beneath this one later."""
    path = path.absolute()
    for mounts in MOUNTS:
        if path != mounts and path.is_relative_to(mounts):
            first, *others = path.relative_to(mounts).parts
            of_user = others[:1] if first == os.environ.get("USER") else []
            disk = mounts.joinpath(first, *of_user)
            if not disk.exists():
                return disk
    listed = (mount for mount in _listed_mounts() if path.is_relative_to(mount))
    return next((mount for mount in listed if not os.path.ismount(mount)), None)


def _listed_mounts() -> list[Path]:
    try:
        lines = TABLE_OF_DISKS.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return []
    fields = [line.split() for line in lines if not line.startswith("#")]
    return [Path(of[1].replace("\\040", " ")) for of in fields if len(of) > 1 and of[1] != "none"]
