"""Where a script's output goes."""

import atexit
import os
import signal
import sys
import time

from fiberweb import calls, timed
from fiberweb.written import clear, note


def to_log(job, does, takes):
    """Send everything printed from now on, tracebacks and what libraries say, to the job's log. It
    begins with what the job does and how long that takes, in words; its last lines are what the job
    wrote, and what its CPU time went to. `job` is what Snakemake gives to a script.
    """
    # Ctrl-C ends a job at once: an exception inside NetCDF's lock leaves it held, and the process
    # then waits for it for ever
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    timed.spent["start"] = time.process_time()
    calls.join()
    clear(job.output)
    path = job.log[0]
    with open(path, "a+") as log:
        log.seek(0)
        before = timed.read(log.read())
        log.truncate(0)
        os.dup2(log.fileno(), 1)
        os.dup2(log.fileno(), 2)
    sys.stdout.reconfigure(line_buffering=True)
    print(f"{job.rule}: {does}")
    given = {name: value for name, value in job.wildcards.items() if value}
    print(*(f"{name}: {value}\n" for name, value in given.items()), sep="", end="")
    again = f"; last time {sum(before.values()):.2g} s of CPU time" if before else ""
    print(f"takes: {takes}{again}")
    atexit.register(lambda: print(timed.line()))
    atexit.register(note, path, list(job.output))
