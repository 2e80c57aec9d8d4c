"""The figure of a score card."""

import numpy as np
import pandas as pd
import pytest

from fiberweb.figures import card, style
from tests.figures.legible import assert_legible, assert_written, said

FACTS = {
    "run": "film", "frames": 3000, "rate_Hz": 60.0, "trained_s": 35.0, "tested_s": 12.5,
    "horizon_s": 1.0, "taps": 12, "taps_s": 0.2, "delay_step_s": 0.067, "functions": 41,
    "alpha": 0.01, "recipe": "phresco", "bar": 0.2,
}  # fmt: skip
COUNTS = [*card.COUNTS, "c_nl", "c_m", "ipc", "ipc_1", "ipc_2", "ipc_3"]


def made(tasks=(2, 5, 10), **facts):
    rng, rows = np.random.default_rng(0), []
    quantities = COUNTS + [f"narma{n}_{error}" for n in tasks for error in card.ERRORS]
    for readout in card.READOUTS:
        for quantity in quantities:
            value = rng.uniform(0.1, 0.9)
            rows.append({"readout": readout, "quantity": quantity, "value": value,
                         "low": 0.9 * value, "high": 1.1 * value})  # fmt: skip
    profile = pd.DataFrame({"readout": "body", "degree": [1, 1, 2, 3], "delay_s": [0, 0.1, 0.1, 0],
                            "capacity": [1.0, 0.5, 0.2, 0.1]})  # fmt: skip
    return {
        "status": "ok",
        "verdict": "The body computes nothing that its input, the powers and derivatives of it, or "
        "a delay line of 12 taps (400 ms) does not compute as well.",
        "notes": ["A note that is long enough to be a sentence, and says what it says."] * 4,
        "facts": FACTS | facts,
        "scores": rows, "profile": profile.to_dict("records"),
    }  # fmt: skip


@pytest.mark.parametrize(
    "given", [made(), made(tasks=(2, 5), bar=None), made(tasks=())], ids=["all", "two", "no task"]
)
def test_a_card_is_legible_and_defines_its_errors(given, unsaved):
    figure = card.draw(given, "card.png")
    assert_legible(figure)
    text = " ".join(said(figure).split())
    about = "film: 3000 frames at 60 Hz, trained on 35 s, tested on 12.5 s; recipe phresco"
    for words in (given["verdict"], about, "NMSE = NRMSE²", "kernel rank", "effective rank"):
        assert words in text


def test_a_recording_that_was_refused_has_its_sentence(tmp_path):
    with style.applied():
        figure = card.draw({"status": "refused", "verdict": "film.csv is empty", "notes": []},
                           tmp_path / "card.png")  # fmt: skip
    assert said(figure) == "film.csv is empty"
    assert_written(tmp_path / "card.png")


def test_dollars_in_the_name_of_a_file_are_no_formula(tmp_path):
    verdict = "cost $x^{ y$.csv is empty"
    card.draw({"status": "refused", "verdict": verdict, "notes": []}, tmp_path / "card.png")
    assert_written(tmp_path / "card.png")
    card.draw(made(run="cost $x^{ y$"), tmp_path / "card.png")
