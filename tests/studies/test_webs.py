"""Names of networks of one's own: in the table, in the figure, and those that are refused."""

import pytest
from pydantic import ValidationError

from fiberweb import tables
from fiberweb.errors import sentence
from fiberweb.studies import webs
from fiberweb.studies.webs import figure
from tests.figures.legible import BASELINES, said
from tests.studies.sweeps import finish

FIBRES = webs.EXAMPLE.fibres


@pytest.mark.parametrize("names", [["NA", "007", "null"], ["cost $x^{ y$", "$", "a"]])
def test_a_name_is_drawn_as_it_stands(tmp_path, names):
    table = finish([{"name": name, "c_nl": 0.4, "c_m": 0.2} for name in names])
    tables.write(table, tmp_path / "webs.csv")
    given = {"webs": tables.read(tmp_path / "webs.csv"), "webs_baselines": BASELINES}
    networks = [webs.WebSection(name=name, fibres=FIBRES).model_dump() for name in names]
    drawn = figure.draw(given, "described", tmp_path / "webs", networks=networks)
    assert all(name in said(drawn).replace(r"\$", "$") for name in names)


@pytest.mark.parametrize("name", [" 007", "a ", "a\rb", "a\0", "a\x1b[2Jb"])
def test_a_name_that_no_table_can_hold_is_one_sentence(name):
    with pytest.raises(ValidationError) as caught:
        webs.WebSection(name=name, fibres=FIBRES)
    text = sentence(caught.value)
    assert text.isprintable() and text.startswith(f"name = {name!r}: give a name")
