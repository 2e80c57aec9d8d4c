"""What a run may have of memory."""

import pytest

from fiberweb.simulation import memory


@pytest.fixture
def asked(monkeypatch, tmp_path):
    """Asks anew, where no cluster and no container has a say."""
    monkeypatch.delenv("SLURM_MEM_PER_NODE", raising=False)
    monkeypatch.setattr(memory, "CGROUP", tmp_path / "memory.max")
    memory.of_this_machine.cache_clear()
    yield memory.of_this_machine
    memory.of_this_machine.cache_clear()


def test_a_job_of_a_cluster_has_what_it_asked_for(asked, monkeypatch):
    monkeypatch.setenv("SLURM_MEM_PER_NODE", "100")
    assert asked() == 100 * 2**20


@pytest.mark.parametrize(("says", "limited"), [("50000000", True), ("max", False)])
def test_a_container_has_what_it_may_have(asked, says, limited):
    memory.CGROUP.write_text(f"{says}\n")
    assert (asked() == 50_000_000) == limited
    assert asked() >= 50_000_000
