"""Where a script's output goes."""

import os
import sys


def to_log(path):
    """Send everything printed from now on, tracebacks and what libraries say, to a file."""
    with open(path, "w") as log:
        os.dup2(log.fileno(), 1)
        os.dup2(log.fileno(), 2)
    sys.stdout.reconfigure(line_buffering=True)
