"""The clock of a recording: its rate, an even one instead of its own, and what lies in gaps."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fiberweb.recordings.base import Finding, Raw, check_size
from fiberweb.recordings.options import TIME_UNITS, Reading

JITTER = 0.01  # of a frame: what is off by less counts as even, as scoring has it
AGREE = 0.02  # relative difference of two rates that are taken for the same
MISSING = 1.5  # frames: a longer step in time is a gap


def frames(raw: Raw, options: Reading, path: Path) -> tuple[np.ndarray, float, list[Finding]]:
    """When each frame was taken (T,), s from the first, and the rate (Hz).

    Frames that a file has in reverse, or twice, are put right in `raw`, and a finding says so.

    Raises:
        ValueError: no rate or a wrong one, or a time that is no clock; with column and row.
    """
    count, found = len(raw.positions), []
    stated = options.rate if options.rate is not None else raw.rate
    if stated is not None and not 0 < stated < np.inf:
        raise ValueError(f"{path}: rate = {stated:g} Hz: give the frames per second, above 0")
    if count < 2:
        raise ValueError(f"{path} has {count} frame: a recording needs some seconds")
    if raw.time is None:
        if stated is None:
            raise ValueError(f"{path} has no clock: state its frames per second, as in rate: 60.0")
        return np.arange(count) / stated, stated, found
    column = raw.columns.get("time", options.time or "time")
    time = raw.time
    if not np.isfinite(time).all():
        at = int(np.argmin(np.isfinite(time)))
        raise ValueError(f"{path}, column {column!r}, {raw.place(at)}: the time is missing")
    if (time[1:] < time[:-1]).all():
        raw.positions, raw.time = raw.positions[::-1], (time := time[::-1])
        raw.input = None if raw.input is None else raw.input[::-1]
        found.append(Finding("clock", "repair", "the clock ran backwards: rows were turned round"))
    step = np.diff(time)
    if (back := step < 0).any():
        at = int(np.argmax(back))
        raise ValueError(
            f"{path}, column {column!r}, {raw.place(at + 1)}: time falls from {time[at]:g} to "
            f"{time[at + 1]:g}, as where two takes were joined: split them, or name the column of "
            "the time"
        )
    if (again := step == 0).any():
        kept = np.concatenate([[True], ~again])
        raw.positions, time = raw.positions[kept], time[kept]
        raw.input = None if raw.input is None else raw.input[kept]
        found.append(
            Finding("clock", "repair", f"{again.sum()} frames of a time that was there were cut")
        )
        step = np.diff(time)
    if not len(step):
        raise ValueError(f"{path}, column {column!r}: the clock stands still at {time[0]:g}")
    usual = np.median(step)
    own = 1.0 / step[step < MISSING * usual].mean()  # in the file's own unit
    unit, more = _unit(own, stated, options.time_unit or raw.time_unit, column, path)
    own /= TIME_UNITS[unit]
    if stated is not None and abs(own / stated - 1.0) > AGREE:
        raise ValueError(
            f"{path}, column {column!r}: frames follow at {own:.4g} Hz, but rate = {stated:g} Hz: "
            "correct one of them"
        )
    return (time - time[0]) * TIME_UNITS[unit], own if stated is None else stated, found + more


def _unit(own, stated, unit, column, path) -> tuple[str, list[Finding]]:
    """The unit of a time whose frames follow at a rate, in frames a unit."""
    if unit is not None:
        return unit, []
    if stated is not None:
        for name, factor in TIME_UNITS.items():
            if name != "s" and abs(own / factor / stated - 1.0) < AGREE:
                sentence = f"time is in {name}, as the rate of {stated:g} Hz says"
                return name, [Finding("clock", "repair", sentence)]
        return "s", []
    if own < 1.0:
        raise ValueError(
            f"{path}, column {column!r} steps by {1 / own:.4g}: say time_unit: ms if this is "
            f"{1e3 * own:.4g} Hz, or time_unit: s if it is {own:.4g} Hz"
        )
    return "s", []


def even(
    raw: Raw, time: np.ndarray, rate: float, options: Reading, path: Path
) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[Finding]]:
    """Frames of an even clock, gaps filled by straight lines.

    Args:
        raw: positions (T, m, 2) and input (T,) or None; markers that are left out go out of it.
        time, rate: from `frames`.
        options: `max_gap` (s) and what a longer one means, `hidden`.

    Returns:
        Time (n,), s, positions (n, m, 2) and input (n,), all finite, and what was found.

    Raises:
        ValueError: a gap longer than that; names the marker and when.
    """
    allowed = options.max_gap + (1 + JITTER) / rate
    if (torn := np.diff(time)).max() > max(allowed, MISSING / rate):
        at = int(np.argmax(torn))
        raise ValueError(
            f"{path}: no frame from {time[at]:.4g} s to {time[at + 1]:.4g} s "
            f"({raw.place(at + 1)}), longer than max_gap = {options.max_gap:g} s: cut the file "
            "there, or raise max_gap"
        )
    jitter = _jitter(time, rate)
    found = [_clock_finding(len(time), time[-1], rate, jitter)]
    seen = _Seen(time, rate, allowed)
    kept = []
    for number, name in enumerate(raw.names):
        sentence = seen.gap(raw.positions[:, number].sum(axis=1), f"marker {name!r}", raw)
        if sentence is None:
            kept.append(number)
        elif options.hidden == "refuse":
            raise ValueError(
                f"{path}: {sentence}, longer than max_gap = {options.max_gap:g} s: raise it, or "
                "say hidden: leave out"
            )
        else:
            found.append(Finding("gaps", "warning", f"{sentence}, and was left out"))
    if not kept:
        raise ValueError(f"{path}: no marker is seen throughout; raise max_gap = {options.max_gap}")
    if raw.input is not None and (sentence := seen.gap(raw.input, "the input", raw)):
        raise ValueError(f"{path}: {sentence}, longer than max_gap = {options.max_gap:g} s")
    # where something is not seen yet or no more, there is nothing to draw a line to
    first, last = seen.first, seen.last
    if last <= first:
        raise ValueError(f"{path}: there are no two frames in which all is seen; raise max_gap")
    if first > 0 or last < len(time) - 1:
        cut = f"{first} frames at the start and {len(time) - 1 - last} at the end were cut"
        found.append(Finding("gaps", "repair", f"{cut}: not all was seen there yet, or any more"))
    start = time[first]
    count = np.floor((time[last] - start) * rate + JITTER) + 1
    check_size(path, count * (2 * len(kept) + 1))
    grid = np.arange(count := int(count)) / rate
    as_it_is = jitter <= JITTER and count == last - first + 1
    values = raw.positions[first : last + 1]
    drive = None if raw.input is None else raw.input[first : last + 1]
    raw.positions = raw.input = None  # of ten million frames, a second copy would not fit
    if len(kept) < len(raw.names):
        values, raw.names = values[:, kept], [raw.names[number] for number in kept]
    # in place where that is possible
    filled = values if count == len(values) else np.empty((count, *values.shape[1:]))
    clock = time[first : last + 1] - start
    for number in range(values.shape[1]):
        for axis in range(2):
            column = values[:, number, axis]
            filled[:, number, axis] = _filled(column, clock, grid, as_it_is)
    drive = None if drive is None else _filled(drive, clock, grid, as_it_is)
    found.append(_gap_finding(seen, len(time), count - (last - first + 1), as_it_is))
    return grid, filled, drive, found


class _Seen:
    """When signals are seen, over several of them: the longest gap, and where all have begun."""

    def __init__(self, time: np.ndarray, rate: float, allowed: float):
        self._time, self._rate, self._allowed = time, rate, allowed
        self.first, self.last, self.hidden, self.longest = 0, len(time) - 1, 0, 0.0

    def gap(self, values: np.ndarray, what: str, raw: Raw) -> str | None:
        """Why a signal has to be left out, or None; only those that stay count."""
        seen = np.isfinite(values)
        if seen.all():
            return None
        if not seen.any():
            return f"{what} is never seen"
        at = np.flatnonzero(seen)
        edges = self._time[at[0]] - self._time[0], self._time[-1] - self._time[at[-1]]
        steps = np.diff(self._time[at])
        inner = steps.max(initial=0.0)
        if max(*edges, inner) > self._allowed:
            if inner >= max(edges):
                worst = int(np.argmax(steps))
                start, end = at[worst] + 1, at[worst + 1] - 1
            else:
                start, end = (0, at[0] - 1) if edges[0] > edges[1] else (at[-1] + 1, len(seen) - 1)
            length = self._time[end] - self._time[start] + 1 / self._rate
            return (
                f"{what} is not seen from {self._time[start]:.4g} s to {self._time[end]:.4g} s "
                f"({raw.place(start)} on, {length:.3g} s)"
            )
        self.first, self.last = max(self.first, at[0]), min(self.last, at[-1])
        self.hidden += len(seen) - len(at)
        self.longest = max(self.longest, *edges, inner - 1 / self._rate)
        return None


def _filled(values, clock, grid, as_it_is) -> np.ndarray:
    """A signal on the grid, straight lines between the frames where it is seen."""
    seen = np.isfinite(values)
    if as_it_is and seen.all():
        return values
    return np.interp(grid, clock[seen], values[seen])


def _jitter(time: np.ndarray, rate: float) -> float:
    """Standard deviation of the frames from an even clock with the same gaps, in frames."""
    at = time * rate
    off = at - np.arange(len(at)) - np.cumsum(np.concatenate([[0], np.round(np.diff(at)) - 1]))
    return float(np.std(off - np.linspace(off[0], off[-1], len(off))))


def _clock_finding(count: int, length: float, rate: float, jitter: float) -> Finding:
    sentence = f"{count} frames in {length:.4g} s: {rate:.5g} Hz, jitter {jitter:.2g} of a frame"
    if jitter <= JITTER:
        return Finding("rate", "ok", sentence)
    return Finding("rate", "repair", f"{sentence}; resampled to an even clock by straight lines")


def _gap_finding(seen: _Seen, count: int, added: int, as_it_is: bool) -> Finding:
    parts = []
    if seen.hidden:
        parts.append(f"{seen.hidden} points not seen, the longest for {seen.longest:.3g} s")
    if added > 0:
        parts.append(f"{added} frames missing")
    if not parts:
        return Finding("gaps", "ok", "every signal is there in every frame")
    return Finding("gaps", "repair", f"{' and '.join(parts)}, filled by straight lines")
