"""What becomes of random scenes: `python -m fiberweb.tools.random_scenes [HOW MANY]`.

Every field of `Scene`, of its network and of `plan` is drawn: near what the paper has, with some
fields far from it (a number of any magnitude), or with some that are no value at all. A scene has
to end `ok` with finite numbers, `unstable`, or refused with one sentence; whatever else it does,
a crash or more than `LIMIT` of CPU time, is a failure, which is printed with the scene's number.
What would take longer than `AFFORDABLE` is cut short. 10 000 take some 11 minutes of CPU time.
"""

from __future__ import annotations

import math
import multiprocessing
import os
import re
import signal
import sys
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import chain

import numpy as np

from fiberweb.engines import ENGINES
from fiberweb.model.network import crosshatch, polygon, web
from fiberweb.model.scene import SETUPS, Scene
from fiberweb.simulation import memory
from fiberweb.simulation.plan import ACCURACIES, Plan, Request, nanoseconds, plan, request
from fiberweb.simulation.simulate import run

KINDS = {"near": 0.5, "far": 0.35, "outside": 0.15}
ENDS = ("ok", "cut short and ok", "unstable", "refused", "too large to try", "FAILED")
SET = 0.4  # share of the fields that are not left at their default
AFFORDABLE, FEWEST = 0.02, 20  # s of kernel time, and steps that a run has at least
MOST_MEMORY = 1e9  # bytes that one scene may need here
LIMIT = 60  # s of CPU time, after which a scene counts as endless

Draw = Callable[[np.random.Generator], object]


def _about(low: float, high: float, share_of_zeros: float = 0.0, sign: bool = False) -> Draw:
    """Numbers whose logarithm is uniform."""

    def draw(rng):
        if rng.random() < share_of_zeros:
            return 0.0
        value = math.exp(rng.uniform(math.log(low), math.log(high)))
        return -value if sign and rng.random() < 0.5 else value

    return draw


def _one_of(*values) -> Draw:
    return lambda rng: values[rng.integers(len(values))]


def _lines(rng: np.random.Generator) -> list:
    """Fibres from side to side of a box, in both directions."""
    size, across, along = _about(0.05, 2.0)(rng), *rng.integers(1, 5, 2)
    fibres = [[[0.0, near], [size, far]] for near, far in size * rng.random((across, 2))]
    return fibres + [[[near, 0.0], [far, size]] for near, far in size * rng.random((along, 2))]


