"""Where a script's output goes."""

import atexit
import os
import signal
import sys
import time

from fiberweb import calls, timed
from fiberweb.written import clear, note


def to_log(job):
    """Send everything printed from now on, tracebacks and what libraries say, to the job's log;
    its last lines are what the job wrote, and what its CPU time went to.

    Args:
        job: what Snakemake gives to a script.
    """
    # Ctrl-C ends a job at once: an exception inside NetCDF's lock leaves it held, and the process
    # then waits for it for ever
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    timed.spent["start"] = time.process_time()
    calls.join()
    clear(job.output)
    path = job.log[0]
    with open(path, "w") as log:
        os.dup2(log.fileno(), 1)
        os.dup2(log.fileno(), 2)
    sys.stdout.reconfigure(line_buffering=True)
    atexit.register(lambda: print(timed.line()))
    atexit.register(note, path, list(job.output))
