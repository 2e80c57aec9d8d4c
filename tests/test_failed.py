"""What is said of a job that failed, by what its log ends in."""

import pytest

from fiberweb import failed

TOOK = "took rest 0.1 s, at most 9 MB\n"
TRACE = "capacity: scores\nTraceback (most recent call last):\n  File ...\n"


@pytest.mark.parametrize(
    ("log", "reason", "remedy"),
    [
        (f"{TRACE}ValueError: alpha = 0: give more.\n{TOOK}", "alpha = 0: give more.", "change"),
        (f"{TRACE}OSError: [Errno 28] No space left on device: 'x'\nwrote a, 3 bytes\n{TOOK}",
         "No space left on device: 'x'.", "free some space"),
        (f"{TRACE}ValueError: a/response.nc cannot be read (HDF error): .\n{TOOK}",
         "a/response.nc cannot be read", "make resume"),
        (f"{TRACE}numpy.MemoryError: 9 GB\n{TOOK}", "numpy.MemoryError: 9 GB.", "fewer --cores"),
        (f"{TRACE}KeyError: 'x'\n{TOOK}", "KeyError: 'x'.", "please report it"),
        ("capacity: scores\nrun: web\n", "its log has no end: it was killed", "take fewer --cores"),
        (None, "it left no log.", "please report it"),
    ],
)  # fmt: skip
def test_run_key_reason_log_and_remedy_on_one_line(tmp_path, log, reason, remedy):
    path = tmp_path / "web.log"
    if log is not None:
        path.write_text(log)
    line = failed.line("capacity", {"run": "web-n03", "suffix": ""}, path, "webs")
    assert line.startswith("capacity web-n03, which webs asks for, failed: ")
    assert reason in line and remedy in line.split(f"Log: {path}. What to do: ")[1]
    assert "\n" not in line


def test_of_many_the_first_are_told(tmp_path, capsys):
    class Job:
        rule = type("Rule", (), {"name": "table"})
        wildcards_dict, log = {"setup": "described"}, [tmp_path / "gone.log"]

    failed.tell([Job()] * 7, {})
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == failed.SHOWN + 1 and lines[0] == "7 jobs failed, of which 5:"
    assert lines[-1].startswith("table described failed: it left no log.")
