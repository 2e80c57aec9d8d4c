"""Jobs and times out of Snakemake's benchmark files."""

import pytest

from fiberweb.tools.stages import stages

HEADER = "s\th:m:s\tmax_rss\n"


def test_each_folder_is_a_stage_and_the_last_row_has_all(tmp_path):
    for name, wall in (("simulate/a", 4), ("simulate/b", 2), ("warmup", 5)):
        path = tmp_path / "benchmarks" / f"{name}.tsv"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(HEADER + f"{wall}\t0:00:0{wall}\t-\n")
    table = stages(tmp_path)
    assert list(table.index) == ["simulate", "warmup", "all"]
    assert table.loc["simulate"].tolist() == [2, 6.0]
    assert table.loc["all"].tolist() == [3, 11.0]


def test_a_folder_without_benchmarks_is_one_sentence(tmp_path):
    with pytest.raises(ValueError, match="holds no benchmark: run the workflow first"):
        stages(tmp_path)
