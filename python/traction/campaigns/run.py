"""Running a campaign, and its results."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import _html
from .._errors import CampaignError
from . import cluster
from .lab_bench import LabSpec, LabTable, clear_scratch, plan_of, read_plan, tables_of
from .picture import check_ending, draw
from .plan import Plan
from .points import read_points
from .pool import drive_all
from .sensitivity import Sensitivity, analyse
from .spec import Spec
from .store import Store


@dataclass(frozen=True)
class Progress:
    """How far a campaign is: drives `done` (of them `failed`), of `total`; `rate` of this run in drives a second, `left_s` by that rate."""

    done: int
    failed: int
    total: int
    rate: float
    left_s: float


class Campaign:
    """A campaign's folder and what is in it."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self._store = Store(folder)
        self._about = self._store.about()

    @property
    def folder(self) -> Path:
        """Where it is."""
        return self._store.folder

    @property
    def title(self) -> str:
        """For people."""
        return str(self._about["title"])

    @property
    def spec(self) -> dict[str, Any]:
        """What it was asked for."""
        return dict(self._about["spec"])

    def table(self) -> Any:
        """Every drive that is done, one row each, in the order of rows: a pyarrow table."""
        return self._store.table()

    def to_pandas(self) -> Any:
        """The same as a pandas frame."""
        return self.table().to_pandas()

    def times(self) -> Any:
        """What is another each time, as a pyarrow table: `drive` and processor times in s, of every drive that is done.

        None where none is kept. So the table is the same, bit for bit, and these are not.
        """
        return self._store.times()

    def tables(self) -> list[LabTable]:
        """Of a lab's bench or round trip, the tables that its own judge makes of the rows that are done, one a generator and category.

        Empty for every other campaign. Raises CampaignError where the judge's program is not built here.
        """
        return tables_of(self._about["spec"], self._store)

    def sensitivity(self) -> Sensitivity:
        """The effect of each factor on each figure, of the drives that are done, by Sobol indices or what comes nearest (extra `plot`).

        Raises CampaignError where there is no figure, no drive that is done or no number that varies; ImportError without SALib.
        """
        return analyse(read_points(self._store))

    def plot(self, file: str | os.PathLike[str]) -> Sensitivity:
        """Write one picture of the drives that are done: parallel coordinates, each figure over each factor, effects (extra `plot`).

        Args:
            file: where to, ending in .svg or .png; it needs no other file. The same rows make the same bytes.

        Returns:
            the effects that it shows.

        Raises CampaignError as `sensitivity` does, FileError for a file that cannot be written, ImportError without SALib or matplotlib.

        """
        check_ending(file)
        points = read_points(self._store)
        told = analyse(points)
        draw(points, told, file)
        return told

    @property
    def status(self) -> Progress:
        """How far it is; `rate` and `left_s` are NaN, for nothing is running here."""
        table = self._store.table(["status"])
        failed = table.column("status").to_pylist().count("failed") if "status" in table.column_names else 0
        return Progress(table.num_rows, failed, int(self._about["drives"]), float("nan"), float("nan"))

    def __repr__(self) -> str:
        status = self.status
        return f"<Campaign {self.title!r}: {status.done} of {status.total} drives, {status.failed} failed>"

    def _repr_html_(self) -> str:
        table = self.table()
        names = [n for n in table.column_names if not n.startswith("series.")]
        rows = [[row[n] for n in names] for row in table.select(names).slice(0, 10).to_pylist()]
        return _html.table(repr(self)[1:-1], names, rows)


