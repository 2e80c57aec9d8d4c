"""A disk that is full or cannot be written, and files that are damaged or in use."""

import os
import subprocess
import sys
from pathlib import Path

import h5py
import pytest

from tests.faults.conftest import TARGET, finished, one_way

SNAKEMAKE = f"{sys.executable} -m snakemake {' '.join(TARGET)}"
RESUME = f"{sys.executable} -m fiberweb.tools.resume"
# mounts of which nobody else sees anything, and which are gone with the shell
APART = ("unshare", "--mount", *(["--map-root-user"] if os.getuid() else []), "sh", "-c")
mounts = pytest.mark.skipif(
    subprocess.run([*APART, "mount -t tmpfs none /mnt"], capture_output=True).returncode != 0,
    reason="nothing can be mounted here",
)


def one(tree, pattern):
    """The first file of a pattern."""
    return sorted(tree.out.glob(pattern))[0]


@mounts
@pytest.mark.parametrize("kilobytes", [140, 450])
def test_a_full_disk(fresh, expected, kilobytes):
    """Of so many kB, before any response, or later, is enlarged in the end."""
    fresh.out.mkdir()
    printed = fresh.call(
        *APART,
        f"mount -t tmpfs -o size={kilobytes}k none out\n"
        f"{SNAKEMAKE} && exit 9\n"
        "mount -o remount,size=100m out\n"
        f"{RESUME} || exit 8\n"
        "mkdir kept && cp -r out/* kept",
    )
    assert "No space left on device" in printed or "the disk is full" in printed
    assert "No finished run is lost" in printed
    fresh.out = fresh.folder / "kept"
    assert fresh.made() == expected
    assert finished(printed) == sum("response.nc" in name for name in expected)


@mounts
@one_way
def test_a_full_disk_with_the_clone_on_it(fresh, expected, tmp_path):
    printed = fresh.call(
        *APART,
        "mkdir disk && mount -t tmpfs -o size=20m none disk && cp -r [!d]* disk && cd disk\n"
        f"head -c $(($(stat -f -c '%a * %S' .) - 450000)) /dev/zero > filler\n"
        f"PYTHONPATH=$PWD {SNAKEMAKE} && exit 9\n"
        "rm filler\n"
        f"PYTHONPATH=$PWD {RESUME} || exit 8\n"
        "cp -r out ../kept",
    )
    fresh.out = fresh.folder / "kept"
    assert fresh.made() == expected
    assert "No space left on device" in printed


@mounts
@one_way
def test_a_disk_that_is_full_already(fresh, expected):
    fresh.out.mkdir()
    printed = fresh.call(
        *APART,
        "mount -t tmpfs -o size=64k none out && head -c 40000 /dev/zero > out/filler\n"
        f"{SNAKEMAKE} && exit 9\n"
        "exit 0",
    )
    sentence = "results = 'out' cannot be written (No space left on device): name a folder that can"
    assert printed.splitlines()[-1] == sentence
    assert "Traceback" not in printed
    fresh.run()
    assert fresh.made() == expected


@mounts
@one_way
def test_results_that_cannot_be_written(fresh, expected):
    fresh.out.mkdir()
    printed = fresh.call(
        *APART,
        "mount --bind out out && mount -o remount,ro,bind out\n"
        f"{SNAKEMAKE} && exit 9\n"
        "exit 0",
    )  # fmt: skip
    sentence = "results = 'out' cannot be written (Read-only file system): name a folder that can"
    assert printed.splitlines()[-1] == sentence
    assert "Traceback" not in printed
    fresh.run()
    assert fresh.made() == expected


@mounts
@one_way
def test_results_that_can_no_longer_be_written(fresh, expected):
    """As of a disk that the system mounts anew after an error, here before capacities."""
    fresh.out.mkdir()
    printed = fresh.call(
        *APART,
        f"{SNAKEMAKE} --until simulate || exit 7\n"
        "mount --bind out/runs out/runs && mount -o remount,ro,bind out/runs\n"
        f"{SNAKEMAKE} && exit 9\n"
        "umount out/runs\n"
        f"{RESUME}",
    )
    assert "OSError: [Errno 30] Read-only file system: 'out/runs/" in printed
    assert fresh.made() == expected
    assert finished(printed) == sum("response.nc" in name for name in expected)


