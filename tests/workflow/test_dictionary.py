"""docs/data-dictionary.md: written anew it is the same, and files hold what it says."""

import re

import pandas as pd
import pytest
import xarray as xr

from fiberweb import studies
from fiberweb.meanings import explained, text_and_unit
from fiberweb.tools.dictionary import OF_EACH_RUN, PAGE, dictionary, page
from tests.workflow.explained import compared

UNITS = {
    "m": "m", "N": "N", "s": "s", "rad": "rad", "Hz": "Hz", "J": "J", "Pa": "Pa", "deg": "degrees",
    "N_m": "N/m", "Ns_m": "N s/m", "Nm": "N m", "per_s": "1/s", "per_m": "1/m",
}  # fmt: skip
SUFFIX = re.compile(rf"(?<!\bc)(?<!_c)_({'|'.join(sorted(UNITS, key=len, reverse=True))})$")


def test_page_is_what_the_code_says():
    assert PAGE.read_text(encoding="utf-8") == page(), "run python -m fiberweb.tools.dictionary"


@pytest.mark.slow
def test_files_of_the_smoke_run_hold_what_the_page_says(smoked):
    found = compared(smoked.folder / "out")
    described = [name for name in studies.STUDIES if "described" in studies.setups(name)]
    tables = {f"tables/<setup>/{file}" for name in described for file in studies.load(name).TABLES}
    assert found >= {*tables, *list(OF_EACH_RUN)[:2], "tables/<setup>/claims.csv"}


def test_a_column_that_names_its_unit_has_it():
    named = 0
    for made in dictionary():
        for name, meaning in (made.meanings | (made.attributes or {})).items():
            if suffix := SUFFIX.search(name):
                assert text_and_unit(meaning)[1] == UNITS[suffix[1]], (made.files, name)
                named += 1
    assert named > 50


def test_what_has_no_meaning_cannot_be_made():
    @explained({"a": "one", "b": ("two", "m")}, attributes={"of": "three"})
    def make(product):
        return product

    made = make(xr.Dataset({"b": ("t", [1.0, 2.0])}, {"a": ("t", ["x", "y"])}, {"of": "it"}))
    assert made["b"].attrs == {"long_name": "two", "units": "m"}
    assert made["a"].attrs == {"long_name": "one"}
    for product in (
        pd.DataFrame({"a": [1], "c": [2]}),
        xr.Dataset({"c": 1.0}),
        xr.Dataset({"a": 1.0}, attrs={"c": 1}),
    ):
        with pytest.raises(TypeError, match=r"make makes 'c' without saying what it is"):
            make(product)
