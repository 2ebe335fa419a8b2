"""A campaign's folder: what is there is whole, whatever stopped the writer.

campaign.json   what it is, and the fingerprint of what its results depend on
rows.parquet    every drive's factors and seeds
columns.parquet the table's columns, without a row
results/        part-000000.parquet, ...: one row a drive, `part` rows a file, each written once and renamed into place
times/          part-000000.parquet, ...: what is another each time (processor time), where a campaign keeps it
inbox/          part-000000.jsonl, ...: drives whose part is not full yet, a line of JSON each, written as they come
logs/           drive-00000012.csv, where whole logs are kept
"""

from __future__ import annotations

import fcntl
import json
import os
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .._errors import CampaignError
from .._parquet import write_table
from .plan import Plan, Row

FORMAT = "traction.campaign/1"
HEAD = re.compile(rb'\{"drive": (\d+)[,}]')  # what a line of an inbox begins with
SLICE = 64  # rows that are brought from JSON to columns at once: long series are not all in memory as Python's numbers


def table_of(schema: Any, rows: Iterable[Row]) -> Any:
    """Rows as a pyarrow table; a list or dict in a factor as JSON text."""
    import pyarrow as pa

    def cell(value: Any, kind: Any) -> Any:
        if value is None or not pa.types.is_string(kind):
            return value
        return value if isinstance(value, str) else json.dumps(value, sort_keys=True)

    return pa.Table.from_pylist([{f.name: cell(row.get(f.name), f.type) for f in schema} for row in rows], schema=schema)


def _sound(data: bytes) -> Iterator[tuple[bytes, Row | None]]:
    """Lines of an inbox, each with its row. None where a stop or a power cut left it torn."""
    for line in data.splitlines(keepends=True):
        row: Row | None = None
        if line.endswith(b"\n"):
            try:
                told = json.loads(line)
                row = told if isinstance(told, dict) and isinstance(told.get("drive"), int) else None
            except ValueError:
                pass
        yield line, row


