"""Recordings made up for the tests, and files of every format that hold one."""

import numpy as np
import pandas as pd

RATE = 50.0


def body(frames=400, markers=3, seed=0):
    """(time, input, positions (T, m, 2) in px) of markers that follow a random input."""
    rng = np.random.default_rng(seed)
    u = rng.uniform(-1.0, 1.0, frames)
    positions = np.empty((frames, markers, 2))
    for number in range(markers):
        for axis in range(2):
            # a body follows: it is nowhere at once
            push = np.convolve(u, np.exp(-np.arange(8) / (1 + number)))[:frames]
            noise = 0.05 * rng.standard_normal(frames)
            positions[:, number, axis] = 100 * (number + 1) + 10 * axis + 3 * push + noise
    return np.arange(frames) / RATE, u, positions


def names(markers):
    return [chr(ord("a") + number) for number in range(markers)]


def frame(time, u, positions):
    """The wide table of a recording."""
    columns = {"time": time, "input": u}
    for number, name in enumerate(names(positions.shape[1])):
        columns |= {f"{name}_x": positions[:, number, 0], f"{name}_y": positions[:, number, 1]}
    return pd.DataFrame(columns)


def wide(path, time, u, positions, **options):
    frame(time, u, positions).to_csv(path, index=False, **options)
    return path


def deeplabcut(path, u, positions, likelihood):
    """The driven point is the first part, `motor`, and moves in x."""
    parts = ["motor", *names(positions.shape[1])]
    rows = [["scorer"] + ["net"] * 3 * len(parts), ["bodyparts"], ["coords"]]
    for part in parts:
        rows[1] += [part] * 3
        rows[2] += ["x", "y", "likelihood"]
    for at in range(len(u)):
        row = [at, u[at], 0.0, 1.0]
        for number in range(positions.shape[1]):
            row += [*positions[at, number], likelihood[at, number]]
        rows.append(row)
    path.write_text("\n".join(",".join(map(str, row)) for row in rows) + "\n")
    return path


def trackpy(path, u, positions):
    """Particle 0 is the driven one and moves in x; points come in trackpy's order, by frame."""
    rows = []
    for at in range(len(u)):
        points = [(u[at], 0.0), *positions[at]]
        rows += [
            {"y": y, "x": x, "mass": 1.0, "frame": at, "particle": number}
            for number, (x, y) in enumerate(points)
            if np.isfinite(x)
        ]
    pd.DataFrame(rows).to_csv(path)
    return path


def motive(path, time, u, positions, first=(), blank=True):
    """A rigid body, its marker, the markers; the motor moves in X; lengths in millimetres."""
    marks = ["motor", *names(positions.shape[1])]
    facts = {"Format Version": "1.23", "Take Name": "take", "Length Units": "Millimeters"}
    facts |= dict(first)
    heads = [
        ["", "Type"] + ["Rigid Body"] * 7 + ["Marker"] * 3 * len(marks),
        ["", "Name"] + ["body"] * 7 + [name for name in marks for _ in range(3)],
        ["", "ID"] + ["1"] * (7 + 3 * len(marks)),
        ["", ""] + ["Rotation"] * 4 + ["Position"] * (3 + 3 * len(marks)),
        ["Frame", "Time (Seconds)", *"XYZW", *"XYZ", *("XYZ" * len(marks))],
    ]
    rows = [[f"{key},{value}" for key, value in facts.items()], *([[]] if blank else []), *heads]
    for at in range(len(time)):
        row = [at, f"{time[at]:.6f}", *[0.1] * 7, u[at], 0.0, 1.0]
        for x, z in positions[at]:
            row += [x, 5.0, z] if np.isfinite(x) else ["", "", ""]
        rows.append(row)
    path.write_text("\n".join(",".join(map(str, row)) for row in rows) + "\n")
    return path
