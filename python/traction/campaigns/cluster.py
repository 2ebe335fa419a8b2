"""Workers elsewhere: a Dask scheduler hands rows to whatever workers it has (Slurm, PBS, SSH, Kubernetes: Dask's own deployments)."""

from __future__ import annotations

import asyncio
import concurrent.futures
import itertools
import time
from collections.abc import Iterable, Iterator
from typing import Any

from .._errors import CampaignError
from .drive import run_row
from .plan import Row, Task

PATIENCE_S = 120.0  # how long a scheduler may be away: a restart by whatever watches over it


def drive_all(job: Task, rows: Iterable[Row], scheduler: Any) -> Iterator[tuple[Row, Row]]:
    """Each row with what came of it, as they come. `scheduler`: an address ("tcp://host:8786"), or a distributed.Client.

    A worker that dies is Dask's business: its rows are driven elsewhere, and a row that ended four workers is a failed one. A scheduler
    that dies takes its rows along: they are given to the one that comes in its place, so no row is lost, and none is kept twice.
    """
    from distributed import wait
    from distributed.comm.core import CommClosedError
    from distributed.scheduler import KilledWorker

    lost = (CommClosedError, OSError, TimeoutError, asyncio.CancelledError, concurrent.futures.CancelledError, RuntimeError)
    source, waiting = iter(rows), list[Row]()
    own = isinstance(scheduler, str)
    client = _client(scheduler, 10) if own else scheduler
    futures: dict[Any, Row] = {}
    try:
        while True:
            try:
                room = max(4, 2 * sum(client.nthreads().values())) - len(futures)
                for row in itertools.islice(itertools.chain(_taken(waiting), source), max(room, 0)):
                    futures[client.submit(run_row, job, row, pure=False)] = row
                if not futures:
                    return
                done = wait(list(futures), timeout=10, return_when="FIRST_COMPLETED").done
                answers = []
                for future in done:
                    if future.status in ("cancelled", "lost"):
                        raise CommClosedError("the scheduler lost a row")
                    try:
                        answers.append((future, future.result(timeout=30)))
                    except KilledWorker as error:
                        answers.append((future, {"status": "failed", "error": f"its workers died: {error}".splitlines()[0]}))
            except TimeoutError:
                if client.status == "running":
                    continue  # drives are long
                _only_if(own)
                client = _again(client, scheduler, futures, waiting)
                continue
            except lost:
                _only_if(own)
                client = _again(client, scheduler, futures, waiting)
                continue
            for future, answer in answers:
                yield futures.pop(future), answer
    finally:
        for future in futures:
            future.release()
        if own:
            client.close(timeout=5)


def _only_if(own: bool) -> None:
    """A client that the caller made cannot be made again here: its loss is the caller's to see."""
    if not own:
        raise CampaignError(
            "the Dask scheduler went away; to mend: make a new client and call again, what is done is kept", mend="call again"
        )


def _taken(waiting: list[Row]) -> Iterator[Row]:
    while waiting:
        yield waiting.pop(0)


def _client(address: str, patience_s: float) -> Any:
    from distributed import Client

    began = time.monotonic()
    while True:
        try:
            return Client(address, timeout=5)
        except (OSError, TimeoutError) as error:
            if time.monotonic() - began > patience_s:
                mend = "start it (dask scheduler), or give another address"
                raise CampaignError(f"{address}: no Dask scheduler answers ({error}); to mend: {mend}", address, mend=mend) from None
            time.sleep(0.5)
        except ValueError as error:
            mend = "give it as tcp://HOST:PORT"
            raise CampaignError(f"{address}: is no scheduler's address ({error}); to mend: {mend}", address, mend=mend) from None


def _again(client: Any, address: str, futures: dict[Any, Row], waiting: list[Row]) -> Any:
    """A new client; what the old one had under way waits again, in the order of rows."""
    waiting[:0] = sorted(futures.values(), key=lambda row: int(row["drive"]))
    futures.clear()
    try:
        client.close(timeout=2)
    except Exception:  # it is gone either way
        pass
    return _client(address, PATIENCE_S)