class Store:
    """A campaign's folder, for its one writer and any readers."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        self._open: dict[int, Any] = {}  # inboxes of the writer

    @contextmanager
    def writing(self, spec: Plan) -> Iterator[None]:
        """Claims the folder for `spec`, makes it on the first run, and sees on later ones that it is the same campaign."""
        self.folder.mkdir(parents=True, exist_ok=True)
        with open(self.folder / ".lock", "a+", encoding="utf-8") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                lock.seek(0)
                who = lock.read().strip() or "another process"
                mend = "wait for it, or give another folder"
                raise CampaignError(f"{self.folder}: is being written by {who}; to mend: {mend}", str(self.folder), mend=mend) from None
            lock.truncate(0)
            lock.write(f"process {os.getpid()} on {os.uname().nodename}: campaign {spec.title!r}\n")
            lock.flush()
            self._claim(spec)
            try:
                yield
            finally:
                for stream in self._open.values():
                    stream.close()
                self._open.clear()
            lock.truncate(0)

    def _claim(self, spec: Plan) -> None:
        known = self.folder / "campaign.json"
        if known.exists():
            there = self.about()
            if there["fingerprint"] != spec.fingerprint:
                mend = "give another folder"
                what = f"holds the campaign {there['title']!r}: other factors, files or another build of Traction"
                raise CampaignError(f"{self.folder}: {what}; to mend: {mend}", str(self.folder), mend=mend)
        else:
            others = [p.name for p in self.folder.iterdir() if p.name != ".lock"]
            if others:
                mend = "give an empty folder, or a new one"
                raise CampaignError(f"{self.folder}: holds {others[0]!r} and no campaign; to mend: {mend}", str(self.folder), mend=mend)
            schema = spec.schema()
            keys = [f.name for f in schema][: schema.get_field_index("status")]
            import pyarrow as pa

            write_table(schema.empty_table(), self.folder / "columns.parquet")
            write_table(table_of(pa.schema([schema.field(k) for k in keys]), spec.rows), self.folder / "rows.parquet")
            about = {
                "schema": FORMAT,
                "title": spec.title,
                "fingerprint": spec.fingerprint,
                "drives": len(spec.rows),
                "part": spec.part,
                "spec": spec.table,
            }
            spare = self.folder / ".campaign.json.tmp"
            spare.write_text(json.dumps(about, indent=1, sort_keys=True) + "\n", encoding="utf-8")
            os.replace(spare, known)
        for name in ("results", "inbox"):
            (self.folder / name).mkdir(exist_ok=True)
        written = set(self.parts())
        for part in self._inboxes():
            if part in written:  # a stop between a part's writing and its inbox's removal
                self._inbox(part).unlink(missing_ok=True)
            else:
                self._mend(part)

    def _mend(self, part: int) -> None:
        """Takes torn lines out of an inbox: their drives are driven again."""
        sound = list(_sound(self._inbox(part).read_bytes()))
        if all(row is not None for _, row in sound):
            return
        spare = self.folder / "inbox" / f".{part}.tmp"
        spare.write_bytes(b"".join(line for line, row in sound if row is not None))
        os.replace(spare, self._inbox(part))

    def about(self) -> dict[str, Any]:
        """campaign.json. Raises CampaignError where there is none."""
        try:
            about: dict[str, Any] = json.loads((self.folder / "campaign.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):
            mend = "give the folder of a campaign"
            raise CampaignError(f"{self.folder}: holds no campaign; to mend: {mend}", str(self.folder), mend=mend) from None
        return about

    def _inbox(self, part: int) -> Path:
        return self.folder / "inbox" / f"part-{part:06d}.jsonl"

    def _inboxes(self) -> list[int]:
        return sorted(int(p.stem[5:]) for p in (self.folder / "inbox").glob("part-*.jsonl"))

    def _part(self, part: int, folder: str = "results") -> Path:
        return self.folder / folder / f"part-{part:06d}.parquet"

    def parts(self) -> list[int]:
        """Numbers of the parts that are written."""
        return sorted(int(p.stem[5:]) for p in (self.folder / "results").glob("part-*.parquet"))

    def waiting(self) -> Iterator[tuple[int, list[Row]]]:
        """Parts that are not written yet, each with the drives of it that are done, in the order of rows."""
        written = set(self.parts())
        for part in self._inboxes():
            if part in written:
                continue
            try:
                data = self._inbox(part).read_bytes()
            except FileNotFoundError:  # its part was written meanwhile
                continue
            rows = {row["drive"]: row for _, row in _sound(data) if row is not None}
            yield part, [rows[drive] for drive in sorted(rows)]

    def put(self, part: int, row: Row) -> None:
        """Keep a drive that is done: one line, in the file when this returns."""
        stream = self._open.get(part)
        if stream is None:
            stream = self._open[part] = open(self._inbox(part), "ab", buffering=0)
        line = memoryview(json.dumps(row, default=_number).encode() + b"\n")
        while line:
            line = line[stream.write(line) :]

    def close_part(self, part: int, drives: range, schema: Any) -> None:
        """Writes a part whose drives are all in the inbox, then removes that."""
        import pyarrow as pa

        if part in self._open:
            self._open.pop(part).close()
        offsets, data = dict[int, tuple[int, int]](), self._inbox(part).read_bytes()
        at = 0
        for line in data.splitlines(keepends=True):
            if found := HEAD.match(line):
                offsets[int(found[1])] = (at, at + len(line))
            at += len(line)
        if any(drive not in offsets for drive in drives):
            raise CampaignError(f"{self.folder}: a drive of part {part} is unreadable; to mend: run the campaign again, it is driven anew")
        slices = [range(first, min(first + SLICE, drives.stop)) for first in range(drives.start, drives.stop, SLICE)]
        tables = [table_of(schema, [json.loads(data[slice(*offsets[drive])]) for drive in some]) for some in slices]
        table = pa.concat_tables(tables).combine_chunks()
        apart = [field.name for field in schema if _apart(field)]
        if apart:
            (self.folder / "times").mkdir(exist_ok=True)
            write_table(table.select(["drive", *apart]), self._part(part, "times"))
        write_table(table.drop_columns(apart), self._part(part))
        self._inbox(part).unlink(missing_ok=True)

    def _schema(self) -> Any:
        import pyarrow.parquet as pq

        return pq.read_schema(self.folder / "columns.parquet")

    def columns(self) -> list[str]:
        """Names of the table's columns, in its order; empty where no drive is done."""
        if not self.parts() and not any(rows for _, rows in self.waiting()):
            return []
        return [field.name for field in self._schema() if not _apart(field)]

    def table(self, columns: list[str] | None = None) -> Any:
        """Every drive that is done, in the order of rows; all columns, or these."""
        schema = self._schema()
        return self._read("results", schema, [f.name for f in schema if not _apart(f)] if columns is None else columns)

    def times(self) -> Any:
        """What is another each time, of every drive that is done: `drive` and the columns that are kept apart; None where none is."""
        schema = self._schema()
        apart = [field.name for field in schema if _apart(field)]
        return self._read("times", schema, ["drive", *apart]) if apart else None

    def _read(self, folder: str, schema: Any, names: list[str]) -> Any:
        import pyarrow as pa
        import pyarrow.parquet as pq

        wanted = pa.schema([schema.field(name) for name in names])
        tables = [(part, table_of(wanted, rows)) for part, rows in self.waiting()]  # first: what is written meanwhile is then in both
        known = {part for part, _ in tables}
        tables += [(part, pq.read_table(self._part(part, folder), columns=names)) for part in self.parts() if part not in known]
        if not tables:
            return wanted.empty_table()
        return pa.concat_tables([table for _, table in sorted(tables, key=lambda item: item[0])])


def _apart(field: Any) -> bool:
    """Whether a column is no part of the table, for it is another each time (plan.apart)."""
    return b"apart" in (field.metadata or {})


def _number(value: Any) -> Any:
    return value.item()  # NumPy's
