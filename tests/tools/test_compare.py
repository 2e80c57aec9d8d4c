"""Capacities of two tables, design point by design point."""

import numpy as np
import pandas as pd
import pytest

from fiberweb.scoring import tables
from fiberweb.tables import write
from fiberweb.tools import compare

OLD = [
    # n, force, c_nl, c_m, status
    (2, 0.05, 0.40, 0.30, "ok"),
    (4, 0.05, 0.60, 0.35, "ok"),
    (4, 0.40, np.nan, np.nan, "unstable"),
]


def table(rows, **more):
    """A study's table before (or after) a change; the run's name and the step differ anyhow."""
    frame = pd.DataFrame(rows, columns=["n", "force_N", "c_nl", "c_m", "status"])
    frame = frame.assign(setup="described", run=f"run-{np.random.default_rng().random()}")
    return frame.assign(**{"time_step_s": 1e-5, "elements_per_section": 4} | more)


def changed(at, **values):
    """`OLD` with one row changed."""
    rows = [dict(zip(("n", "force_N", "c_nl", "c_m", "status"), row)) for row in OLD]
    rows[at] |= values
    return [tuple(row.values()) for row in rows]


def code(folder, old, new, *options):
    """Exit code of the command."""
    for name, frame in (("old", old), ("new", new)):
        write(frame, folder / f"{name}.csv")
    return compare.main([str(folder / "old.csv"), str(folder / "new.csv"), *options])


def test_small_moves_pass_and_the_largest_is_named(tmp_path, capsys):
    new = table(changed(1, c_nl=0.61, c_m=0.352)[::-1], time_step_s=7e-6, elements_per_section=6)
    assert code(tmp_path, table(OLD), new) == 0  # by 0.01 and not by more
    printed = capsys.readouterr().out
    assert "3 rows in both tables" in printed
    assert (
        "c_nl moved by 0.0100 at most: 0.6000 (ok) -> 0.6100 (ok), n = 4, force_N = 0.05" in printed
    )
    assert "c_m moved by 0.0020 at most: 0.3500 (ok) -> 0.3520 (ok)" in printed
    assert "0 rows moved by more than 0.01" in printed


@pytest.mark.parametrize(
    "values", [{"c_nl": 0.59 - 1e-6}, {"c_m": 0.37}], ids=["nonlinear", "memory"]
)
def test_a_larger_move_fails_and_a_wider_tolerance_lets_it_pass(tmp_path, values):
    old, new = table(OLD), table(changed(1, **values))
    assert code(tmp_path, old, new) == 1
    assert code(tmp_path, old, new, "--tolerance", "0.03") == 0


@pytest.mark.parametrize(
    ("at", "values"),
    [
        (1, {"c_nl": np.nan, "c_m": np.nan, "status": "unstable"}),
        (2, {"c_nl": 0.5, "c_m": 0.3, "status": "ok"}),
        (2, {"status": "ok"}),
    ],
    ids=["blew up", "became stable", "no number still"],
)
def test_another_status_is_a_move(tmp_path, capsys, at, values):
    assert code(tmp_path, table(OLD), table(changed(at, **values)), "--tolerance", "1") == 1
    printed = capsys.readouterr().out
    assert "c_nl moved by 0.0000 at most" in printed  # of the rows with a number
    assert "1 rows moved by more than 1, or changed their status\n  n = 4" in printed


def test_rows_of_one_table_are_listed_and_not_compared(tmp_path, capsys):
    new = table([*OLD[:2], (6, 0.05, 0.9, 0.9, "ok")])
    assert code(tmp_path, table(OLD), new) == 0
    printed = capsys.readouterr().out
    assert "2 rows in both tables" in printed
    assert "1 only in the old one\n  n = 4, force_N = 0.4\n" in printed
    assert "1 only in the new one\n  n = 6, force_N = 0.05\n" in printed


def test_an_empty_cell_changes_no_design_point(tmp_path):
    old, new = table(OLD, noise_seed=[0, 1, 2]), table(OLD[:2], noise_seed=[0, 1])
    old = pd.concat([old, table([OLD[0]], noise_seed=np.nan)])
    assert code(tmp_path, old, new) == 0
    assert set(compare.match(old, new)[0]["side"]) == {"both", "old"}


def test_meshes_of_one_point_are_compared_in_their_order(tmp_path):
    rows = [(4, 0.05, 0.6, 0.3, "ok"), (4, 0.05, 0.9, 0.5, "ok")]
    old = table(rows, elements_per_section=[5, 10])
    new = table(rows[::-1], elements_per_section=[10, 5])
    assert code(tmp_path, old, new) == 0
    assert code(tmp_path, old, new.assign(elements_per_section=[5, 10])) == 1


def test_outcomes_of_every_study_identify_nothing():
    points = {
        "setup", "topology", "n", "spacing_m", "force_N", "tension_N", "force_choice",
        *tables.PHYSICS,
    }  # fmt: skip
    study = {*tables.COLUMNS, "force_choice", *tables.PHYSICS, *tables.NUMERICS}
    assert study - compare.OUTCOMES == points


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda path: path.unlink(), "new.csv cannot be read (No such file or directory); give"),
        (lambda path: path.write_text(""), "new.csv cannot be read (not a CSV table); give"),
        (lambda path: path.write_text("n,c_nl\n2,1\n"), "new.csv has no column 'c_m' of numbers"),
        (lambda path: path.write_text("n,c_nl,c_m\n2,x,1\n"), "no column 'c_nl' of numbers"),
        (lambda path: path.write_text("n,c_nl,c_m\n2,1,1\n"), "the column 'force_N' is in one"),
        (lambda path: write(table([(9, 1.0, 1.0, 1.0, "ok")]), path), "no row of one table"),
    ],
    ids=["no file", "empty", "no column", "no number", "another study", "another config"],
)
def test_bad_tables_are_one_sentence(tmp_path, capsys, change, sentence):
    for name in ("old", "new"):
        write(table(OLD), tmp_path / f"{name}.csv")
    change(tmp_path / "new.csv")
    assert compare.main([str(tmp_path / "old.csv"), str(tmp_path / "new.csv")]) == 2
    printed = capsys.readouterr()
    assert sentence in printed.err and printed.err.count("\n") == 1 and not printed.out


def test_a_tolerance_below_zero_is_refused(tmp_path, capsys):
    assert code(tmp_path, table(OLD), table(OLD), "--tolerance", "-1") == 2
    assert "--tolerance = -1 is not usable; give 0 or more" in capsys.readouterr().err
