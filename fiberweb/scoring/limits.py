"""How long a recording has to be to be scored, and how a run is scored where nothing else is said.

Of numbers alone, so that a config is checked without what scoring imports.
"""

from __future__ import annotations

import math

HORIZON = 1.0  # s, longest recall lag
ALPHA = 0.01  # ridge penalty
SPLIT = 0.75  # fraction of the frames trained on
LEAST_TRAINED = 2  # frames: of fewer, a readout has no deviation to be divided by
LEAST_TESTED = 2  # frames: of fewer, a target has no variance


def training_end(start: int, frames: int, split: float) -> int:
    """First test frame of a split of frames [start, frames), whose test part rounds up."""
    return start + math.floor(split * (frames - start) + 1e-9)  # 0.57 * 100 falls short of 57


def check_frames(
    frames: int, sample_rate: float, horizon: float = HORIZON, split: float = SPLIT, skip: int = 0
) -> None:
    """Raise ValueError, one sentence, if so many frames at a rate (Hz) cannot be scored; see
    `fiberweb.scoring.regression.Options` for the rest."""
    longest = round(horizon * sample_rate)
    if longest < 1:
        raise ValueError(
            f"horizon = {horizon:g} s is shorter than a frame; give at least {1 / sample_rate:g} s"
        )
    # Two horizons: at the longest lag, as many frames are left to split as the lag took away.
    if frames - skip < 2 * horizon * sample_rate:
        raise ValueError(
            f"duration = {frames / sample_rate:g} s is too short for a recall horizon of "
            f"{horizon:g} s and a split beyond it; record at least "
            f"{2 * horizon + skip / sample_rate:g} s"
        )
    end = training_end(longest, frames - skip, split)
    if (tested := frames - skip - end) < LEAST_TESTED:
        raise ValueError(
            f"split = {split:g} of {frames / sample_rate:g} s leaves {tested} frames to test on, "
            f"and {LEAST_TESTED} are needed; give a smaller fraction or record longer"
        )
    trained = end - longest
    if trained < LEAST_TRAINED:
        raise ValueError(
            f"sample_rate = {sample_rate:g} Hz over {frames / sample_rate:g} s leaves "
            f"{max(trained, 0)} frames to train on beyond the horizon of {horizon:g} s, and "
            f"{LEAST_TRAINED} are needed; record longer or at a higher rate"
        )
