# SPDX-License-Identifier: Apache-2.0
"""Launches come out the same wherever they are played, and whoever dies meanwhile."""

import multiprocessing
import os
import platform
import signal
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import pytest

from . import workers
from .report import by_worker, write
from .workers import Played, cluster, play_all, play_seed

SEEDS = range(1, 1 + 25)
TESTS = Path(__file__).parents[1]


def verdicts(pieces: Iterable[Played]) -> list[tuple]:
    """All that was found, in the order of the seeds."""
    launches = (launch for piece in pieces for launch in piece.launches)
    return sorted((x.seed, x.faults, x.verdict) for x in launches)


@pytest.fixture(autouse=True)
def small_pieces(monkeypatch):
    """There is work left when the first of them is played."""
    monkeypatch.setattr(workers, "PIECE_LAUNCHES", 3)


@pytest.fixture(scope="module")
def alone() -> list[tuple]:
    """The verdicts of launches that were played one after the other, in this process."""
    launches = [play_seed(seed) for seed in SEEDS]
    return verdicts([Played(launches, platform.node(), os.getpid(), 0.0)])


def kill_after_first(processes: Callable[[], list[int]], pieces: Iterable[Played]) -> list[Played]:
    """Kill a worker as soon as something has been played."""
    played = []
    for piece in pieces:
        if not played:
            os.kill(processes()[0], signal.SIGKILL)
        played.append(piece)
    return played


def test_a_process_that_dies_costs_no_launch(alone):
    pools = []

    def pool() -> ProcessPoolExecutor:
        pools.append(ProcessPoolExecutor(2))
        return pools[-1]

    def processes() -> list[int]:
        return [child.pid for child in multiprocessing.active_children() if child.pid]

    assert verdicts(kill_after_first(processes, play_all(SEEDS, pool))) == alone
    assert len(pools) == 2


def test_a_worker_of_a_cluster_that_dies_costs_no_launch(alone, monkeypatch, tmp_path):
    distributed = pytest.importorskip("distributed")
    monkeypatch.setenv("PYTHONPATH", str(TESTS), prepend=os.pathsep)
    scheduler = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    )
    with scheduler, cluster(scheduler.scheduler_address) as pool:

        def processes() -> list[int]:
            return [worker.process.process.pid for worker in scheduler.workers.values()]

        before = processes()
        pieces = kill_after_first(processes, play_all(SEEDS, pool))
    assert verdicts(pieces) == alone
    assert before[0] not in {process for _, process, *_ in by_worker(pieces[2:])}
    report = tmp_path / "report.html"
    write(report, [x for piece in pieces for x in piece.launches], "a test", pieces)
    for host, process, count, *_ in by_worker(pieces):
        assert f'>{host}</td><td class="">{process}</td><td class="number">{count}</td>' in (
            report.read_text()
        )


def die(_seeds: range, _sources: str) -> Played:
    """A worker that always dies."""
    os.kill(os.getpid(), signal.SIGKILL)
    raise AssertionError("still alive")


def test_workers_that_always_die_are_told(monkeypatch):
    monkeypatch.setattr(workers, "play_piece", die)
    with pytest.raises(RuntimeError, match="left are 25 launches from seed 1 on"):
        list(play_all(SEEDS))


def test_a_worker_with_other_sources_plays_nothing():
    with pytest.raises(RuntimeError, match="check out the same revision"):
        workers.play_piece(SEEDS, "of another revision")


def test_a_scheduler_that_is_not_there_is_told(monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr(workers, "CONNECT_S", 0.5)
    with (
        pytest.raises(SystemExit, match=r"no Dask scheduler at tcp://127\.0\.0\.1:1"),
        cluster("tcp://127.0.0.1:1"),
    ):
        pass
