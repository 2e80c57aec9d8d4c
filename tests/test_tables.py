"""Tables come back as they were written, in one order and with the same bytes every time."""

import numpy as np
import pandas as pd

from fiberweb import tables

TABLE = pd.DataFrame(
    {
        "setup": ["described", "described", "published"],
        "n": [2, 4, 4],
        "force_N": [0.1, 1 / 3, 0.05],
        "c_nl": [np.nan, 0.123456789012, 0.5],
        "status": ["unstable", "ok", "ok"],
        "run": ["a", "c", "b"],
    }
)


def test_a_table_has_the_same_bytes_whatever_the_order_of_its_rows(tmp_path):
    tables.write(TABLE, tmp_path / "a.csv")
    tables.write(TABLE.iloc[::-1], tmp_path / "b.csv")
    content = (tmp_path / "a.csv").read_bytes()
    assert content == (tmp_path / "b.csv").read_bytes()
    assert content.decode() == (
        "setup,n,force_N,c_nl,status,run\n"
        "described,2,0.1,,unstable,a\n"
        "described,4,0.3333333333,0.123456789,ok,c\n"
        "published,4,0.05,0.5,ok,b\n"
    )
    assert {path.name for path in tmp_path.iterdir()} == {"a.csv", "b.csv"}  # nothing partial


def test_read_returns_what_was_written(tmp_path):
    tables.write(TABLE, tmp_path / "new" / "study.csv")
    again = tables.read(tmp_path / "new" / "study.csv")
    pd.testing.assert_frame_equal(again, TABLE, rtol=1e-9, check_dtype=False)


def test_the_name_of_a_network_is_text(tmp_path):
    tables.write(pd.DataFrame({"name": ["NA", "007"], "n": [2, np.nan]}), tmp_path / "webs.csv")
    again = tables.read(tmp_path / "webs.csv")
    assert again["name"].tolist() == ["NA", "007"] and again["n"].isna().tolist() == [False, True]


def test_equal_rows_keep_their_order():
    frame = pd.DataFrame({"n": [4, 2, 4], "choice": ["b", "a", "a"]})
    assert tables.ordered(frame)["choice"].tolist() == ["a", "b", "a"]
    frame = pd.DataFrame({"choice": ["b", "a"]})
    assert tables.ordered(frame)["choice"].tolist() == ["b", "a"]
