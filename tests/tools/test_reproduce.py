"""A run is repeated from its own file alone, to the last bit; what differs is named."""

import re

import pytest

from fiberweb import Scene, crosshatch, score, simulate
from fiberweb.simulation import dataset
from fiberweb.tools import reproduce

WEB = crosshatch(2, length=0.3)
KINDS = {
    "described": (Scene(WEB, duration=5.0, seed=7), {"accuracy": "draft"}, {"alpha": 0.1}),
    "own numerics": (
        Scene(WEB, duration=5.0), {"elements_per_section": 3, "time_step": 1e-4}, {"skip": 50}
    ),
    "compliant": (
        Scene(WEB, "compliant", duration=5.0, centre_lines=True), {"accuracy": "draft"}, {}
    ),
    "twin": (
        Scene(WEB, duration=5.0, stroke=0.005, ends="sprung", end_stiffness=100.0),
        {"accuracy": "draft"}, {"scoring": "published", "shuffle": True, "overshoot": (1.1, 1.2)},
    ),
    "published": (Scene(WEB, "published", duration=0.02), {}, None),
    "unstable": (
        Scene(WEB, duration=5.0, force=5.0), {"elements_per_section": 2, "time_step": 5e-4,
                                              "force_time_step": True}, {},
    ),
}  # fmt: skip


@pytest.fixture
def run(tmp_path):
    """Leaves a run as the workflow does, and gives its folder."""

    def leave(kind):
        scene, numerics, scoring = KINDS[kind]
        response = simulate(scene, **numerics)
        response.attrs["run"] = kind
        dataset.save(response, tmp_path / "runs" / kind / "response.nc")
        if scoring is not None:
            with reproduce.threadpool_limits(1):
                kept = score(dataset.load(tmp_path / "runs" / kind / "response.nc"), **scoring)
            dataset.save(kept, tmp_path / "runs" / kind / "capacity.nc")
        return tmp_path / "runs" / kind

    return leave


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_is_repeated_to_the_last_bit(run, kind, capsys):
    folder = run(kind)
    assert reproduce.reproduce(folder / "response.nc")
    printed = capsys.readouterr().out
    scored = KINDS[kind][2] is not None
    assert printed.count("every value has the same bits") == 1 + scored
    assert "no surprise" not in printed
    assert dataset.load(folder / "response.nc").attrs["status"] == (
        "unstable" if kind == "unstable" else "ok"
    )


def test_what_differs_is_named_with_its_size_and_its_likely_cause(run, capsys):
    path = run("described") / "response.nc"
    kept = dataset.load(path)
    kept["displacement"][100, 3, 0] += 1e-3
    kept.attrs |= {"engine_source": "0123456789ab", "versions": "numba 0.1"}
    dataset.save(kept, path)
    assert not reproduce.reproduce(path)
    printed = capsys.readouterr().out
    assert re.search(r"displacement: \d+\.\d% of its values differ, by 0\.001 at most", printed)
    assert "engine_source was 0123456789ab, and is" in printed
    assert "versions was numba 0.1, and is" in printed


def test_a_run_is_found_by_name_folder_or_file(run, tmp_path):
    folder = run("published")
    (folder / "capacity.nc").touch()
    for asked in ("published", folder, folder / "response.nc", folder / "capacity.nc"):
        found = reproduce.response_of(str(asked), tmp_path)
        assert found == folder / "response.nc"
    with pytest.raises(ValueError, match="'nothing' is no file, no folder with a"):
        reproduce.response_of("nothing", tmp_path)


def test_a_recording_is_refused(run, tmp_path):
    path = run("published") / "response.nc"
    kept = dataset.load(path)
    del kept.attrs["scene"]
    dataset.save(kept, path)
    with pytest.raises(
        ValueError, match=r"response\.nc has no attribute 'scene': it is no file of"
    ):
        reproduce.reproduce(path)


SCENE, SECTIONS = "its attribute scene cannot be", "its attribute elements_per_section cannot be"
DAMAGED = [
    ("response", {"scene": "[1,2]"}, f"{SCENE} read: '.1,2.' is no scene"),
    ("response", {"scene": '{"a":'}, SCENE), ("response", {"scene": 5}, SCENE),
    ("response", {"elements_per_section": "many"}, f"{SECTIONS} read: .*'many'"),
    ("response", {"elements_per_section": [1, 2]}, SECTIONS),
    ("response", {"engine": "nope"}, "engine = 'nope'"),
    ("capacity", {"alpha": None}, "has no attribute 'alpha'"),
    ("capacity", {"overshoot": 1.0}, "its attribute overshoot cannot be read"),
    ("capacity", {"split": 7.0}, "split = 7"),
]  # fmt: skip


def test_damaged_attributes_are_named_with_their_file(run):
    folder = run("described")
    kept = {name: dataset.load(folder / f"{name}.nc") for name in ("response", "capacity")}
    for name, damaged, said in DAMAGED:
        broken = kept[name].copy()
        broken.attrs = {k: v for k, v in (broken.attrs | damaged).items() if v is not None}
        with pytest.raises(ValueError, match=f"^{name}.nc:? {said}"):
            if name == "response":
                reproduce.repeated(broken, f"{name}.nc")
            else:
                reproduce.scored(kept["response"], broken, f"{name}.nc")


@pytest.mark.parametrize(
    ("asked", "code"),
    [
        (["published"], 0),
        (["nothing"], "no file"),
        (["x" * 5000], "no file"),
        ([], "RUN is missing"),
    ],
)
def test_the_command_ends_with_what_came_out(run, tmp_path, monkeypatch, asked, code):
    run("published")
    monkeypatch.setattr("sys.argv", ["reproduce", *asked, *[str(tmp_path)] * bool(asked)])
    with pytest.raises(SystemExit) as ended:
        reproduce.main()
    assert ended.value.code == code or code in ended.value.code
