"""A campaign on a Dask scheduler over TCP: a worker is killed, the scheduler is started anew, the table is the same."""

import os
import signal
import socket
import subprocess
import sys
import time

import pytest

import traction
from test_campaign import SPEC, digests
from test_lab_bench import BUILD, SMALL, needs_build

pytest.importorskip("distributed")
pytest.importorskip("pyarrow")


def free_port() -> int:
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Cluster:
    def __init__(self, folder) -> None:
        self.port, self.folder, self.all = free_port(), folder, []
        self.address = f"tcp://127.0.0.1:{self.port}"

    def start(self, *words: str) -> subprocess.Popen:
        log = open(self.folder / f"{len(self.all)}.log", "w")
        process = subprocess.Popen(
            [sys.executable, "-m", "distributed.cli." + words[0], *words[1:]], stdout=log, stderr=log, cwd=self.folder
        )
        self.all.append(process)
        return process

    def scheduler(self) -> subprocess.Popen:
        return self.start("dask_scheduler", "--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard")

    def worker(self) -> subprocess.Popen:
        return self.start("dask_worker", self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard")


@pytest.fixture
def cluster(tmp_path):
    it = Cluster(tmp_path)
    yield it
    for process in it.all:
        process.kill()
        process.wait()


def test_a_killed_worker_and_a_restarted_scheduler_change_no_bit(cluster, tmp_path):
    spec = {**SPEC, "repeats": 10, "vary": {"ground.slope_rad": {"low": 0.0, "high": 0.1, "count": 3}}}
    reference = traction.campaign(spec, tmp_path / "reference", workers=1)
    scheduler, first, _ = cluster.scheduler(), cluster.worker(), cluster.worker()
    did = []

    def disturb(progress):
        if progress.done >= 5 and not did:
            did.append("worker")
            os.kill(first.pid, signal.SIGKILL)
        if progress.done >= 12 and len(did) == 1:
            did.append("scheduler")
            os.kill(scheduler.pid, signal.SIGKILL)
            scheduler.wait()
            time.sleep(0.5)
            cluster.scheduler()
            cluster.worker()

    again = traction.campaign(spec, tmp_path / "c", scheduler=cluster.address, progress=disturb)
    assert did == ["worker", "scheduler"]
    assert again.status.done == 30 and digests(again.folder) == digests(reference.folder)


@needs_build
def test_a_bench_of_the_lab_is_the_same_on_a_cluster_that_loses_a_worker(cluster, tmp_path, monkeypatch):
    monkeypatch.setenv("TRACTION_BUILD", str(BUILD))
    four = {**SMALL, "logs": 2}
    reference = traction.campaign(four, tmp_path / "reference", workers=2)
    _, first, _ = cluster.scheduler(), cluster.worker(), cluster.worker()
    killed = []

    def disturb(progress):
        if progress.done >= 2 and not killed:
            killed.append(first.pid)
            os.kill(first.pid, signal.SIGKILL)

    again = traction.campaign(four, tmp_path / "c", scheduler=cluster.address, progress=disturb)
    assert killed and again.status.done == 4 and digests(again.folder) == digests(reference.folder)


def test_a_scheduler_that_is_not_there_is_told(tmp_path):
    with pytest.raises(traction.CampaignError, match="no Dask scheduler answers"):
        traction.campaign(SPEC, tmp_path / "c", scheduler=f"tcp://127.0.0.1:{free_port()}")
