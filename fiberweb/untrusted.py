"""Configs looked at as data before anything reads them: their size, depth, aliases, tags and keys.

Snakemake reads the files of ``--configfile`` before it comes to the Snakefile: it follows every
alias, and runs Python that stands in a file with the key ``__use_yte__``. So
`profiles/default/config.yaml` calls `guard` first, by the path of this file, which imports nothing
of the project for that reason.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import re
import sys
from pathlib import Path

MOST_BYTES = 256 * 1024  # of a file; config.yaml has 8 kB
MOST_VALUES = 10_000  # keys, values and groups of a file, each alias counted as what it stands for
DEEPEST = 20  # groups and lists within one another
IN_DECIMALS = "write it in decimals or, if it is a text, in quotes"
PYTHON = "__use_yte__"  # has Snakemake run what stands in a file


def guard() -> None:
    """End the program with one sentence if what this call of Snakemake names as config is
    refused."""
    try:
        given = called()
        for path in given.configfile or ():
            if not isinstance(values(path), dict):
                raise ValueError(f"{_printable(path)} holds no keys: a config is a group of keys")
        for entry in given.config or ():
            check_entry(entry)
    except ValueError as error:
        sys.exit(str(error))


def called() -> argparse.Namespace:
    """What Snakemake, within which this runs, has read of its command line: ``configfile``, paths,
    ``config``, entries, and the rest.

    Its own parser alone knows options that are abbreviated or written in one (``-nC``), and takes
    .3 s to be made once more; so what it gave is looked for in the frames of Snakemake's functions.

    Raises:
        LookupError: there is none, as where Snakemake is used as a library.
    """
    frame = sys._getframe()
    while frame:
        found = frame.f_locals.get("args")
        if isinstance(found, argparse.Namespace) and hasattr(found, "configfile"):
            return found
        frame = frame.f_back
    raise LookupError("no call of Snakemake's command line is at work")


def values(path: str | Path) -> object:
    """What a YAML or JSON file holds.

    Raises:
        ValueError: one sentence, if it is neither, gives a key twice, or is beyond the limits.
    """
    import yaml

    text, path = _text(Path(path)), _printable(path)
    check(text, path)
    try:
        return json.loads(text)
    except ValueError:
        pass  # Snakemake, too, takes what is no JSON for YAML
    try:
        return yaml.load(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    except (yaml.YAMLError, ValueError, OverflowError) as error:
        raise ValueError(_no_yaml(path, error)) from None


def check_entry(entry: str) -> None:
    """Raise ValueError, one sentence, if an entry of ``--config`` is beyond the limits or gives a
    key twice."""
    import yaml

    name, _, text = entry.partition("=")
    with contextlib.suppress(yaml.YAMLError):  # what is none is text to Snakemake, too
        _Look("--config", (name,)).through(text)


def other_base(text: str) -> str | None:
    """How YAML takes a bare text for a number that is not in decimals, if it does: 1:30 for 90, 010
    for 8. Whoever writes these means something else, and long ones take YAML seconds."""
    if re.fullmatch(r"[-+]?[0-9][0-9_]*(:[0-5]?[0-9])+(\.[0-9_]*)?", text):
        return "to the base of 60"
    bases = {"0x": "as hexadecimal", "0b": "as binary"}
    if re.fullmatch(r"[-+]?0(x[0-9a-fA-F_]+|b[01_]+|[0-7_]+)", text):
        return bases.get(text.lstrip("+-")[:2], "as octal")
    return None


def check(text: str, name: str | Path) -> None:
    """Raise ValueError, one sentence, if a text gives a key twice, of which YAML would keep the
    last one, is beyond the limits, or is no YAML.

    It is read as a stream by the parser that Snakemake uses, so that nothing is built of it.
    """
    import yaml

    try:
        _Look(name).through(_untabbed(text))
    except yaml.YAMLError as error:
        raise ValueError(_no_yaml(name, error)) from None


class _Group:
    """A mapping or a list that is being read."""

    def __init__(self, anchor: str | None, is_mapping: bool):
        self.anchor, self.is_mapping, self.at_key = anchor, is_mapping, is_mapping
        self.values, self.height = 1, 1  # of all that is in it
        self.lines: dict[str, int] = {}  # that its keys stand in
        self.key: str | None = None  # the last one

    def add(self, values: int, height: int, key: str | None) -> None:
        """Count what is within: a key, a value or an item."""
        self.values += values
        self.height = max(self.height, 1 + height)
        if self.at_key:
            self.key = key
        self.at_key = self.is_mapping and not self.at_key


class _Look:
    """A text read from its first event to its last; `name` is what holds it, `above` the keys that
    its own are within."""

    def __init__(self, name: str | Path, above: tuple[str, ...] = ()):
        self._name, self._above = name, above
        self._groups: list[_Group] = []
        self._anchored: dict[str, tuple[int, int]] = {}  # values and height
        self._total, self._line = 0, 0

    def through(self, text: str) -> None:
        import yaml

        for event in yaml.parse(text, Loader=yaml.SafeLoader):
            self._line = event.start_mark.line + 1
            if getattr(event, "tag", None):
                self._refuse(f"has the tag {event.tag[:40]!r}", "a config is data, without tags")
            if isinstance(event, yaml.CollectionStartEvent):
                self._count(1, 1)
                mapping = isinstance(event, yaml.MappingStartEvent)
                self._groups.append(_Group(event.anchor, mapping))
            elif isinstance(event, yaml.CollectionEndEvent):
                group = self._groups.pop()
                self._place(group.values, group.height, group.anchor)
            elif isinstance(event, yaml.ScalarEvent):
                self._count(1, 0)
                if event.implicit[0] and (reads := other_base(event.value)):
                    self._refuse(f"has {event.value[:40]}, which YAML reads {reads}", IN_DECIMALS)
                self._scalar(event.value)
                self._place(1, 0, event.anchor, event.value)
            elif isinstance(event, yaml.AliasEvent):
                if any(group.anchor == event.anchor for group in self._groups):
                    self._refuse(f"has *{event.anchor[:40]} within itself", "write it out")
                values, height = self._anchored.get(event.anchor, (1, 0))
                self._count(values, height)
                self._place(values, height)

    def _count(self, values: int, height: int) -> None:
        self._total += values
        if self._total > MOST_VALUES:
            self._refuse(
                f"holds more than {MOST_VALUES} keys and values, each alias counted as what it "
                "stands for,", "give fewer",
            )  # fmt: skip
        if len(self._groups) + height > DEEPEST:
            self._refuse(f"has more than {DEEPEST} groups within one another", "give fewer")

    def _scalar(self, value: str) -> None:
        if value == PYTHON:
            self._refuse(
                f"has {PYTHON}, by which Snakemake runs Python of a file,",
                "a config is data, so leave it out",
            )
        if not self._groups or not self._groups[-1].at_key:
            return
        lines = self._groups[-1].lines
        if value in lines:
            path = [*self._above, *(group.key for group in self._groups[:-1] if group.key), value]
            where = f"lines {lines[value]} and {self._line}"
            if lines[value] == self._line:
                where = f"line {self._line}"
            where = "" if self._above else f", in {where}"
            path = ".".join(key if key.isprintable() else repr(key) for key in path)
            raise ValueError(f"{self._name} gives {path[:200]} twice{where}: keep one of them")
        lines[value] = self._line

    def _place(self, values: int, height: int, anchor=None, key=None) -> None:
        """Where what was read belongs: to its anchor, and to the group around it."""
        if anchor:
            self._anchored[anchor] = values, height
        if self._groups:
            self._groups[-1].add(values, height, key)

    def _refuse(self, what: str, remedy: str) -> None:
        where = "" if self._above else f" in line {self._line}"
        raise ValueError(f"{self._name} {what}{where}: {remedy}")


def _printable(path: str | Path) -> str:
    return str(path) if str(path).isprintable() else repr(str(path))


def _text(file: Path) -> str:
    """The text of a file; ValueError, one sentence, if there is none or too much."""
    path = _printable(file)
    if not file.is_file():  # opening a pipe would wait for ever
        raise ValueError(f"{path} is no file: name a config file that is there")
    try:
        with file.open("rb") as opened:
            content = opened.read(MOST_BYTES + 1)
    except OSError as error:
        raise ValueError(
            f"{path} cannot be read ({error.strerror}): name a config file that can"
        ) from None
    if len(content) > MOST_BYTES:
        raise ValueError(
            f"{path} has more than {MOST_BYTES} bytes: a config has some thousands, so give fewer"
        )
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(
            f"{path} is no UTF-8 from byte {error.start} on: save it as such"
        ) from None


def _untabbed(text: str) -> str:
    """JSON, which may be indented by tabs, as YAML, which may not; no value holds one."""
    try:
        json.loads(text)
    except (ValueError, RecursionError):
        return text
    return text.replace("\t", " ")


def _no_yaml(name: str | Path, error: Exception) -> str:
    mark = getattr(error, "problem_mark", None)
    where = f" in line {mark.line + 1}" if mark else ""
    about = getattr(error, "problem", None) or getattr(error, "reason", None) or error
    return f"{name} is no YAML: {' '.join(str(about).split())[:200]}{where}"
