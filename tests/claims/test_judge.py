"""Every claim is in the table of verdicts, in one setup and side by side."""

import pandas as pd

from fiberweb import studies
from fiberweb.claims import judge as claims
from tests.claims.agreeing import curve_table, topology_table

VERDICTS = {"holds", "differs", "calibrated", "not applicable", "not computed"}
MODULES = studies.claims()


def test_every_claim_has_one_row_and_a_verdict_word():
    for setup in ("described", "published"):
        given = {"topology": topology_table(setup), "topology_curves": curve_table(setup)}
        for tables in ({}, given):
            result = claims.evaluate(tables, setup, MODULES)
            assert list(result.columns) == list(claims.COLUMNS)
            assert list(result["id"]) == [claim["id"] for claim in claims.load()]
            assert result["id"].is_unique
            assert set(result["verdict"]) <= VERDICTS
            assert not result.isna().any(axis=None)


def test_claims_without_their_tables_are_not_computed():
    result = claims.evaluate({}).set_index("id")
    assert set(result["published_verdict"]) == {"not computed"}
    reference = result.index.str.startswith("G")
    assert set(result.loc[reference, "described_verdict"]) == {"not applicable"}
    assert set(result.loc[~reference, "described_verdict"]) == {"not computed"}


def test_a_setup_without_runs_is_not_computed():
    result = claims.evaluate(
        {"topology": topology_table("described"), "topology_curves": curve_table("described")}
    ).set_index("id")
    assert result.loc["T5", "described_verdict"] == "holds"
    assert result.loc["T5", "published_verdict"] == "not computed"


def test_every_rule_is_written_down_and_belongs_to_a_claim():
    rules = claims.rules()
    assert {"T1", "T2", "T3", "T4", "T5", "T6", "T7", "T8", "T9", "G3"} <= set(rules)
    assert set(rules) <= {claim["id"] for claim in claims.load()}
    assert all(rules.values())


def test_the_papers_word_stands_beside_ours():
    paper = claims.evaluate({}).set_index("id")["paper"]
    assert paper["T1"] == "0.999"
    assert paper["R2"] == "0.8 to 1.5"
    assert paper["N4"] == "0.00246, 0.02383, 0.04082"
    assert paper["T5"] == ""  # the statement is the word
