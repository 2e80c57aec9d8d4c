"""trackpy's CSV: a row a point, with x, y, frame and particle. It has no clock, so the rate is
stated; particles come and go, so that most recordings need `hidden: leave out`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fiberweb.recordings import text as texts
from fiberweb.recordings.base import Raw, check_size
from fiberweb.recordings.options import Reading

WHOLE = 2**53  # from here on a number in a file may not be the one that was meant
COLUMNS = ("x", "y", "frame", "particle")


def recognises(path: Path, head: bytes) -> bool:
    first = head.removeprefix(b"\xef\xbb\xbf").split(b"\n", 1)[0].decode(errors="ignore")
    return set(COLUMNS) <= {cell.strip() for cell in first.split(",")}


def read(path: Path, options: Reading) -> Raw:
    """Read trackpy's trajectories; a particle is NaN in the frames where it was not found.

    Raises:
        ValueError: one sentence with file, column and row.
    """
    texts.refuse_markers(path, options)
    text = texts.sniff(path)
    header = [cell.strip() for cell in text.lines[0]]
    wanted = {name: texts.find(text, header, name, "markers") for name in COLUMNS}
    columns, first_row = texts.numbers(text, wanted, 1, len(header))
    whole = {}
    for name in ("frame", "particle"):
        values = columns[name]
        wrong = ~((values == np.round(values)) & (np.abs(values) < WHOLE))  # NaN as well
        if wrong.any():
            at = int(np.argmax(wrong))
            raise ValueError(
                f"{path}, column {name!r}, row {at + first_row}: {values[at]:g} is no whole number"
            )
        whole[name] = values.astype(int)
    frame, (particles, number) = whole["frame"], np.unique(whole["particle"], return_inverse=True)
    frame -= frame.min()
    check_size(path, 2 * (float(frame.max()) + 1) * len(particles))
    point = frame * len(particles) + number
    _, first, counts = np.unique(point, return_index=True, return_counts=True)
    if (counts > 1).any():
        at = int(first[np.argmax(counts > 1)])
        raise ValueError(
            f"{path}, row {at + first_row}: particle {whole['particle'][at]} is there twice in its "
            "frame; link the trajectories again"
        )
    positions = np.full((frame.max() + 1, len(particles), 2), np.nan)
    positions[frame, number] = np.stack([columns["x"], columns["y"]], -1)
    names = [f"p{particle}" for particle in particles]
    return Raw(positions, names, units="px", findings=text.findings)
