"""Recordings of real bodies, read into the same Dataset that a simulation gives.

    response = read_recording("film.csv", rate=60.0)

A reader is a module with ``recognises(path, head)``, whether a file with these first bytes is of
its format, and ``read(path, options)``, which gives a `fiberweb.recordings.base.Raw`.
"""

from __future__ import annotations

from typing import NamedTuple


class Reader(NamedTuple):
    """Where a format is read, and how its files end in a folder of recordings."""

    module: str
    suffixes: tuple[str, ...]


READERS = {  # a file is of the first format that recognises it
    "deeplabcut": Reader("fiberweb.recordings.deeplabcut", (".csv",)),
    "motive": Reader("fiberweb.recordings.motive", (".csv",)),
    "trackpy": Reader("fiberweb.recordings.trackpy", (".csv",)),
    "openprc": Reader("fiberweb.recordings.openprc", (".h5", ".hdf5")),
    "matlab": Reader("fiberweb.recordings.matlab", (".mat",)),
    "netcdf": Reader("fiberweb.recordings.netcdf", (".nc",)),
    "table": Reader("fiberweb.recordings.table", (".csv", ".tsv", ".txt", ".dat")),
}


def read_recording(path, quiet: bool = False, **options):
    """A recording as the Dataset that a simulation gives; its sanity list is printed.

    Args:
        path: of the file.
        quiet: do not print.
        **options: of `fiberweb.recordings.options.Reading`, such as rate (Hz), input, markers,
            units, max_gap (s).

    Returns:
        ``input(time)``, ``displacement(time, readout, axis)`` from the first frame, in m or in px
        (its attribute units), time in s from the first frame, even; coordinates ``readout``, the
        markers' names, and ``rest_x``, ``rest_y``, where they were at first. Attributes status
        'ok', setup 'recording', sample_rate (Hz), run (the file's name) and sanity: the findings,
        see `sanity`.

    Raises:
        ValueError: the file or an option cannot be used: one sentence with file, column and row.
    """
    from fiberweb.recordings.read import read  # with pandas and h5py, which few calls need

    return read(path, quiet, options)


def sanity(response):
    """The sanity list of a recording: a frame of name, severity ('ok', 'note', 'repair',
    'warning' or 'refused') and sentence."""
    from fiberweb.recordings.read import listed

    return listed(response)
