"""Local workers: processes that drive one row at a time, so that a row which ends its process is known and does not end the campaign."""

from __future__ import annotations

import itertools
import os
import pickle
import queue
import signal
import struct
import subprocess
import sys
import threading
from collections.abc import Iterable, Iterator
from typing import IO, Any

from .drive import Job, run_row
from .spec import Row

WORKER = "from traction.campaigns.pool import serve; serve()"  # what a worker runs


def _send(stream: IO[bytes], what: Any) -> None:
    data = pickle.dumps(what)
    stream.write(struct.pack("<Q", len(data)) + data)
    stream.flush()


def _receive(stream: IO[bytes]) -> Any:
    head = stream.read(8)
    if len(head) < 8:
        raise EOFError
    data = stream.read(struct.unpack("<Q", head)[0])
    return pickle.loads(data)


def serve() -> None:
    """The worker's side: a job, then rows, until its standard input ends."""
    into, out = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what anyone prints does not mix with the answers
    try:
        job = _receive(into)
        while True:
            _send(out, run_row(job, _receive(into)))
    except (EOFError, BrokenPipeError):
        return


class _Worker:
    def __init__(self, job: Job) -> None:
        self._job = job
        self._process: subprocess.Popen[bytes] | None = None

    def run(self, row: Row) -> Row:
        if self._process is None:
            one = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}  # the workers are the threads
            self._process = subprocess.Popen(
                [sys.executable, "-c", WORKER],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                start_new_session=True,  # Ctrl-C is the parent's
                env={**os.environ, **one, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)},
            )
            assert self._process.stdin is not None
            _send(self._process.stdin, self._job)
        assert self._process.stdin is not None and self._process.stdout is not None
        try:
            _send(self._process.stdin, row)
            answer: Row = _receive(self._process.stdout)
            return answer
        except (EOFError, BrokenPipeError):
            code = self._process.wait()
            self._process = None
            how = f"signal {signal.Signals(-code).name}" if code < 0 else f"exit code {code}"
            return {"status": "failed", "error": f"its process ended ({how})"}

    def close(self, *, kill: bool) -> None:
        if self._process is None:
            return
        if kill:
            self._process.kill()
        assert self._process.stdin is not None
        try:
            self._process.stdin.close()
        except BrokenPipeError:
            pass
        self._process.wait()


def drive_all(job: Job, rows: Iterable[Row], workers: int) -> Iterator[tuple[Row, Row]]:
    """Each row with what came of it, as they come; at most `workers` are under way, and twice as many wait to be taken.

    Closing the iterator lets no further row begin, and what is under way is given up.
    """
    if workers == 0:  # in this process
        for row in rows:
            yield row, run_row(job, row)
        return
    todo: queue.Queue[Row | None] = queue.Queue()
    done: queue.Queue[tuple[Row, Row]] = queue.Queue()
    crew = [_Worker(job) for _ in range(workers)]

    def work(worker: _Worker) -> None:
        while (row := todo.get()) is not None:
            try:
                done.put((row, worker.run(row)))
            except Exception as error:  # a worker that cannot be started: the campaign says so
                done.put((row, {"status": "broken", "error": repr(error)}))

    threads = [threading.Thread(target=work, args=(worker,), daemon=True) for worker in crew]
    for thread in threads:
        thread.start()
    source, under_way = iter(rows), 0
    finished = False
    try:
        while True:
            for row in itertools.islice(source, 2 * workers - under_way):
                todo.put(row)
                under_way += 1
            if under_way == 0:
                finished = True
                return
            pair = done.get()
            under_way -= 1
            if pair[1]["status"] == "broken":
                raise RuntimeError(pair[1]["error"])
            yield pair
    finally:
        if not finished:
            while not todo.empty():
                try:
                    todo.get_nowait()
                except queue.Empty:
                    break
        for _ in threads:
            todo.put(None)
        for worker in crew if not finished else ():
            worker.close(kill=True)
        for thread in threads:
            thread.join(5)
        for worker in crew if finished else ():
            worker.close(kill=False)
