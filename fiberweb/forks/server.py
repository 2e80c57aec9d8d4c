"""`python server.py RESULTS SOCKET`: import everything, then fork for each script asked for.

Three processes a script: this one forks a keeper, which forks the script and waits for its end or
for that of the client, whichever is first. A script thus ends with its client, as if it were it.
"""

import atexit
import contextlib
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


def serve(listener, results):
    """Answer requests until standard input ends, which it does with whoever started this.

    Args:
        listener: the socket that clients connect to.
        results: folder whose warmup/<engine>.done tells which kernels can be loaded.
    """
    for name in HEAVY:
        import_module(name)
    from fiberweb import timed
    from fiberweb.engines import ENGINES, warmup

    loaded = set()
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # the keepers are nobody's concern
    while True:
        ready, _, _ = select.select([listener, sys.stdin], [], [])
        if sys.stdin in ready:
            Path(results, "logs", "forks.log").write_text(timed.line() + "\n")
            return
        connection, _ = listener.accept()
        for engine in ENGINES:
            if engine not in loaded and Path(results, "warmup", f"{engine}.done").exists():
                warmup(engine)
                loaded.add(engine)
        gc.freeze()  # else the first collection in each fork copies all of memory
        if os.fork() == 0:
            listener.close()
            keep(connection)
        connection.close()


def keep(connection):
    """Run what a client asks for, tell it the exit code, and end; without it, end the script."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    request = json.loads(connection.makefile().readline())
    alive, held = os.pipe()  # its end is seen when the script's process is gone
    script = os.fork()
    if script == 0:
        connection.close()
        os.close(alive)
        execute(**request)
    os.close(held)
    ready, _, _ = select.select([connection, alive], [], [])
    if alive not in ready:
        os.kill(script, signal.SIGKILL)
    _, status = os.waitpid(script, 0)
    code = os.waitstatus_to_exitcode(status)
    with contextlib.suppress(OSError):  # the client may be gone
        connection.sendall(b"%d\n" % (code if code >= 0 else 128 - code))
    os._exit(0)


def execute(script, folder, environment):
    """Run a script as Python would from its start to its end."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
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
    os._exit(code)


if __name__ == "__main__":
    sys.path[0] = str(ROOT)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the scripts
    results, listener = sys.argv[1], socket.socket(fileno=int(sys.argv[2]))
    address = Path(listener.getsockname())
    try:
        serve(listener, results)
    finally:
        address.unlink()
        address.parent.rmdir()
