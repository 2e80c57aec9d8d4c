"""`python server.py RESULTS SOCKET`: import everything, then fork for each script asked for.

Three processes a script: this one forks a keeper, which forks the script and waits for its end or
for that of the client, whichever is first. A script thus ends with its client, as if it were it.
"""

import atexit
import contextlib
import ctypes
import gc
import json
import os
import select
import signal
import socket
import sys
import traceback
from importlib import import_module
from pathlib import Path

ROOT = Path(__file__).parents[2]
# what the scripts of most jobs import, at their start or when they need it
HEAVY = (
    "snakemake.iocontainers", "snakemake.logging", "fiberweb.simulation.simulate",
    "fiberweb.simulation.response", "fiberweb.simulation.dataset", "fiberweb.simulation.explain",
    "fiberweb.scoring.capacity", "fiberweb.figures.style",
)  # fmt: skip
NOT_FOR_THIS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)  # it ends with its standard input
PR_SET_PDEATHSIG = 1


def serve(listener, results):
    """Answer requests until standard input ends, which it does with whoever started this.

    Args:
        listener: the socket that clients connect to.
        results: folder whose warmup/<engine>.done tells which engines are compiled.
    """
    for name in HEAVY:
        import_module(name)
    loaded = set()
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # the keepers are nobody's concern
    while True:
        ready, _, _ = select.select([listener, sys.stdin], [], [])
        if sys.stdin in ready:
            return
        connection, _ = listener.accept()
        with connection, contextlib.suppress(BlockingIOError):  # no more processes: none for this
            load_engines(Path(results, "warmup"), loaded)
            gc.freeze()  # else the first collection in each fork copies all of memory
            if os.fork() == 0:
                try:
                    listener.close()
                    keep(connection)
                finally:
                    os._exit(1)


def load_engines(compiled, loaded):
    """Load the kernels of engines that were compiled since the last look, from their cache."""
    from fiberweb.engines import ENGINES, cache, warmup

    for engine in ENGINES.keys() - loaded:
        if not (compiled / f"{engine}.done").exists():
            continue
        if any(cache.folder().rglob(f"{engine}.*.nbi")):
            loaded.add(engine)
            with contextlib.suppress(Exception):  # the script that needs it will say so
                warmup(engine)


def keep(connection):
    """Run what a client asks for, tell it the exit code, and end; without it, end the script."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    request = json.loads(connection.makefile().readline())
    connection.sendall(b"taken\n")
    script = os.fork()
    if script == 0:
        try:
            connection.close()
            execute(**request)
        finally:
            os._exit(1)
    ended = os.pidfd_open(script)
    ready, _, _ = select.select([connection, ended], [], [])
    if ended not in ready:
        os.kill(script, signal.SIGKILL)
    _, status = os.waitpid(script, 0)
    code = os.waitstatus_to_exitcode(status)
    with contextlib.suppress(OSError):  # the client may be gone
        connection.sendall(b"%d\n" % (code if code >= 0 else 128 - code))
    os._exit(0)


def execute(script, folder, environment):
    """Run a script as Python would from its start to its end."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)  # not without its keeper
    for number in NOT_FOR_THIS:
        signal.signal(number, signal.SIG_DFL)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    sys.argv, sys.path[0] = [script], os.path.dirname(script)
    names = {"__name__": "__main__", "__file__": script}
    code = 0
    try:
        exec(compile(Path(script).read_bytes(), script, "exec"), names)
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
        if code and not isinstance(end.code, int):
            print(end.code, file=sys.stderr)
    except BaseException as error:
        traceback.print_exception(error.with_traceback(error.__traceback__.tb_next))
        code = 1
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code & 0xFF)


if __name__ == "__main__":
    sys.path[0] = str(ROOT)
    for number in NOT_FOR_THIS:
        signal.signal(number, signal.SIG_IGN)
    results, listener = sys.argv[1], socket.socket(fileno=int(sys.argv[2]))
    address = Path(listener.getsockname())
    try:
        serve(listener, results)
    finally:
        address.unlink(missing_ok=True)
        with contextlib.suppress(OSError):
            address.parent.rmdir()
    from fiberweb import timed

    timed.write(results, "forks")
