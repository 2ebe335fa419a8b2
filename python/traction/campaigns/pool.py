"""Local workers: processes that drive one row at a time, so that a row which ends its process is known and does not end the campaign."""

from __future__ import annotations

import os
import pickle
import selectors
import signal
import struct
import subprocess
import sys
import time
from collections import deque
from collections.abc import Iterable, Iterator
from typing import IO, Any

from .drive import run_row
from .plan import Row, Task

WORKER = "from traction.campaigns.pool import serve; serve()"  # what a worker runs
SMALL = 4096  # bytes: the smallest pipe takes so much without waiting for its reader
QUICK_S = 1.0  # a worker whose drives take less has the next one at hand; longer ones are dealt out as they are wanted


def _framed(what: Any) -> bytes:
    data = pickle.dumps(what)
    return struct.pack("<Q", len(data)) + data


def _send(stream: IO[bytes], what: Any) -> None:
    stream.write(_framed(what))
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
    """A process and the rows that it was given: the one that it drives, and where drives are quick the next one, not to wait for it."""

    def __init__(self, job: Task, ready: selectors.BaseSelector) -> None:
        self._job, self._ready = job, ready
        self._process: subprocess.Popen[bytes] | None = None
        self._rows: deque[tuple[Row, bytes]] = deque()
        self._sent = 0  # of these
        self._heard = bytearray()
        self._since = 0.0
        self._quick = False

    @property
    def busy(self) -> bool:
        return bool(self._rows)

    @property
    def room(self) -> int:
        """Rows that it can be given."""
        return (2 if self._quick else 1) - len(self._rows)

    def give(self, row: Row) -> None:
        if not self._rows:
            self._since = time.monotonic()
        self._rows.append((row, _framed(row)))
        self._push()

    def _push(self) -> None:
        if self._process is None:
            self._start()
        assert self._process is not None and self._process.stdin is not None
        try:
            while self._sent < len(self._rows):
                data = self._rows[self._sent][1]
                if self._sent and len(data) > SMALL:
                    return  # a long one waits here: were the pipe full, both sides would wait for each other
                self._process.stdin.write(data)
                self._process.stdin.flush()
                self._sent += 1
        except BrokenPipeError:
            pass  # its answers end too, and tell how

    def _start(self) -> None:
        one = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}  # the workers are the threads
        self._process = subprocess.Popen(
            [sys.executable, "-c", WORKER],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            start_new_session=True,  # Ctrl-C is the parent's
            env={**os.environ, **one, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)},
        )
        assert self._process.stdin is not None and self._process.stdout is not None
        self._heard.clear()
        self._sent = 0
        self._ready.register(self._process.stdout, selectors.EVENT_READ, self)
        _send(self._process.stdin, self._job)

    def take(self) -> Iterator[tuple[Row, Row]]:
        """What it answered."""
        assert self._process is not None and self._process.stdout is not None
        data = os.read(self._process.stdout.fileno(), 1 << 20)
        if not data:
            yield from self._ended()
            return
        self._heard += data
        while len(self._heard) >= 8:
            end = 8 + struct.unpack_from("<Q", self._heard)[0]
            if len(self._heard) < end:
                return
            answer = pickle.loads(self._heard[8:end])
            del self._heard[:end]
            now = time.monotonic()
            self._quick, self._since = now - self._since < QUICK_S, now
            row, _ = self._rows.popleft()
            self._sent -= 1
            self._push()
            yield row, answer

    def _ended(self) -> Iterator[tuple[Row, Row]]:
        """The row that it drove failed; the next one is given to a new process."""
        assert self._process is not None and self._process.stdout is not None
        self._ready.unregister(self._process.stdout)
        self.close(kill=False)
        code = self._process.wait()
        self._process = None
        if not self._rows:
            return
        how = f"signal {signal.Signals(-code).name}" if code < 0 else f"exit code {code}"
        row, _ = self._rows.popleft()
        if self._rows:
            self._push()
        yield row, {"status": "failed", "error": f"its process ended ({how})"}

    def close(self, *, kill: bool) -> None:
        if self._process is None:
            return
        if kill:
            try:
                os.killpg(self._process.pid, signal.SIGKILL)  # and what it runs
            except ProcessLookupError:
                pass
        assert self._process.stdin is not None and self._process.stdout is not None
        try:
            self._process.stdin.close()
        except BrokenPipeError:
            pass
        self._process.wait()
        self._process.stdout.close()


def drive_all(job: Task, rows: Iterable[Row], workers: int) -> Iterator[tuple[Row, Row]]:
    """Each row with what came of it, as they come; a worker has one row under way, and one more where drives are quick.

    Closing the iterator lets no further row begin, and what is under way is given up.
    """
    if workers == 0:  # in this process
        for row in rows:
            yield row, run_row(job, row)
        return
    source = iter(rows)
    finished = False
    with selectors.DefaultSelector() as ready:
        crew = [_Worker(job, ready) for _ in range(workers)]
        try:
            while True:
                for worker in sorted(crew, key=lambda one: -one.room):
                    while worker.room > 0 and (following := next(source, None)) is not None:
                        worker.give(following)
                if not any(worker.busy for worker in crew):
                    finished = True
                    return
                for key, _ in ready.select():
                    yield from key.data.take()
        finally:
            for worker in crew:
                worker.close(kill=not finished)