FIELDS: dict[str, Draw] = {
    "setup": _one_of(*SETUPS),
    "force": _about(1e-4, 10.0),
    "stroke": _about(1e-4, 0.05, sign=True),
    "lever": _about(0.01, 0.2),
    "tension": _about(1e-4, 10.0, 0.2),
    "duration": _about(0.1, 1000.0),
    "seed": lambda rng: int(rng.integers(2**32)),
    "sample_rate": _about(10.0, 2000.0),
    "drive_rate": _about(0.1, 100.0),
    "lowest_knot": _one_of(-1, 0),
    "diameter": _about(1e-4, 1e-2),
    "youngs_modulus": _about(1e5, 1e11),
    "density": _about(10.0, 1e4),
    "loss_factor": _about(1e-3, 10.0, 0.3),
    "loss_frequency": _about(0.1, 1000.0),
    "crossing_stiffness": lambda rng: math.inf if rng.random() < 0.3 else _about(1e-2, 1e7)(rng),
    "crossing_damping": _about(1e-3, 100.0, 0.3),
    "bond_stiffness": lambda rng: math.inf if rng.random() < 0.2 else _about(1e-6, 1.0, 0.3)(rng),
    "damping": _about(1e-2, 1e4, 0.2),
    "filter_order": lambda rng: int(rng.integers(7)),
    "dead_band": _one_of(True, False),
    "ends": _one_of("clamped", "sliding", "pinned", "sprung"),
    "end_stiffness": _about(1e-2, 1e5),
    "layout": _one_of("exact", "authors"),
    "tension_ramp": _about(1e-3, 10.0, 0.2),
    "disturbance": _about(1e-12, 1e-3, 0.5),
    "centre_lines": _one_of(True, False),
}
# what excludes other fields, or takes a certain engine
RARE = {"stroke", "lever", "ends", "end_stiffness", "layout", "filter_order", "dead_band"}
NUMERICS: dict[str, Draw] = {
    "accuracy": _one_of(*ACCURACIES),
    "engine": _one_of(*ENGINES),
    "elements_per_section": lambda rng: int(rng.integers(1, 17)),
    "time_step": _about(1e-7, 1e-3),
    "force_time_step": _one_of(True, False),
}
CROSSHATCH = {
    "n": lambda rng: int(rng.integers(2, 9)),
    "length": _about(0.05, 2.0),
    "spacing": _about(5e-3, 0.5),
}
POLYGON = {
    "n": _one_of(6, 8, 10),
    "diameter": _about(0.05, 2.0),
    "diagonals": _one_of("all", "skip-one"),
}
WEB = {
    "fibres": _lines,
    "driven_fibre": lambda rng: int(rng.integers(3)),
    "driven_distance": _about(0.01, 2.0),
}
NETWORKS = {crosshatch: (CROSSHATCH, 0.7), polygon: (POLYGON, 0.15), web: (WEB, 0.15)}
KNOWN = {"fibre", *FIELDS, *NUMERICS, *CROSSHATCH, *POLYGON, *WEB}
NAMES = re.compile(rf"\b({'|'.join(KNOWN)})\b")  # one of which a refusal has to name
FAR = _about(1e-300, 1e300, 0.05)
NOTHING = (math.nan, math.inf, -math.inf, -1, 0, 10**9, 10**30, 2.5, True, None, "4", "", [], [1.0])


def drawn(number: int) -> tuple[str, Callable[..., object], dict, dict, dict]:
    """The kind of a scene, what makes its network, and the arguments of that, of `Scene` and of
    `plan`, all by its number."""
    rng = np.random.default_rng(number)
    kind = rng.choice([*KINDS], p=[*KINDS.values()])
    make = [*NETWORKS][rng.choice(3, p=[share for _, share in NETWORKS.values()])]
    known, _ = NETWORKS[make]
    network = {name: draw(rng) for name, draw in known.items()}
    if make is crosshatch:
        network.pop("length" if rng.random() < 0.5 else "spacing")
    if make is web and rng.random() < 0.8:
        network.pop("driven_distance")
    share = {name: 0.05 if name in RARE else SET for name in FIELDS}
    fields = {name: draw(rng) for name, draw in FIELDS.items() if rng.random() < share[name]}
    if fields.get("ends") == "sprung":
        fields["end_stiffness"] = FIELDS["end_stiffness"](rng)
    if "stroke" in fields:
        fields.pop("force", None), fields.pop("disturbance", None)
    numerics = {name: draw(rng) for name, draw in NUMERICS.items() if rng.random() < 0.5}
    if fields.get("filter_order") or fields.get("dead_band"):
        numerics = {"engine": "cosserat"}
    if numerics.get("accuracy") and rng.random() < 0.9:
        numerics = {} if fields.get("setup") == "published" else {"accuracy": numerics["accuracy"]}
    if numerics.get("engine", "kirchhoff") != "kirchhoff" and rng.random() < 0.9:
        fields["crossing_stiffness"] = _about(1e-2, 1e7)(rng)
    if kind != "near":
        for _ in range(rng.integers(1, 4)):
            of, every = ((network, known), (fields, FIELDS), (numerics, NUMERICS))[
                rng.choice(3, p=[0.15, 0.7, 0.15])
            ]
            name = [*every][rng.integers(len(every))]
            if kind == "outside":
                of[name] = NOTHING[rng.integers(len(NOTHING))]
            elif name == "fibres":
                fibres = np.array(every[name](rng))
                fibres.flat[rng.integers(fibres.size)] = FAR(rng)
                of[name] = fibres.tolist()
            elif isinstance(every[name](rng), float):
                of[name] = FAR(rng)
    return str(kind), make, network, fields, numerics