@one_way
@pytest.mark.parametrize("left", [0, 1000, -1], ids=["empty", "truncated", "one byte short"])
def test_a_response_cut_short(done, expected, left):
    response = one(done, "runs/*/response.nc")
    response.write_bytes(response.read_bytes()[:left])
    printed = done.run()
    assert f"{response.relative_to(done.folder)} is broken: it has" in printed
    assert finished(printed) == 1
    assert done.made() == expected


def flip(path, at):
    """One bit, and nobody sees when: the time of the file is what it was."""
    content, stat = bytearray(path.read_bytes()), path.stat()
    content[at] ^= 1
    path.write_bytes(content)
    os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns))


@one_way
@pytest.mark.parametrize("where", ["data", "attribute"])
def test_a_flipped_bit_where_it_is_read(done, expected, where):
    """A job that reads it says so, and `make resume` makes it again."""
    response = one(done, "runs/*/response.nc")
    with h5py.File(response) as file:
        chunk = file["displacement"].id.get_chunk_info(0).byte_offset + 20
    text = response.read_bytes().index(b'"crosshatch"') + 3
    flip(response, {"data": chunk, "attribute": text}[where])
    printed = done.run("--forcerun", "capacity", expected=1)
    name = response.relative_to(done.folder)
    assert f"{name} cannot be read" in printed and "`make resume`" in printed
    printed = done.resume()
    assert f"{name} is broken: its content is not what was written" in printed
    assert finished(printed) == 1
    assert done.made() == expected


@one_way
def test_a_flipped_bit_where_nobody_looks(done, expected):
    """In a file that no job reads, and in a table's digit: found by whoever resumes."""
    response, table = one(done, "runs/*/response.nc"), one(done, "tables/*/topology.csv")
    flip(response, len(response.read_bytes()) // 2)
    flip(table, table.read_bytes().rindex(b"0."))
    one(done, "figures/*.png").unlink()
    call = done.start()
    done.job(call, "figures").kill()
    assert call.wait() != 0
    printed = done.resume()
    for path in (response, table):
        assert f"{path.relative_to(done.folder)} is broken: its content is not" in printed
    assert done.made() == expected


@one_way
@pytest.mark.parametrize("mode", ["r", "r+"])
def test_a_response_open_in_another_program(done, expected, mode):
    """While it is read, and while it is made again."""
    path = one(done, "runs/*/response.nc")
    hold = f"import h5py; file = h5py.File({str(path)!r}, {mode!r}); print(1, flush=True); input()"
    other = subprocess.Popen(
        [sys.executable, "-c", hold], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert other.stdout.readline() == "1\n"
    for rule in ("capacity", "simulate"):
        assert finished(done.run("--forcerun", rule), rule) == 1
    assert other.poll() is None
    assert done.made() == expected  # while it is held to be written, HDF5 marks the old file so
    other.communicate("\n")


@pytest.mark.parametrize("error", ["ENOSYS", "ENOLCK"])
def test_a_disk_without_locks(fresh, expected, error):
    """As some of clusters: Snakemake runs, and `make resume` says what it cannot know."""
    without = Path(__file__).with_name("without_locks.py")
    command = (sys.executable, str(without), error)
    fresh.call(*command, sys.executable, "-m", "snakemake", *TARGET)
    assert fresh.made() == expected
    one(fresh, "figures/*.png").unlink()
    call = fresh.start()
    fresh.job(call, "figures").kill()
    call.wait()
    refused = fresh.call(*command, sys.executable, "-m", "fiberweb.tools.resume", expected=1)
    assert "who is at work in" in refused and "snakemake --unlock" in refused
    fresh.resume()
    assert fresh.made() == expected
