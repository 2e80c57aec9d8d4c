"""Jobs as forks of one process that has everything imported and every kernel loaded.

To start Python, import what a job needs and load a compiled engine takes as long as many a scene
takes to run. The process in `server` does so once a call of Snakemake, and every script
is then run in a fork of it: `client` stands in for the interpreter, and where there is nothing to
fork from (a cluster, another system, several threads a job) it becomes the interpreter.
"""

from __future__ import annotations

import os
import shlex
import shutil
import socket
import subprocess
import sys
import tempfile
from pathlib import Path

ADDRESS = "FIBERWEB_FORKS"  # variable with the socket's path
HERE = Path(__file__).parent


def interpreter(python: str) -> str:
    """The command that runs a script in place of Python's own, quoted for a shell."""
    return shlex.join([python, "-I", "-S", str(HERE / "client.py")])


def start(python: str, results: str | Path) -> subprocess.Popen | None:
    """Start the process that scripts are forks of; it ends with this one.

    Args:
        python: path of the interpreter.
        results: the folder that tells which engines are compiled.

    Returns:
        The process, to be kept; None where jobs must not be forks, or cannot.
    """
    if sys.platform != "linux":  # elsewhere system libraries do not bear a fork
        return None
    one_thread = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1")
    folder = None
    try:
        folder = Path(tempfile.mkdtemp(prefix="fiberweb-"))
        with socket.socket(socket.AF_UNIX) as listener:
            listener.bind(str(folder / "socket"))  # not where the path has over 107 bytes
            listener.listen(1024)  # from now on a client waits for the server
            process = subprocess.Popen(
                [python, str(HERE / "server.py"), str(results), str(listener.fileno())],
                env=os.environ | one_thread, stdin=subprocess.PIPE, pass_fds=[listener.fileno()],
            )  # fmt: skip
    except OSError:
        shutil.rmtree(folder or "", ignore_errors=True)
        return None
    os.environ[ADDRESS] = str(folder / "socket")
    return process
