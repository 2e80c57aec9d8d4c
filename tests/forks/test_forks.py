"""A script in a fork is what it would be in a Python of its own."""

import os
import shutil
import signal
import subprocess
import sys
import time

import psutil
import pytest

from fiberweb import forks

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="no forks elsewhere")


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    results = tmp_path_factory.mktemp("results")
    (results / "logs").mkdir()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(forks.ADDRESS, "")  # undone at the end
        process = forks.start(sys.executable, results)
        patch.setenv("OMP_NUM_THREADS", "1")
        yield process
        process.stdin.close()
        process.wait(timeout=60)


@pytest.fixture
def run(server, tmp_path):
    """Run the text of a script as the workflow does; the process, or after its end what it left."""

    def run(text, wait=True, **environment):
        script = tmp_path / "job.py"
        script.write_text(text)
        process = subprocess.Popen(
            f"exec {forks.interpreter(sys.executable)} {script}",
            shell=True, cwd=tmp_path, env=os.environ | environment,
        )  # fmt: skip
        return process.wait() if wait else process

    return run


def test_a_script_has_everything_imported_and_the_callers_folder_and_environment(run, tmp_path):
    text = "import os, sys; print('xarray' in sys.modules, os.environ['A'], file=open('had', 'w'))"
    assert run(text, A="3") == 0
    assert (tmp_path / "had").read_text() == "True 3\n"


@pytest.mark.parametrize("change", [{"OMP_NUM_THREADS": "2"}, {forks.ADDRESS: "/no/such/socket"}])
def test_without_a_server_or_with_threads_python_itself_runs_it(run, tmp_path, change):
    text = "import sys; open('had', 'w').write(str('xarray' in sys.modules))"
    assert run(text, **change) == 0
    assert (tmp_path / "had").read_text() == "False"


@pytest.mark.parametrize(
    "text, code",
    [("pass", 0), ("raise SystemExit(3)", 3), ("raise SystemExit('why')", 1), ("1 / 0", 1),
     ("import os; os.kill(os.getpid(), 9)", 137)],
)  # fmt: skip
def test_its_end_is_the_callers(run, text, code):
    assert run(text) == code


def test_what_it_registers_for_its_end_is_run_and_its_words_go_where_it_sends_them(run, tmp_path):
    text = (
        "import atexit, os\n"
        "os.dup2(os.open('log', os.O_WRONLY | os.O_CREAT), 2)\n"
        "atexit.register(lambda: open('end', 'w').write('ended'))\n"
        "def divide():\n    1 / 0\n"
        "divide()\n"
    )
    assert run(text) == 1
    assert (tmp_path / "end").read_text() == "ended"
    log = (tmp_path / "log").read_text()
    assert log.startswith("Traceback") and "ZeroDivisionError" in log and "server.py" not in log


@pytest.mark.parametrize("ended", ["caller", "keeper"])
def test_it_ends_with_its_caller_and_with_its_keeper(run, tmp_path, ended):
    text = "import os, time; print(os.getpid(), file=open('pid', 'w'), flush=True); time.sleep(60)"
    process, pid = run(text, wait=False), tmp_path / "pid"
    while not (pid.exists() and pid.read_text().endswith("\n")):
        time.sleep(0.01)
    script = psutil.Process(int(pid.read_text()))
    (process if ended == "caller" else script.parent()).kill()
    _, alive = psutil.wait_procs([script], timeout=10)
    assert not alive
    assert process.wait() == (-9 if ended == "caller" else 1)


def test_a_child_of_it_holds_nobody_up(run):
    began = time.monotonic()
    assert run("import subprocess; subprocess.Popen(['sleep', '30'])") == 0
    assert time.monotonic() - began < 20


@pytest.mark.parametrize("end", ["raise SystemExit(2**40)", "1 / 0"])
def test_no_end_of_it_is_that_of_the_server(run, server, end):
    text = f"import os; os.dup2(os.open('/dev/full', os.O_WRONLY), 2)\n{end}"
    run(text)
    assert server.poll() is None
    assert os.path.exists(os.environ[forks.ADDRESS])


def test_the_server_ends_with_whoever_started_it_and_says_what_it_took(tmp_path, monkeypatch):
    monkeypatch.setenv(forks.ADDRESS, "")
    (tmp_path / "logs").mkdir()
    process = forks.start(sys.executable, tmp_path)
    address = os.environ[forks.ADDRESS]
    process.stdin.close()
    assert process.wait(timeout=60) == 0
    assert not os.path.exists(os.path.dirname(address))
    assert (tmp_path / "logs" / "forks.log").read_text().startswith("took rest ")


def test_where_no_socket_can_be_there_are_no_forks(tmp_path, monkeypatch):
    monkeypatch.delenv(forks.ADDRESS, raising=False)
    long = tmp_path / ("x" * 100)
    long.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(long))
    assert forks.start(sys.executable, tmp_path) is None
    assert list(long.iterdir()) == [] and forks.ADDRESS not in os.environ


def test_what_waits_for_a_server_that_is_killed_is_run_by_python(tmp_path, monkeypatch):
    monkeypatch.setenv(forks.ADDRESS, "")
    monkeypatch.setenv("OMP_NUM_THREADS", "1")
    script = tmp_path / "job.py"
    script.write_text("open('had', 'w').write('run')")
    process = forks.start(sys.executable, tmp_path)
    process.send_signal(signal.SIGSTOP)
    command = f"exec {forks.interpreter(sys.executable)} {script}"
    client = subprocess.Popen(command, shell=True, cwd=tmp_path)
    time.sleep(0.5)
    process.kill()
    process.wait()
    assert client.wait(timeout=60) == 0
    assert (tmp_path / "had").read_text() == "run"
    shutil.rmtree(os.path.dirname(os.environ[forks.ADDRESS]))
