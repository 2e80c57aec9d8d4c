"""The target `recordings`, on the example and on files that cannot be used."""

import json
import os
import subprocess
import sys

import pandas as pd
import pytest
import yaml

from fiberweb import origin
from tests.workflow.conftest import ROOT
from tests.workflow.explained import compared

EXAMPLE = ROOT / "examples" / "recordings"


def test_broken_recordings_are_refused_and_the_others_are_scored(tmp_path):
    config = yaml.safe_load((EXAMPLE / "config.yaml").read_text())
    folder = ROOT / config["recordings"][0]["path"]
    (tmp_path / "text.csv").write_text("time,input,a_x,a_y\n0,1,2,3\n0.1,x,2,3\n")
    config["recordings"] = [
        config["recordings"][0] | {"path": str(folder / "take1.csv")},
        {"path": str(tmp_path / "gone.csv")}, {"path": str(tmp_path / "text.csv")},
    ]  # fmt: skip
    config["results"] = str(tmp_path / "out")
    (tmp_path / "my.yaml").write_text(yaml.safe_dump(config))
    call = [sys.executable, "-m", "snakemake", "recordings", "--configfile", tmp_path / "my.yaml"]
    given = {
        "args": [*call, "--cores", "2", "--directory", tmp_path, "-s", ROOT / "Snakefile"],
        "env": os.environ | {"PYTHONPATH": str(ROOT)},
        "cwd": ROOT, "capture_output": True, "text": True,
    }  # fmt: skip
    done = subprocess.run(**given)
    assert done.returncode == 0, done.stdout + done.stderr
    out = tmp_path / "out" / "recordings"
    card = json.loads((out / "take1" / "card.json").read_text())
    assert card["status"] == "ok" and "the body computes" in card["verdict"].lower()
    table = pd.read_csv(out / "take1" / "card.csv").set_index(["readout", "quantity"])
    assert 0 < table.loc[("body", "ipc"), "value"] < table.loc[("body", "n_signals"), "value"] == 12
    assert set(pd.read_csv(out / "take1" / "sanity.csv")["severity"]) == {"ok"}
    for name, words in {
        "gone": "gone.csv cannot be read (No such file or directory)",
        "text": "text.csv, column 'input', row 3: 'x' is no number",
    }.items():
        refused = json.loads((out / name / "card.json").read_text())
        assert refused["status"] == "refused" and words in refused["verdict"]
        (finding,) = pd.read_csv(out / name / "sanity.csv").to_dict("records")
        assert finding["severity"] == "refused" and words in finding["sentence"]
        assert (out / name / "card.png").exists() and (out / name / "card.csv").exists()
    # card.json and card.csv, recording.nc and sanity.csv; what tables rest on; two of the call
    assert len(compared(out.parent)) == 7
    for table in ("recording.nc", "sanity.csv", "card.csv"):
        assert origin.beside(out / "take1" / table).exists()
    whole = (out / "take1" / "recording.nc").read_bytes()
    (out / "take1" / "recording.nc").write_bytes(whole[:-1])
    again = subprocess.run(**given)
    assert again.returncode == 0 and "it is made again with what rests on it" in again.stderr
    assert (out / "take1" / "recording.nc").read_bytes() == whole


@pytest.mark.slow
def test_the_example_is_what_its_script_makes(tmp_path):
    script = (EXAMPLE / "make.py").read_text()
    (tmp_path / "make.py").write_text(script)
    (tmp_path / "takes").mkdir()
    subprocess.run([sys.executable, tmp_path / "make.py"], cwd=ROOT, check=True,
                   env=os.environ | {"PYTHONPATH": str(ROOT)})  # fmt: skip
    for path in (EXAMPLE / "takes").glob("*.csv"):
        # a digit more or less where another machine sums in another order
        again = pd.read_csv(tmp_path / "takes" / path.name)
        pd.testing.assert_frame_equal(again, pd.read_csv(path), rtol=0, atol=2e-3)
