"""How a recording is read: the options of `read_recording`, and a part of the config's section."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, field_validator
from pydantic_core import PydanticCustomError

from fiberweb.model.scene import NotNegative, Positive
from fiberweb.recordings import READERS
from fiberweb.recordings.base import LENGTHS
from fiberweb.sections import Section, key

Share = Annotated[float, Field(ge=0, le=1)]
TIME_UNITS = {"s": 1.0, "ms": 1e-3, "us": 1e-6}


class Reading(Section):
    """How a file is read; a key that is left out is taken from the file."""

    format: Literal[tuple(READERS)] | None = key(None, "of the file; null looks into it")
    rate: Positive | None = key(None, "frames per second; of files that do not state it", "Hz")
    time: str | None = key(None, "column or path of the time")
    time_unit: Literal[tuple(TIME_UNITS)] | None = key(None, "unit of the time in the file")
    input: str | None = key(
        None,
        "column or path of the input, or marker.x or marker.y of the driven marker; a path may end "
        "in [0] for one column of an array",
    )
    markers: str | dict[str, list[str]] | None = key(
        None,
        "columns of each marker, {name: [x, y]}, or the path of an array (frames, markers, "
        "coordinates)",
    )
    units: Literal[tuple(LENGTHS)] | None = key(None, "unit of positions in the file")
    plane: Literal["xy", "xz", "yz"] = key("xy", "of recordings in space, the coordinates to keep")
    likelihood: Share = key(0.6, "DeepLabCut: points less likely than this count as not seen")
    max_gap: NotNegative = key(0.1, "gaps up to this long are interpolated", "s")
    hidden: Literal["refuse", "leave out"] = key(
        "refuse", "what a marker with a longer gap means: the file is refused, or it is left out"
    )

    @field_validator("markers")
    @classmethod
    def _some_marker(cls, markers):
        if markers is not None and not markers:
            raise PydanticCustomError("no_marker", "name at least one marker, or leave it out")
        return markers
