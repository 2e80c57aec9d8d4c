"""One clear sentence for each thing a user can get wrong."""

from __future__ import annotations

import re
import reprlib
from difflib import get_close_matches
from itertools import takewhile

SHOWN = 40  # names, of those that exist
_BRIEF = reprlib.Repr()
_BRIEF.maxstring = _BRIEF.maxother = 200
_BRIEF.maxlist = _BRIEF.maxtuple = 20
brief = _BRIEF.repr  # a value as a sentence can hold it


def on_one_line(text: str) -> str:
    """A sentence with whatever it quotes: what cannot be printed is escaped."""
    return "".join(
        letter if letter.isprintable() else letter.encode("unicode_escape").decode()
        for letter in text
    )


def unknown_key(key: str, known, where: str = "", kind: str = "key") -> str:
    """The sentence for a key that does not exist, with the nearest one that does, or all."""
    key, known = str(key)[:100], list(map(str, known))
    near = get_close_matches(key, known, n=1)
    if not near:
        shown = ", ".join(name[:100] for name in known[:SHOWN])
        more = f" and {len(known) - SHOWN} more" if len(known) > SHOWN else ""
        return f"unknown {kind} '{where}{key}': the valid {kind}s are {shown}{more}"
    return f"unknown {kind} '{where}{key}': the nearest valid {kind} is '{where}{near[0]}'"


class Named(dict):
    """Things by their names; one that is not there is refused in a sentence.

    Args:
        kind: what they are, such as "run".
    """

    def __init__(self, kind: str):
        super().__init__()
        self.kind = kind

    def __missing__(self, name: str):
        near = get_close_matches(name, self, n=1) or [*self][:1]
        such = f", such as {near[0]}" if near else ""
        raise ValueError(
            f"there is no {self.kind} {name!r} in this config: it has {len(self)}{such}"
        )


def sentence(error, where: str = "", known=()) -> str:
    """The first problem of a pydantic ValidationError as one sentence.

    Args:
        error: pydantic.ValidationError.
        where: the key that was validated, for instance "scene".
        known: valid keys at the level of the error, used for unknown ones.
    """
    problem = error.errors()[0]
    *above, key = [part for part in (where, *map(str, location(problem))) if part]
    if problem["type"] == "extra_forbidden":
        return unknown_key(key, known, "".join(f"{part}." for part in above))
    if problem["type"] == "value_error":
        return problem["msg"].removeprefix("Value error, ")
    text = "List at least one" if problem["type"] == "too_short" else problem["msg"]
    return f"{'.'.join([*above, key])} = {brief(problem['input'])}: {text[0].lower()}{text[1:]}"


def location(problem) -> list:
    """Where the first problem of a ValidationError is, without pydantic's names for the kinds of
    value that a key may have."""
    if problem["type"] == "extra_forbidden":  # as it was written, whatever it holds
        return list(problem["loc"])
    kinds = re.compile(r"str|.*[^\w ].*")
    return list(takewhile(lambda part: not kinds.fullmatch(str(part)), problem["loc"]))
