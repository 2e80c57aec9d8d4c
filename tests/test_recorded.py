"""The list of recordings in a config: files, folders, names."""

import pytest

from fiberweb.config import load
from fiberweb.recorded import recorded


def of(*entries):
    return recorded(load({"recordings": list(entries)}).recordings)


def test_a_file_and_a_folder(tmp_path):
    for name in ("one.csv", "two.mat", "two.csv", "notes.md"):
        (tmp_path / name).touch()
    film = {"path": str(tmp_path / "one.csv"), "name": "my film", "card": {"taps": 3}}
    found = of({"path": str(tmp_path), "read": {"rate": 60.0}}, film)
    assert list(found) == ["one", "two.csv", "two.mat", "my-film"]
    assert found["two.mat"] == (tmp_path / "two.mat", {"rate": 60.0}, {})
    assert found["my-film"].card == {"taps": 3}


def test_a_file_that_is_not_there_is_left_to_its_job(tmp_path):
    assert list(of({"path": str(tmp_path / "gone.csv")})) == ["gone"]


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ([{"path": "{here}"}], "holds no recording: .csv"),
        ([{"path": "{here}/a.csv"}, {"path": "{here}/b/a.csv"}], "are both called 'a': give one"),
        ([{"name": "a"}], "recordings.0.path has to be given"),
        ([{"path": "a.csv", "read": {"raet": 60.0}}], "valid key is 'recordings.0.read.rate'"),
        ([{"path": "a.csv", "read": {"rate": -60.0}}], "recordings.0.read.rate = -60.0"),
        ([{"path": "a.csv", "card": {"alpha": "cvv"}}], "recordings.0.card.alpha = 'cvv'"),
        ([{"path": "a.csv", "read": {"markers": 3}}], "recordings.0.read.markers = 3"),
        (["a.csv"], "give a list of groups of keys"),
    ],
)  # fmt: skip
def test_a_list_that_cannot_be_used_is_one_sentence(tmp_path, entries, words):
    entries = [
        {k: v.format(here=tmp_path) if k == "path" else v for k, v in entry.items()}
        if isinstance(entry, dict) else entry
        for entry in entries
    ]  # fmt: skip
    with pytest.raises(ValueError) as caught:
        of(*entries)
    assert words in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("given", "name"), [("..", "-"), (".", "-"), ("../../x", "--..-x"), ("/", "-")]
)
def test_a_name_leads_to_no_other_folder(tmp_path, given, name):
    assert [*of({"path": str(tmp_path / "a.csv"), "name": given})] == [name]


def test_a_name_is_no_longer_than_that_of_a_folder_can_be(tmp_path):
    with pytest.raises(ValueError, match="is longer than the name of a folder can be"):
        of({"path": str(tmp_path / "a.csv"), "name": "é" * 121})


def test_a_recording_that_is_not_listed_is_refused():
    with pytest.raises(ValueError, match=r"there is no recording 'nope' in this config: it has 0$"):
        recorded([])["nope"]
