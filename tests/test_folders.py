"""A folder is what its name means, or it is refused in one sentence."""

import datetime
from pathlib import Path

import pytest

from fiberweb import folders
from fiberweb.config import check_folders, load


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("out/", "out"), ("./out", "out"), ("out//a/./b", "out/a/b"), ("my out", "my out"),
        ("~/out", "/home/me/out"), ("$PLACE/out", "/scratch/out"), ("./1e3", "1e3"),
        ("./2024-01-01", "2024-01-01"), ("/abs/out/", "/abs/out"),
    ],
)  # fmt: skip
def test_what_is_meant(monkeypatch, written, meant):
    monkeypatch.setenv("HOME", "/home/me")
    monkeypatch.setenv("PLACE", "/scratch")
    config = load({"results": written, "published_tables": written})
    assert (config.results, config.published_tables) == (meant, meant)


def test_this_folder_has_a_name():
    assert load({"results": "."}).results == str(Path.cwd())


@pytest.mark.parametrize(
    ("written", "words"),
    [
        ("o{u}t", "'{' stands"), ("<out>", "'<' stands"), ("out*", "'*' stands"),
        (datetime.date(2024, 1, 1), "2024-01-01: that was read as a date"), (1e3, "a float"),
        (750, "a int"), (True, "a bool"), ("$NO_SUCH_PLACE/out", "spell it out"),
        ("~no-such-user/out", "spell it out"), ("/", "the whole disk"), ("//", "the whole disk"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("key", ["results", "published_tables"])
def test_what_is_refused(key, written, words):
    with pytest.raises(ValueError) as caught:
        load({key: written})
    text = str(caught.value)
    assert text.startswith(f"{key} = ") and words in text
    assert "\n" not in text and ". " not in text


def test_results_need_a_folder():
    with pytest.raises(ValueError, match=r"results = .*at least 1 character"):
        load({"results": ""})
    assert load({"published_tables": ""}).published_tables == ""


@pytest.mark.parametrize("leads", ["gone", "out"])  # nowhere, and to itself
@pytest.mark.parametrize("within", ["", "deeper"])
def test_a_link_that_leads_nowhere(tmp_path, leads, within):
    link = tmp_path / "out"
    link.symlink_to(tmp_path / leads)
    with pytest.raises(ValueError, match=f"cannot be written .the link {link} leads nowhere"):
        check_folders(load({"results": str(link / within)}))
    (tmp_path / "gone").mkdir()
    link.unlink()
    link.symlink_to(tmp_path / "gone")
    check_folders(load({"results": str(link / within)}))


@pytest.mark.parametrize("path", ["disk/out", "me/disk/out", "disk"])
def test_a_disk_that_is_not_mounted(monkeypatch, tmp_path, path):
    monkeypatch.setattr(folders, "MOUNTS", (tmp_path,))
    monkeypatch.setenv("USER", "me")
    (tmp_path / "me").mkdir()
    results = tmp_path / path
    with pytest.raises(ValueError, match=f"mount .*{path.removesuffix('/out')}, or name") as caught:
        check_folders(load({"results": str(results)}))
    assert str(caught.value).startswith(f"results = {str(results)!r} is on a disk that is not")
    results.mkdir(parents=True)
    check_folders(load({"results": str(results)}))


def test_a_listed_disk_that_is_not_mounted(monkeypatch, tmp_path):
    listed = tmp_path / "fstab"
    listed.write_text(f"# disks\nUUID=1 / ext4\nUUID=2 {tmp_path}/my\\040disk ext4 defaults\n")
    monkeypatch.setattr(folders, "TABLE_OF_DISKS", listed)
    (tmp_path / "my disk").mkdir()  # where it would be
    assert folders.missing_disk(tmp_path / "my disk" / "out") == tmp_path / "my disk"
    assert folders.missing_disk(tmp_path / "other" / "out") is None
