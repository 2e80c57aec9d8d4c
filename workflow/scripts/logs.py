"""Where a script's output goes."""

import os
import signal
import sys


def to_log(path):
    """Send everything printed from now on, tracebacks and what libraries say, to a file."""
    # Ctrl-C ends a job at once: an exception inside NetCDF's lock leaves it held, and the process
    # then waits for it for ever
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    with open(path, "w") as log:
        os.dup2(log.fileno(), 1)
        os.dup2(log.fileno(), 2)
    sys.stdout.reconfigure(line_buffering=True)
