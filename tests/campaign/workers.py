# SPDX-License-Identifier: Apache-2.0
"""Playing launches on all cores, or on a Dask cluster, through concurrent.futures."""

import functools
import hashlib
import os
import platform
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, ProcessPoolExecutor, as_completed
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import NamedTuple

from .launch import play
from .report import Launch
from .scenario import scenario

ROOT = Path(__file__).parents[2]
# What decides how a launch goes. Machines that differ in it must not play one campaign.
SOURCES = ("lib/lw_core", "lib/lw_plant", "sim", "tests/campaign", "modbus_map/registers.yaml")
SUFFIXES = (".c", ".h", ".py", ".yaml")
PIECE_LAUNCHES = 20  # so many at once: about half a second
DEATHS_MAX = 3  # workers that die one after the other, and nothing is played meanwhile
CONNECT_S = 10

Pool = Callable[[], AbstractContextManager[Executor]]


class Played(NamedTuple):
    """Launches that one worker has played."""

    launches: list[Launch]
    host: str
    process: int
    seconds: float  # of its processor


@functools.cache
def sources() -> str:
    """A digest of what decides how a launch goes."""
    digest = hashlib.sha256()
    for source in SOURCES:
        files = [ROOT / source] if (ROOT / source).is_file() else (ROOT / source).rglob("*")
        for file in sorted(f for f in files if f.suffix in SUFFIXES):
            digest.update(f"{file.relative_to(ROOT)}\0".encode() + file.read_bytes() + b"\0")
    return digest.hexdigest()


def play_seed(seed: int, library: Path | None = None) -> Launch:
    """Play the launch of a seed."""
    s = scenario(seed)
    return Launch(seed, s.faults, play(s, library=library)[0])


def play_piece(seeds: range, wanted_sources: str) -> Played:
    """Play some launches. Runs in a worker."""
    if sources() != wanted_sources:
        raise RuntimeError(
            f"{platform.node()}: the sources in {ROOT} are not those of the campaign: check out "
            "the same revision there, and start ./dev campaign --worker again"
        )
    began = time.process_time()
    launches = [play_seed(seed) for seed in seeds]
    return Played(launches, platform.node(), os.getpid(), time.process_time() - began)


def local_pool() -> Executor:
    """The cores of this machine."""
    return ProcessPoolExecutor(len(os.sched_getaffinity(0)))


@contextmanager
def cluster(address: str) -> Iterator[Pool]:
    """The workers of a Dask scheduler, which plays again what was lost with one that died."""
    try:
        from distributed import Client  # noqa: PLC0415 - an extra
    except ImportError:
        raise SystemExit(
            "campaign: --scheduler needs Dask: pip install 'host_tools/python[cluster]'"
        ) from None
    try:
        client = Client(address, timeout=CONNECT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise SystemExit(
            f"campaign: no Dask scheduler at {address} ({error}): start one by "
            ".venv/bin/dask scheduler, and workers by ./dev campaign --worker ADDRESS"
        ) from error
    with client:
        if not client.scheduler_info()["workers"]:
            print(f"campaign: waiting for a worker at {address}", file=sys.stderr, flush=True)
        yield lambda: nullcontext(client.get_executor(pure=False))


def play_all(seeds: range, pool: Pool = local_pool) -> Iterator[Played]:
    """
    Play all, as they are done, in any order.

    A pool of processes is lost with a worker that dies: what it has not played is played by another
    one.
    """
    pieces = {seeds[i : i + PIECE_LAUNCHES]: None for i in range(0, len(seeds), PIECE_LAUNCHES)}
    deaths = 0
    while pieces:
        with pool() as executor:
            futures = {executor.submit(play_piece, piece, sources()): piece for piece in pieces}
            try:
                for future in as_completed(futures):
                    played = future.result()
                    del pieces[futures[future]]
                    deaths = 0
                    yield played
            except BrokenExecutor as error:
                deaths += 1
                if deaths == DEATHS_MAX:
                    first = next(iter(pieces))[0]
                    raise RuntimeError(
                        f"{deaths} workers died one after the other, and nothing was played "
                        f"meanwhile; left are {sum(map(len, pieces))} launches from seed {first} on"
                    ) from error
            finally:
                for future in futures:
                    future.cancel()


def run_worker(address: str) -> None:
    """Become a Dask worker: one process a core. Does not return."""
    cores = len(os.sched_getaffinity(0))
    os.execv(
        sys.executable,
        [
            *(sys.executable, "-m", "distributed.cli.dask_worker", address),
            *("--nworkers", str(cores), "--nthreads", "1", "--no-dashboard"),
        ],
    )
