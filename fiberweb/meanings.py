"""What columns and variables mean, said where they are made.

A function that makes a table or a dataset is marked with what is in it:

    @explained(tables.COLUMNS, {"alpha": "ridge penalty", "noise_m": ("noise of a readout", "m")})

Of a number with a unit the meaning is a pair; of others the text alone. What the function makes is
looked at each time: a column or a variable without a meaning is an error. Variables take the
meaning into their file, as `long_name` and `units`. `fiberweb.tools.dictionary` writes all of them
into docs/data-dictionary.md.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import wraps

Meanings = Mapping[str, "str | tuple[str, str]"]
NUMBERS = "biufc"  # kinds of NumPy's dtypes that have a unit
# attributes that what is made of a run takes over from its response
RUN = {
    "status": "ok, or unstable: then values are NaN from some time on; of a recording also refused",
    "unstable_at": ("when the run became unstable", "s"),
    "setup": "described, published or compliant; or recording",
    "scene": "the physics, as JSON; SI units",
    "run": "name of the run, or of the recording",
    "engine": "kirchhoff, cosserat or elastica",
    "elements_per_section": "elements on a section as long as the spacing; authors: their mesh",
    "time_step": ("step of the integration", "s"),
    "sample_rate": ("of the frames", "Hz"),
    "engine_source": "hash of the code that the response depends on",
    "versions": "of the packages of the engine",
}


def text_and_unit(meaning: str | tuple[str, str]) -> tuple[str, str]:
    """Both parts of a meaning; the unit is "" where there is none."""
    return (meaning, "") if isinstance(meaning, str) else meaning


def check(names: Iterable[str], meanings: Meanings, maker: str) -> None:
    """Raise TypeError, one sentence, for the first of the names that has no meaning."""
    for name in names:
        if name not in meanings:
            raise TypeError(f"{maker} makes {name!r} without saying what it is: add its meaning")


def explained(*groups: Meanings, attributes: Meanings | None = None) -> Callable:
    """Mark a function that returns a DataFrame or a Dataset with what its columns, or its variables
    and attributes, mean; as ``meanings`` and ``attributes`` of the function."""
    meanings = {name: meaning for group in groups for name, meaning in group.items()}

    def mark(function: Callable) -> Callable:
        maker = f"{function.__module__}:{function.__name__}"

        @wraps(function)
        def made(*args, **kwargs):
            product = function(*args, **kwargs)
            if hasattr(product, "columns"):
                check(product.columns, meanings, maker)
            else:
                check(product.variables, meanings, maker)
                check(product.attrs, made.attributes, maker)
                for name, variable in product.variables.items():
                    text, unit = text_and_unit(meanings[name])
                    units = {"units": unit or "1"} if variable.dtype.kind in NUMBERS else {}
                    # what the function itself says of a unit wins: pixels, where others have metres
                    variable.attrs = {"long_name": text} | units | variable.attrs
            return product

        made.meanings, made.attributes = meanings, attributes or {}
        return made

    return mark
