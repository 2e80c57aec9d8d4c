"""Networks of one's own, given as lists of fibres: docs/own-network.md."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Self

from pydantic import AfterValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from fiberweb.model.network import Network, web
from fiberweb.model.scene import Finite
from fiberweb.sections import Positive, Section, Some, key
from fiberweb.studies.base import Figure, Lab, Point, Table, every, input_baselines


def _legible(name: str) -> str:
    """A name that a table and a figure can show."""
    if name != name.strip() or not name.isprintable():
        raise PydanticCustomError(  # its sentence begins with the key and the value
            "name", "give a name without control characters, and without blanks at its ends"
        )
    return name


Name = Annotated[str, AfterValidator(_legible)]
Place = Annotated[list[Finite], Field(min_length=2, max_length=2)]
Fibre = Annotated[list[Place], Field(min_length=2, max_length=2)]


class WebSection(Section):
    """One network of straight fibres."""

    name: Name = key(..., "of the network, in table and figure", min_length=1)
    fibres: Some[Fibre] = key(..., "near and far end of each fibre, [[x, y], [x, y]]", "m")
    driven_fibre: Annotated[int, Field(ge=0)] = key(0, "number of the fibre that is shaken, from 0")
    driven_distance: Positive | None = key(
        None, "of the driven point from that fibre's near end; null: halfway along", "m"
    )
    force: Positive | None = key(None, "amplitude of the force; null takes Eq. 3", "N")

    def network(self) -> Network:
        """The network; ValueError, one sentence, if it is none."""
        try:
            return web(self.fibres, self.driven_fibre, self.driven_distance)
        except ValueError as error:
            raise ValueError(f"webs.networks, {self.name!r}: {error}") from None


EXAMPLE = WebSection(
    name="example",
    fibres=[
        [[0.0, 0.1], [0.5, 0.2]], [[0.0, 0.25], [0.5, 0.25]], [[0.0, 0.4], [0.5, 0.3]],
        [[0.12, 0.0], [0.18, 0.5]], [[0.4, 0.0], [0.42, 0.5]], [[0.05, 0.0], [0.5, 0.45]],
    ],
    driven_fibre=1,
)  # fmt: skip


class WebsSection(Section):
    """Networks of one's own."""

    networks: Some[WebSection] = key([EXAMPLE], "networks, each with a name")

    @model_validator(mode="after")
    def _names_differ(self) -> Self:
        names = [each.name for each in self.networks]
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"webs.networks has two networks called {name!r}: rename one")
        return self


SECTION = WebsSection
SETUPS = ("described", "compliant")  # the authors' code has no other networks than theirs


def points(section: WebsSection, lab: Lab) -> Iterator[Point]:
    """One run for each network."""
    for each in section.networks:
        yield Point(lab.scene(each.network(), force=each.force), each.name)


def check(section: WebsSection, lab: Lab) -> None:
    """Raise ValueError for what is no network."""
    for each in section.networks:
        each.network()


def drawn(section: WebsSection) -> dict:
    """Options: the networks, which no table has."""
    return {"networks": [each.model_dump() for each in section.networks]}


TABLES = {
    "webs.csv": Table("fiberweb.studies.webs.tables:by_name", capacities=every, choices=True),
    "webs_baselines.csv": input_baselines(),
}
FIGURES = {"webs": Figure("fiberweb.studies.webs.figure:draw", tuple(TABLES), options=drawn)}
