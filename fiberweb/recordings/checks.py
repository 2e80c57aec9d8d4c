"""What a look at a recording finds: markers that stand still, are there twice or change places,
jumps, drift, clipping, and the lag between input and markers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy import signal

from fiberweb.recordings.base import Finding

JUMP = 8.0  # times the 99th percentile of a marker's steps
DRIFT = 2.0  # standard deviations between the means of the first and the last tenth
CLIPPED = 0.01  # share of frames at an extreme
LEVELS = 20  # an input of fewer distinct values is one of steps, and no clipped one
LONGEST = 200_000  # frames that the lag is looked for in
LAG = 1.0  # s, the longest lag that is looked for
UNRELATED = 0.1  # correlation of input and markers below which there is no lag to tell
HIDDEN = 100  # frames, for no longer than which markers may exchange their names unseen
SHOWN = 5  # of a kind of finding, before they are only counted


def exchanges(positions: np.ndarray, names: list[str], time: np.ndarray) -> list[Finding]:
    """Markers that take each other's place, from one frame to the next or while they were not seen,
    changed back in place.

    A pair is taken for exchanged where both jump, and each lands no further from where the other
    was than ordinary steps, and far closer there than to where it was itself. positions: (T, m, 2),
    NaN where a marker is not seen; time: (T,), s.
    """
    limits, jumped = _jumping(positions)
    found, unclear = [], []
    for frame in sorted(jumped):
        hidden = np.flatnonzero(np.isnan(positions[frame, :, 0])).tolist()
        left, alone = list(jumped[frame]), 0
        while left:
            a = left.pop(0)
            of_a = (b for b in left + hidden if _changed(positions, frame, a, b, limits))
            if (b := next(of_a, None)) is None:
                alone += 1
                continue
            positions[frame:, [a, b]] = positions[frame:, [b, a]]
            left = [number for number in left if number != b]
            sentence = (
                f"markers {names[a]!r} and {names[b]!r} change places at {time[frame]:.4g} s and "
                "were changed back"
            )
            found.append(Finding("exchanged", "repair", sentence))
        if alone > 2:
            unclear.append(f"{alone} markers jump at once at {time[frame]:.4g} s")
    if unclear:
        sentence = f"{unclear[0]}, where names may be exchanged, and were left as they are"
        more = f" (and at {len(unclear) - 1} other times)" if len(unclear) > 1 else ""
        found.append(Finding("exchanged", "warning", sentence + more))
    return found or [Finding("exchanged", "ok", "no two markers were seen to change places")]


def _jumping(positions: np.ndarray) -> tuple[np.ndarray, dict[int, list[int]]]:
    """The larger steps of each marker, (m,), and the markers that jump in a frame, by frame."""
    limits, jumped = np.zeros(positions.shape[1]), {}
    for number in range(len(limits)):
        seen = np.flatnonzero(np.isfinite(positions[:, number]).all(axis=1))
        steps = np.hypot(*np.diff(positions[seen, number], axis=0).T)
        if len(steps):
            limits[number] = np.quantile(steps, 0.99)
        for frame in seen[1:][steps > JUMP * limits[number]][:1000]:
            jumped.setdefault(int(frame), []).append(number)
    return limits, jumped


def _changed(positions: np.ndarray, frame: int, a: int, b: int, limits: np.ndarray) -> bool:
    """Whether a, seen at a frame, and b, from when it is next seen, are where the other was."""
    before = positions[max(frame - HIDDEN, 0) : frame][::-1]
    (gap_a, was_a), (gap_b, was_b) = (_first(before[:, number]) for number in (a, b))
    after, is_b = _first(positions[frame : frame + HIDDEN, b])
    is_a = positions[frame, a]
    hidden = 1 + max(gap_a, gap_b) + after
    crossed = max(np.hypot(*(is_a - was_b)), np.hypot(*(is_b - was_a)))
    stayed = min(np.hypot(*(is_a - was_a)), np.hypot(*(is_b - was_b)))
    return crossed <= min(2.0 * max(limits[a], limits[b]) * hidden, stayed / 2.0)


def _first(values: np.ndarray) -> tuple[int, np.ndarray]:
    """The first frame in which a marker is seen, and its place there, NaN if it is in none; values:
    (n, 2)."""
    at = int(np.argmax(np.isfinite(values).all(axis=1)))
    return at, values[at]


def look(moved: np.ndarray, u: np.ndarray, names: list[str], rate: float) -> list[Finding]:
    """The findings of an even recording.

    Args:
        moved: (T, m, 2) displacements.
        u: (T,) the input.
        names: of the m markers.
        rate: Hz.
    """
    return [
        *_some("constant", _still(moved, names), "every marker moves"),
        *_some("duplicated", _twice(moved, names), "no marker is there twice"),
        *_some("jumps", _jumps(moved, u, names, rate), "no signal jumps"),
        *_some("drift", _drifts(moved, u, names), "no signal drifts"),
        *_some("clipping", _clipped(moved, u, names), "no signal stays at an extreme"),
        _lag(moved, u, rate),
    ]


def _some(name: str, sentences: Iterator[str], fine: str) -> list[Finding]:
    found = list(sentences)
    if not found:
        return [Finding(name, "ok", fine)]
    shown = [Finding(name, "warning", sentence) for sentence in found[:SHOWN]]
    more = len(found) - SHOWN
    return shown + ([Finding(name, "warning", f"and {more} more")] if more > 0 else [])


def _still(moved, names) -> Iterator[str]:
    for number, name in enumerate(names):
        if not np.ptp(moved[:, number], axis=0).any():
            yield f"marker {name!r} does not move"


def _twice(moved, names) -> Iterator[str]:
    first: dict[int, int] = {}
    for number, name in enumerate(names):
        column = np.ascontiguousarray(moved[:, number])
        other = first.setdefault(hash(column.tobytes()), number)
        if other != number and column.any():
            yield f"markers {names[other]!r} and {name!r} are the same"


def _signals(moved, u, names) -> Iterator[tuple[str, np.ndarray]]:
    yield "the input", u
    for number, name in enumerate(names):
        for axis, letter in enumerate("xy"):
            yield f"{name}.{letter}", moved[:, number, axis]


def _jumps(moved, u, names, rate) -> Iterator[str]:
    for name, values in _signals(moved, u, names):
        steps = np.abs(np.diff(values))
        usual = np.quantile(steps, 0.99)
        at = int(np.argmax(steps))
        if usual > 0 and steps[at] > JUMP * usual:
            yield (
                f"{name} jumps by {steps[at]:.3g} at {(at + 1) / rate:.4g} s, "
                f"{steps[at] / usual:.0f} times its larger steps"
            )


def _drifts(moved, u, names) -> Iterator[str]:
    tenth = max(1, len(u) // 10)
    for name, values in _signals(moved, u, names):
        spread = max(values[:tenth].std(), values[-tenth:].std())
        off = values[-tenth:].mean() - values[:tenth].mean()
        if abs(off) > DRIFT * spread > 0:
            yield f"{name} drifts by {off:.3g}, {abs(off) / spread:.1f} standard deviations"


def _clipped(moved, u, names) -> Iterator[str]:
    for name, values in _signals(moved, u, names):
        for end, what in ((values.max(), "greatest"), (values.min(), "least")):
            at = values == end
            held = (at[1:] & at[:-1]).mean()
            if CLIPPED < held < 1 and len(np.unique(values[:LONGEST])) > LEVELS:
                yield f"{name} stays at its {what} value in {at.mean():.0%} of the frames"


def _lag(moved, u, rate) -> Finding:
    """How far the markers follow the input, where their cross-correlation is greatest."""
    u = u[-LONGEST:]
    reach = min(round(LAG * rate), len(u) // 4)
    total, counted = np.zeros(2 * reach + 1), 0
    drive = signal.detrend(u)
    for number in range(moved.shape[1]):
        for axis in range(2):
            motion = signal.detrend(moved[-LONGEST:, number, axis])
            if not (spread := drive.std() * motion.std() * len(u)):
                continue
            across = signal.correlate(motion, drive, "full", "fft") / spread
            total += across[len(u) - 1 - reach : len(u) + reach] ** 2
            counted += 1
    correlation = np.sqrt(total.max() / max(counted, 1))
    if correlation < UNRELATED:
        sentence = f"input and markers correlate by {correlation:.2g} at most: no lag to tell"
        return Finding("lag", "ok", sentence)
    lag = int(np.argmax(total)) - reach
    sentence = (
        f"the markers follow the input by {lag} frames ({1e3 * lag / rate:.3g} ms), where their "
        "correlation is greatest"
    )
    if lag >= 0:
        return Finding("lag", "ok", sentence)
    return Finding(
        "lag", "warning",
        f"the markers are {-lag} frames ({-1e3 * lag / rate:.3g} ms) ahead of the input, where "
        "their correlation is greatest: its clock may be late by as much",
    )  # fmt: skip
