"""The recordings that a config lists: files, or folders of them, each with how it is read and
scored."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Annotated, NamedTuple

from pydantic import BeforeValidator

from fiberweb.errors import Named
from fiberweb.folders import folder
from fiberweb.recordings import READERS
from fiberweb.recordings.options import Reading
from fiberweb.scoring.card_options import CardOptions
from fiberweb.sections import Section, key

SUFFIXES = {suffix for reader in READERS.values() for suffix in reader.suffixes}
LONGEST = 240  # bytes of a name; file systems have 255, and a log adds some
Place = Annotated[str, BeforeValidator(lambda value: folder(value, "recordings.path"))]


class RecordingSection(Section):
    """One recording, or a folder of recordings that are read and scored alike."""

    path: Place = key(..., "file, or folder of files", min_length=1)
    name: str | None = key(None, "of its folder among the results; null takes the file's")
    read: Reading = Reading()
    card: CardOptions = CardOptions()


class Recorded(NamedTuple):
    """One file of the list, and the options that were given for it."""

    path: Path
    read: dict
    card: dict


def recorded(sections: Iterable[RecordingSection]) -> dict[str, Recorded]:
    """Every listed recording by its name; a file that is not there is among them, and is refused
    when it is read, so that the others are not held up.

    Raises:
        ValueError: two have one name, one is too long, or a folder has no recording; one sentence.
    """
    found: dict[str, Recorded] = Named("recording")
    for section in sections:
        read, card = (part.model_dump(exclude_unset=True) for part in (section.read, section.card))
        for name, path in _files(section):
            if len(name.encode()) > LONGEST:
                raise ValueError(
                    f"recordings: {name[:100]!r}... is longer than the name of a folder can be: "
                    "give that recording a name of its own"
                )
            if name in found:
                raise ValueError(
                    f"recordings: {found[name].path} and {path} are both called {name!r}: give one "
                    "of them a name"
                )
            found[name] = Recorded(path, read, card)
    return found


def findings(sanity: Mapping[str, str | Path]) -> Iterator[str]:
    """What is not in order with recordings, a line each; their logs have all that was looked at.

    Args:
        sanity: the table of what was found in each recording, by its name.
    """
    for name, path in sorted(sanity.items()):
        with open(path, encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                if row["severity"] != "ok":
                    yield f"{name}: {row['severity']}: {row['sentence']}"


def _files(section: RecordingSection) -> Iterator[tuple[str, Path]]:
    path = Path(section.path)
    if not path.is_dir():
        yield _plain(section.name or path.stem), path
        return
    files = sorted(file for file in path.iterdir() if file.suffix.lower() in SUFFIXES)
    if not files:
        raise ValueError(
            f"recordings: {path} holds no recording: {', '.join(sorted(SUFFIXES))} are read"
        )
    stems = Counter(file.stem for file in files)
    for file in files:
        name = file.stem if stems[file.stem] == 1 else file.name
        yield _plain(f"{section.name}-{name}" if section.name else name), file


def _plain(name: str) -> str:
    """A name that a folder and Snakemake's patterns can have, and that leads to no other folder, as
    `..` would."""
    return re.sub(r"[^\w.-]+|^\.+", "-", name)
