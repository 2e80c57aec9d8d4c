"""`python -m fiberweb.tools.dictionary`: write docs/data-dictionary.md.

What each column and variable means stands where it is made (`fiberweb.meanings`); here is only
which function makes which file. Files that one function makes share a section.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from fiberweb import origin, products, progress, provenance, studies
from fiberweb.meanings import Meanings, text_and_unit
from fiberweb.scoring import card
from fiberweb.written import BESIDE

PAGE = Path(__file__).parents[2] / "docs" / "data-dictionary.md"
INTRODUCTION = """# Data dictionary

Every variable of every file in `results/`, and every column of every table. Units are SI; a number
without a unit is dimensionless, an empty cell not a number. This page is written by
`python -m fiberweb.tools.dictionary` from what the code says of each; the NetCDF files say the same
of their variables, in `long_name` and `units`.
"""
OF_EACH_RUN = {
    "runs/<run>/response.nc": "fiberweb.simulation.response:response",
    "runs/<run>/capacity.nc": "fiberweb.scoring.capacity:score",
    "runs/<run>/certificate.csv": "fiberweb.validation.certificate:certificate",
}
OF_RECORDINGS = {
    "recordings/<name>/recording.nc": "fiberweb.recordings.read:attempt",
    "recordings/<name>/sanity.csv": "fiberweb.recordings.read:listed",
}
OF_CLAIMS = {
    "tables/<setup>/claims.csv": "fiberweb.claims.judge:evaluate",
    "tables/claims.csv": "fiberweb.claims.judge:join",
}


class Made(NamedTuple):
    """What one function makes: files, as seen from the results; what a row of them is; columns or
    variables; attributes."""

    files: list[str]
    sentence: str
    meanings: Meanings
    attributes: Meanings | None = None


def makers() -> dict[str, str]:
    """The function that makes each file, as "module:function"."""
    found = dict(OF_EACH_RUN)
    for study in map(studies.load, studies.STUDIES):
        found |= {f"tables/<setup>/{file}": spec.make for file, spec in study.TABLES.items()}
    for job in studies.load("accuracy").JOBS.values():
        found |= {f"tables/{file}": spec.make for file, spec in job.items()}
    found["tables/<setup>/ridge_best.csv"] = "fiberweb.studies.ridge.best:best_unbuckled"
    return found | OF_CLAIMS | OF_RECORDINGS


def dictionary() -> list[Made]:
    """All that the workflow makes, in the order of its stages.

    Raises:
        ValueError: a function does not say what it makes, one sentence.
    """
    files: dict[str, list[str]] = {}
    for file, maker in makers().items():
        files.setdefault(maker, []).append(file)
    made = [_made(maker, of_it) for maker, of_it in files.items()]
    folder = "recordings/<name>/card"
    scores = "One row for each readout and quantity of a score card."
    facts = {f"facts.{name}": meaning for name, meaning in card.FACTS.items()}
    profile = {f"profile[].{name}": meaning for name, meaning in card.PROFILE.items()}
    quantities = {f"quantity = {name}": meaning for name, meaning in card.QUANTITIES.items()}
    return [
        *made,
        Made([f"{folder}.csv"], scores, card.SCORES | quantities),
        Made([f"{folder}.json"], "The whole card.", card.CARD | facts | profile),
        Made(["provenance.json"], "What made the results, call by call.", provenance.MEANINGS),
        Made(["progress.json"], "How far the last call is.", progress.MEANINGS),
        Made([f"tables/<setup>/<table>{BESIDE}"], "What a table rests on.", origin.MEANINGS),
    ]


def page() -> str:
    """The page as Markdown."""
    return "\n".join([INTRODUCTION, *map(_section, dictionary())])


def _made(maker: str, files: list[str]) -> Made:
    function: Callable = products.function(maker)
    if not hasattr(function, "meanings"):
        raise ValueError(
            f"{maker} does not say what is in {files[0]}: mark it with `explained` of "
            "fiberweb.meanings"
        )
    sentence = " ".join(function.__doc__.split("\n\n")[0].split())
    return Made(files, sentence, function.meanings, function.attributes)


def _section(made: Made) -> str:
    folder = Path(made.files[0]).parent
    names = ", ".join(Path(file).name for file in made.files)
    lines = [f"## {names}\n", f"{made.sentence} In `{folder}/`.\n"]
    lines += _table("variable" if made.attributes else "name", made.meanings)
    if made.attributes:
        lines += ["", *_table("attribute", made.attributes)]
    return "\n".join(lines) + "\n"


def _table(what: str, meanings: Meanings) -> Iterator[str]:
    yield f"| {what} | unit | meaning |"
    yield "|---|---|---|"
    for name, meaning in meanings.items():
        text, unit = text_and_unit(meaning)
        yield f"| `{name}` | {unit or '–'} | {text} |"


def main() -> None:
    """Write the page."""
    PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