def campaign(
    spec: Spec | LabSpec | str | os.PathLike[str] | Mapping[str, Any],
    folder: str | os.PathLike[str],
    *,
    workers: int | None = None,
    scheduler: Any = None,
    progress: Callable[[Progress], None] | None = None,
) -> Campaign:
    """Run a campaign, or go on with one that was stopped: what is done is not driven again.

    Args:
        spec: a TOML file, or a dict of its keys (docs/campaign.md).
        folder: where results go; made where it is not there. One campaign a folder, one writer at a time.
        workers: processes; None for one a core, 0 for this process alone. The table is the same, bit for bit.
        scheduler: address of a Dask scheduler ("tcp://host:8786"), or a distributed.Client: its workers drive instead of processes here.
        progress: called after each drive, at most ten times a second.

    Returns:
        the campaign; `table()` and `to_pandas()` have one row a drive. A drive that failed is a row with its message.

    Raises CampaignError for a specification or folder that cannot be meant. Ctrl-C stops it; call it again to go on.

    """
    if isinstance(spec, Mapping):
        spec = plan_of(spec)
    elif not isinstance(spec, (Spec, LabSpec)):
        spec = read_plan(spec)
    store = Store(folder)
    if workers is None:
        workers = len(os.sched_getaffinity(0))
    with store.writing(spec):
        _run(spec, store, workers, scheduler, progress)
    return Campaign(folder)


def plot_campaign(folder: str | os.PathLike[str], out: str | os.PathLike[str]) -> Sensitivity:
    """Write the picture of the campaign in `folder` to `out` (.svg or .png): `Campaign(folder).plot(out)`."""
    return Campaign(folder).plot(out)


def _run(spec: Plan, store: Store, workers: int, scheduler: Any, progress: Callable[[Progress], None] | None) -> None:
    schema, rows, size = spec.schema(), spec.rows, spec.part
    parts = set(store.parts())
    kept, failed = dict[int, set[int]](), 0  # drives in the inbox, by part
    for part, known in store.waiting():
        kept[part] = {row["drive"] for row in known}
        failed += sum(row["status"] == "failed" for row in known)
    of_part = [range(first, min(first + size, len(rows))) for first in range(0, len(rows), size)]
    done = sum(len(drives) for drives in kept.values()) + sum(len(of_part[part]) for part in parts)
    for part in [part for part, drives in kept.items() if len(drives) == len(of_part[part])]:
        store.close_part(part, of_part[part], schema)
        parts.add(part)
    todo = (row for row in rows if row["drive"] // size not in parts and row["drive"] not in kept.get(row["drive"] // size, ()))
    began, before, told = time.monotonic(), done, 0.0
    job = spec.task(store.folder)
    for row, answer in drive_all(job, todo, workers) if scheduler is None else cluster.drive_all(job, todo, scheduler):
        if answer["status"] == "broken":
            raise CampaignError(str(answer["error"]))
        drive, part = row["drive"], row["drive"] // size
        store.put(part, {"drive": drive, **row, **answer})
        kept.setdefault(part, set()).add(drive)
        if len(kept[part]) == len(of_part[part]):
            store.close_part(part, of_part[part], schema)
            del kept[part]
        done += 1
        failed += answer["status"] == "failed"
        now = time.monotonic()
        if progress is not None and (now - told > 0.1 or done == len(rows)):
            told = now
            rate = (done - before) / max(now - began, 1e-9)
            progress(Progress(done, failed, len(rows), rate, (len(rows) - done) / rate))
    clear_scratch(store.folder)


def bar(title: str) -> Callable[[Progress], None]:
    """A line on the terminal with rate and time left; into a file, a line every ten seconds."""
    last = [0.0]

    def show(p: Progress) -> None:
        live, ended = sys.stderr.isatty(), p.done == p.total
        if not live and not ended and time.monotonic() - last[0] < 10:
            return
        last[0] = time.monotonic()
        failed = f", {p.failed} failed" if p.failed else ""
        line = f"{title}: {p.done} of {p.total} drives{failed}, {p.rate:.1f} a second, {p.left_s:.0f} s left"
        print(f"\r\033[K{line}" if live else line, end="" if live and not ended else "\n", file=sys.stderr, flush=True)

    return show
