"""These tests start a SLURM of one node on this machine, as root: `make test-slurm` installs
Snakemake's executor for it into an environment of its own. Elsewhere nothing here is collected."""

import contextlib
import os
import shutil
import subprocess
import time
from importlib.util import find_spec
from pathlib import Path

import psutil
import pytest

plugin = find_spec("snakemake_executor_plugin_slurm")
collect_ignore_glob = [] if plugin else ["test_*.py"]

CONFIG = Path("/etc/slurm/slurm.conf")  # here alone: what starts a job strips SLURM_CONF
NEEDED = ("munged", "slurmctld", "slurmd", "sbatch")
LINES = """
ClusterName=loopback
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
MpiDefault=none
MinJobAge=3600
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
ReturnToService=2
SlurmdTimeout=10
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory=8000
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


class Cluster:
    """A SLURM of one node, its daemons children of this process."""

    def __init__(self, folder, cpus):
        self._log, self._daemons = (folder / "daemons.log").open("w"), {}
        for name in ("state", "spool"):
            (folder / name).mkdir()
        text = LINES.format(folder=folder, host=os.uname().nodename, cpus=cpus)
        CONFIG.write_text(text)
        socket = folder / "munge"
        socket.mkdir()
        Path("/run/munge").mkdir(exist_ok=True)
        shutil.chown("/run/munge", "munge", "munge")
        self._start("munged", "runuser", "-u", "munge", "--", "munged", "--foreground", "--force")
        self._until("munge", "--no-input")
        self.start_controller()
        self.start_node()

    def start_controller(self):
        self._start("slurmctld", "slurmctld", "-D")
        self._until("sinfo")

    def kill_controller(self):
        controller = self._daemons.pop("slurmctld")
        controller.kill()
        controller.wait()

    def start_node(self):
        self._start("slurmd", "slurmd", "-D")
        self._until("srun", "--immediate=5", "true")

    def kill_node(self):
        """Kill what runs on the node, as a loss of power does, until the controller misses it."""
        node = self._daemons.pop("slurmd")
        steps = [each for each in psutil.process_iter() if each.name() == "slurmstepd"]
        running = [below for step in steps for below in step.children(recursive=True)]
        for process in (node, *steps, *running):
            with contextlib.suppress(psutil.NoSuchProcess):
                process.kill()
        node.wait()
        self._until("sh", "-c", "sinfo --noheader --format=%T | grep --quiet down")

    def stop(self):
        CONFIG.unlink()
        for daemon in reversed(self._daemons.values()):
            daemon.terminate()
            daemon.wait(timeout=60)

    def _start(self, name, *command):
        self._daemons[name] = subprocess.Popen(command, stdout=self._log, stderr=self._log)

    def _until(self, *command):
        """Until a command succeeds."""
        for _ in range(60):
            done = subprocess.run(command, capture_output=True, text=True)
            if done.returncode == 0:
                return
            time.sleep(1.0)
        raise AssertionError(f"{command}: {done.stderr}\n{Path(self._log.name).read_text()}")


@pytest.fixture(scope="session")
def cluster(tmp_path_factory):
    if os.getuid() or not all(map(shutil.which, NEEDED)):
        pytest.exit("SLURM is started as root, from Debian's slurm-wlm and munge: install them", 1)
    if CONFIG.exists():
        pytest.exit(f"{CONFIG} exists: this machine has a SLURM of its own, left alone", 1)
    cluster = Cluster(tmp_path_factory.mktemp("slurm"), os.cpu_count())
    yield cluster
    cluster.stop()