def end_of(number: int) -> tuple[str, str]:
    """How a scene ends, of `ENDS`, and what is said of it."""
    _, make, network, fields, numerics = drawn(number)
    try:
        scene = Scene(make(**network), **fields)
        asked = request(scene, **numerics)
        if is_large := needed(scene, asked) > MOST_MEMORY:
            scene = replace(scene, duration=FEWEST / scene.sample_rate)
        if needed(scene, asked) > MOST_MEMORY:
            return "too large to try", ""
        planned, is_cut = affordable(plan(scene, **numerics))
        response = run(planned)
    except ValueError as error:
        sentence = str(error)
        whole = sentence.isprintable() and len(sentence) < 1000 and NAMES.search(sentence)
        return ("refused" if whole else "FAILED"), sentence
    except BaseException as error:
        return "FAILED", repr(error)[:300]
    if response.attrs["status"] == "unstable":
        return "unstable", ""
    if not all(np.isfinite(response[name]).all() for name in ("input", "displacement")):
        return "FAILED", "NaN and ok"
    return ("cut short and ok" if is_cut or is_large else "ok"), ""


def needed(scene: Scene, asked: Request) -> float:
    """Bytes of memory that a scene takes, about."""
    return sum(memory.needed(scene, asked.elements_per_section).values())


def affordable(planned: Plan) -> tuple[Plan, bool]:
    """A plan, of a shorter recording if need be, and whether that was so."""
    step = planned.numerics.time_step
    scene = planned.scene
    each = 1e-9 * nanoseconds(scene, planned.engine) * planned.mesh.elements
    length = step * max(FEWEST, AFFORDABLE / each)
    if scene.samples / scene.sample_rate <= length:
        return planned, False
    short = replace(scene, duration=length, sample_rate=max(scene.sample_rate, 4.0 / length))
    return replace(planned, mesh=replace(planned.mesh, scene=short), time_step=step), True


def _work(numbers: range, pipe) -> None:
    warnings.simplefilter("ignore")  # of numbers near the largest
    for number in numbers:
        signal.setitimer(signal.ITIMER_PROF, LIMIT)  # ends this process, kernels and all
        pipe.send((number, *end_of(number)))
    pipe.close()


def ends_of(numbers: range) -> Iterator[tuple[int, str, str]]:
    """Number, end and sentence of scenes, made in a process that may die of one."""
    while numbers:
        here, there = multiprocessing.Pipe(duplex=False)
        worker = multiprocessing.get_context("spawn").Process(target=_work, args=(numbers, there))
        worker.start()
        there.close()
        try:
            while True:
                found = here.recv()
                numbers = numbers[1:]
                yield found
        except EOFError:
            worker.join()
        if numbers:
            yield numbers[0], "FAILED", f"its process ended with {worker.exitcode}"
            numbers = numbers[1:]


def main(count: int) -> int:
    cores = os.cpu_count()
    strips = [range(first, count, cores) for first in range(cores)]
    with ThreadPoolExecutor(cores) as pool:
        found = [*chain(*pool.map(lambda strip: [*map(_told, ends_of(strip))], strips))]
    table = Counter((drawn(number)[0], end) for number, end, _ in found)
    print(f"| fields | {' | '.join(ENDS)} |\n|---|{'---|' * len(ENDS)}")
    for kind in KINDS:
        print(f"| {kind} | {' | '.join(str(table[kind, end]) for end in ENDS)} |")
    first = Counter(text.split()[0] for _, end, text in found if end == "refused")
    print("\nrefused for: " + ", ".join(f"{word} {times}" for word, times in first.most_common()))
    return sum(end == "FAILED" for _, end, _ in found)


def _told(found: tuple[int, str, str]) -> tuple[int, str, str]:
    if found[0] % 500 == 0:
        print(f"scene {found[0]}", file=sys.stderr, flush=True)
    if found[1] == "FAILED":
        print(f"scene {found[0]}: {found[2]}", flush=True)
    return found


if __name__ == "__main__":
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    sys.exit(min(1, main(int(sys.argv[1]) if sys.argv[1:] else 10_000)))
