"""Jobs and times out of the last lines of their logs."""

import pytest

from fiberweb import timed
from fiberweb.tools import stages


def _log(folder, name, text):
    path = folder / "logs" / f"{name}.log"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"{text}, at most 80 MB\n")


def test_each_folder_is_a_stage_and_the_last_row_has_all(tmp_path):
    _log(
        tmp_path,
        "simulate/a",
        "run a\ntook start 0.500 s, kernel 4.000 s, rest 0.250 s",
    )
    _log(tmp_path, "simulate/b", "took kernel 1.000 s, rest 0.250 s")
    _log(tmp_path, "snakemake", "took rest 5.000 s")
    _log(tmp_path, "figures/killed", "no such last line")
    table = stages.stages(tmp_path)
    assert list(table.index) == ["simulate", "snakemake", "all"]
    assert table.loc["simulate", ["jobs", "start", "kernel", "rest"]].tolist() == [2, 0.5, 5.0, 0.5]
    assert table.loc["all", ["jobs", "all"]].tolist() == [3, 11.0]
    assert table["longest"].tolist() == [4.75, 5.0, 5.0]
    assert set(table["MB"]) == {80.0}


def test_the_share_that_is_not_physics_is_printed(tmp_path, monkeypatch, capsys):
    _log(tmp_path, "capacity/a", "took start 1.000 s, solve 3.000 s, rest 0.000 s")
    monkeypatch.setattr("sys.argv", ["stages", str(tmp_path)])
    stages.main()
    assert capsys.readouterr().out.endswith("neither kernel nor solve: 25.0% of the CPU time\n")


def test_a_folder_without_logs_is_one_sentence(tmp_path):
    with pytest.raises(ValueError, match="holds no log of a job: run the workflow first"):
        stages.stages(tmp_path)


def test_a_line_is_read_as_it_is_written_and_parts_add_up(monkeypatch):
    monkeypatch.setattr(timed, "spent", {})
    for _ in range(2):
        with timed.part("kernel"):
            sum(range(200_000))
    with pytest.raises(KeyError), timed.part("write"):
        raise KeyError
    parts = timed.read(f"run x\n{timed.line()}\n")
    assert list(parts) == ["kernel", "write", "rest"]
    assert parts["kernel"] == pytest.approx(timed.spent["kernel"], abs=1e-3) and parts["kernel"] > 0
