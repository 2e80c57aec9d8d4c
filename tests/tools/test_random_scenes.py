"""Random scenes end as scenes may; the tool draws every field, and sees what goes wrong."""

import inspect
from dataclasses import fields

import pytest

from fiberweb.model.scene import Scene
from fiberweb.simulation.plan import plan
from fiberweb.tools import random_scenes
from fiberweb.tools.random_scenes import drawn, end_of, ends_of


def test_every_field_is_drawn():
    assert set(random_scenes.FIELDS) == {field.name for field in fields(Scene)} - {"network"}
    assert set(random_scenes.NUMERICS) == set(inspect.signature(plan).parameters) - {"scene"}


def test_scenes_end_as_they_may():
    found = {number: end_of(number) for number in range(25)}
    assert not {number: end for number, end in found.items() if end[0] == "FAILED"}
    assert {"refused", "cut short and ok"} <= {end for end, _ in found.values()}
    assert drawn(7) == drawn(7)


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        (OverflowError(34, "too large"), "OverflowError"),
        (ValueError("`dydx` must contain only finite values."), "dydx"),
        (ValueError("force = 1\nand so on"), "force"),
    ],
)
def test_what_is_no_sentence_fails(monkeypatch, fault, words):
    def raises(*_, **__):
        raise fault

    monkeypatch.setattr(random_scenes, "Scene", raises)
    end, sentence = end_of(2)
    assert end == "FAILED" and words in sentence


@pytest.mark.slow
def test_a_scene_that_kills_its_process_is_known_by_its_number(monkeypatch):
    """The first is refused at once; the limit of time ends the second."""
    monkeypatch.setattr(random_scenes, "_work", _dies_of_one)
    assert [*ends_of(range(3))] == [
        (0, "ok", ""), (1, "FAILED", "its process ended with -27"), (2, "ok", ""),
    ]  # fmt: skip


def _dies_of_one(numbers, pipe):
    import signal

    for number in numbers:
        if number == 1:
            signal.setitimer(signal.ITIMER_PROF, 0.01)
            while True:
                pass
        pipe.send((number, "ok", ""))
