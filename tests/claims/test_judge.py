"""Every claim is in the table of verdicts, in one setup and side by side."""

import pandas as pd

from fiberweb import studies
from fiberweb.claims import judge as claims
from tests.claims.agreeing import curve_table, topology_table

VERDICTS = {"holds", "differs", "calibrated", "not applicable", "not computed"}
MODULES = studies.claims()
SETUPS = ("described", "published", "compliant")


def test_every_claim_has_one_row_and_a_verdict_word():
    for setup in SETUPS:
        given = {"topology": topology_table(setup), "topology_curves": curve_table(setup)}
        for tables in ({}, given):
            result = claims.evaluate(tables, setup, MODULES)
            assert list(result.columns) == list(claims.COLUMNS)
            assert list(result["id"]) == [claim["id"] for claim in claims.load()]
            assert result["id"].is_unique
            assert set(result["verdict"]) <= VERDICTS
            assert not result.isna().any(axis=None)


def test_claims_without_their_tables_are_not_computed():
    published = claims.evaluate({}, "published", MODULES)
    assert set(published["verdict"]) == {"not computed"}
    described = claims.evaluate({}, "described", MODULES).set_index("id")["verdict"]
    reference = described.index.str.startswith("G")
    assert set(described[reference]) == {"not applicable"}
    assert set(described[~reference]) == {"not computed"}


def test_a_setup_without_runs_is_not_computed():
    tables = {
        "topology": topology_table("described"), "topology_curves": curve_table("described")
    }  # fmt: skip
    for setup, verdict in (("described", "holds"), ("published", "not computed")):
        result = claims.evaluate(tables, setup, MODULES).set_index("id")
        assert result.loc["T5", "verdict"] == verdict


def test_setups_stand_side_by_side():
    """In columns named after them, as they were judged."""
    by_setup = {}
    for setup in SETUPS:
        tables = {"topology": topology_table(setup), "topology_curves": curve_table(setup)}
        by_setup[setup] = claims.evaluate(tables, setup, MODULES)
    joined = claims.join(by_setup)
    shared = list(claims.COLUMNS)[:-2]
    own = [column for setup in SETUPS for column in (setup, f"{setup}_verdict")]
    assert list(joined.columns) == [*shared, *own]
    for setup, frame in by_setup.items():
        pd.testing.assert_frame_equal(joined[shared], frame[shared])
        assert list(joined[setup]) == list(frame["value"])
        assert list(joined[f"{setup}_verdict"]) == list(frame["verdict"])
    verdicts = joined.set_index("id").loc["T1", [f"{setup}_verdict" for setup in SETUPS]]
    assert list(verdicts) == ["holds", "holds", "calibrated"]


def test_every_rule_is_written_down_and_belongs_to_a_claim():
    rules = claims.rules(MODULES)
    assert {"T1", "T2", "T3", "T4", "T5", "T6", "T7", "T8", "T9", "G3"} <= set(rules)
    assert {"R1", "R5", "S1", "S2", "P1", "P2", "F1", "F7", "G1", "G2"} <= set(rules)
    assert set(rules) <= {claim["id"] for claim in claims.load()}
    assert all(rule.__doc__ for rule in rules.values())
    of_each = [set(claims.rules([module])) for module in MODULES]
    assert sum(map(len, of_each)) == len(rules)  # no claim has two rules


def test_the_papers_word_stands_beside_ours():
    paper = claims.evaluate({}, "published", MODULES).set_index("id")["paper"]
    assert paper["T1"] == "0.999"
    assert paper["R2"] == "0.8 to 1.5"
    assert paper["N4"] == "0.00246, 0.02383, 0.04082"
    assert paper["T5"] == ""  # the statement is the word
