"""Arguments of the library: NumPy's numbers as Python's own, and what is wrong as one sentence."""

from __future__ import annotations

import math
import reprlib
from collections.abc import Callable, Collection, Mapping
from functools import wraps
from inspect import Parameter, signature
from pathlib import Path
from typing import TypeVar

import numpy as np

from fiberweb.errors import unknown_key

Called = TypeVar("Called", bound=Callable)
# of a number in SI units that is not 0; of others the powers and products cannot all be held
LEAST, MOST = 1e-40, 1e40
OWN = frozenset({float, int, bool, str, type(None)})  # nothing to convert, and the most frequent


def plain(value):
    """NumPy's scalars as Python's own of the same value, its arrays as lists; groups, lists and
    tuples likewise, anything else as it is.

    JSON, file names and numba take them for other things than numbers, and arithmetic in single
    precision would go on in it.
    """
    if type(value) in OWN:
        return value
    if isinstance(value, np.floating):
        return float(value)  # of a long double, `item` is one as well
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    if isinstance(value, Mapping):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return type(value)(map(plain, value)) if type(value) in (list, tuple) else value
    return value


def whole(name: str, value, least: int, rule: str = "") -> int:
    """A whole number, NumPy's or Python's; ValueError for anything else, which ends in the rule."""
    number = plain(value)
    if type(number) is not int or number < least:
        rule = rule or f" must be a whole number of at least {least}"
        raise ValueError(f"{name} = {shown(value)}{rule}")
    return number


def positive(name: str, value, rule: str) -> float:
    """A finite number above zero, NumPy's or Python's; ValueError for anything else, which ends in
    the rule."""
    number = plain(value)
    if type(number) not in (float, int) or not 0 < number < math.inf:
        raise ValueError(f"{name} = {shown(value)}{rule}")
    return float(number)


def check_magnitude(name: str, value, least: float = LEAST, most: float = MOST) -> None:
    """Raise ValueError for a number, or one of a tuple, that is of no magnitude to compute with; 0
    and infinity are of any."""
    for each in value if isinstance(value, tuple) else (value,):
        if type(each) is float and each and not least <= abs(each) <= most and abs(each) < math.inf:
            raise ValueError(
                f"{name} = {each:g}: its magnitude has to be between {least:g} and {most:g}, in SI "
                "units"
            )


def true_or_false(name: str, value) -> bool:
    """A truth value, NumPy's or Python's; ValueError for anything else."""
    answer = plain(value)
    if type(answer) is not bool:
        raise ValueError(f"{name} = {shown(value)} must be True or False")
    return answer


def shown(value) -> str:
    """A value as a sentence can hold it: short, on one line, of NumPy's scalars the number."""
    value = plain(value)
    if isinstance(value, (float, int, str, list, tuple, dict, Path, type(None))):
        return reprlib.repr(value)
    return f"{type(value).__name__}(...)"


def check_names(given: Mapping, known: Collection[str]) -> None:
    """Raise ValueError for the first of the keyword arguments that does not exist."""
    for name, value in given.items():
        if name not in known:
            unknown = unknown_key(name, known, kind="argument")
            raise ValueError(f"{name} = {shown(value)}: {unknown}")


def spelt(called: Called) -> Called:
    """A function or dataclass that refuses a misspelt argument with the nearest that exists.

    Without it Python says only that there is none of this name, and after other work was done.
    """
    target = called.__init__ if isinstance(called, type) else called
    parameters = list(signature(called).parameters.values())
    known = [each.name for each in parameters if each.kind is not Parameter.VAR_KEYWORD]

    @wraps(target)
    def checked(*args, **kwargs):
        check_names(kwargs, known)
        return target(*args, **kwargs)

    if not isinstance(called, type):
        return checked
    called.__init__ = checked
    return called
