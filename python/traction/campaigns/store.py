"""A campaign's folder: what is there is whole, whatever stopped the writer.

campaign.json   what it is, and the fingerprint of what its results depend on
rows.parquet    every drive's factors and seeds
results/        part-000000.parquet, ...: one row a drive, `part` rows a file, each written once and renamed into place
inbox/          drive-00000012.arrow: drives whose part is not full yet
logs/           drive-00000012.csv, where whole logs are kept
"""

from __future__ import annotations

import fcntl
import json
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .._errors import CampaignError
from .._parquet import write_table
from .spec import Row, Spec

FORMAT = "traction.campaign/1"


def schema_of(spec: Spec) -> Any:
    """The table's columns, known before the first drive; so a part does not depend on which drives failed."""
    import pyarrow as pa

    fields = [pa.field("drive", pa.int64()), pa.field("repeat", pa.int32()), pa.field("seed", pa.int64())]
    if spec.table.get("hide", 0):
        fields.append(pa.field("hide_seed", pa.int64()))
    fields += [pa.field(key, _type_of([point.get(key) for point in spec.points])) for key in spec.keys]
    fields += [
        pa.field("status", pa.string()),
        pa.field("error", pa.string()),
        pa.field("ticks", pa.int64()),
        pa.field("faults", pa.int64()),
    ]
    fields += [pa.field(name, pa.string()) for name in ("fault_names", "trace_hash", "hidden")]
    fields += [pa.field(name, pa.float64(), metadata={"formula": f.text}) for name, f in spec.formulas.items()]
    if spec.keep.get("diagnosis"):
        fields += [pa.field("verdict", pa.string()), pa.field("named", pa.string())]
        fields += [pa.field("error_before", pa.float64()), pa.field("error_after", pa.float64())]
    if spec.keep.get("columns"):
        fields += [pa.field(name, pa.list_(pa.float64())) for name in ("series.t_s", *(f"series.{c}" for c in spec.keep["columns"]))]
    return pa.schema(fields)


def _type_of(values: Iterable[Any]) -> Any:
    import pyarrow as pa

    kinds = {type(value) for value in values if value is not None}
    if kinds == {bool}:
        return pa.bool_()
    if kinds == {int}:
        return pa.int64()
    if kinds and kinds <= {int, float}:
        return pa.float64()
    return pa.string()


def table_of(schema: Any, rows: Iterable[Row]) -> Any:
    """Rows as a pyarrow table; a list or dict in a factor as JSON text."""
    import pyarrow as pa

    def cell(value: Any, kind: Any) -> Any:
        if value is None or not pa.types.is_string(kind):
            return value
        return value if isinstance(value, str) else json.dumps(value, sort_keys=True)

    return pa.Table.from_pylist([{f.name: cell(row.get(f.name), f.type) for f in schema} for row in rows], schema=schema)


class Store:
    """A campaign's folder, for its one writer and any readers."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)

    @contextmanager
    def writing(self, spec: Spec) -> Iterator[None]:
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
            yield
            lock.truncate(0)

    def _claim(self, spec: Spec) -> None:
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
            schema = schema_of(spec)
            keys = [f.name for f in schema][: schema.get_field_index("status")]
            import pyarrow as pa

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
        for drive in self.letters():  # a stop between a part's writing and its inbox's emptying
            if drive // spec.part in written:
                self._letter(drive).unlink(missing_ok=True)

    def about(self) -> dict[str, Any]:
        """campaign.json. Raises CampaignError where there is none."""
        try:
            about: dict[str, Any] = json.loads((self.folder / "campaign.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):
            mend = "give the folder of a campaign"
            raise CampaignError(f"{self.folder}: holds no campaign; to mend: {mend}", str(self.folder), mend=mend) from None
        return about

    def _letter(self, drive: int) -> Path:
        return self.folder / "inbox" / f"drive-{drive:08d}.arrow"

    def _part(self, part: int) -> Path:
        return self.folder / "results" / f"part-{part:06d}.parquet"

    def parts(self) -> list[int]:
        """Numbers of the parts that are written."""
        return sorted(int(p.stem[5:]) for p in (self.folder / "results").glob("part-*.parquet"))

    def letters(self) -> list[int]:
        """Numbers of the drives that are done and in no part yet."""
        return sorted(int(p.stem[6:]) for p in (self.folder / "inbox").glob("drive-*.arrow"))

    def put(self, drive: int, table: Any) -> None:
        """Keep a drive that is done."""
        import pyarrow as pa

        spare = self.folder / "inbox" / f".{drive}.tmp"
        with pa.OSFile(str(spare), "wb") as stream, pa.ipc.new_file(stream, table.schema) as writer:
            writer.write_table(table)
        os.replace(spare, self._letter(drive))

    def letter(self, drive: int, schema: Any) -> Any:
        """A drive from the inbox; None where a power cut left it torn: it is then driven again."""
        import pyarrow as pa

        try:
            with pa.OSFile(str(self._letter(drive)), "rb") as stream:
                table = pa.ipc.open_file(stream).read_all()
            return table if table.schema.equals(schema) else None
        except (OSError, pa.ArrowInvalid):
            self._letter(drive).unlink(missing_ok=True)
            return None

    def close_part(self, part: int, drives: range, schema: Any) -> None:
        """Writes a part whose drives are all in the inbox, then empties that."""
        import pyarrow as pa

        tables = [self.letter(drive, schema) for drive in drives]
        if any(table is None for table in tables):
            raise CampaignError(f"{self.folder}: a drive of part {part} is unreadable; to mend: run the campaign again, it is driven anew")
        write_table(pa.concat_tables(tables).combine_chunks(), self._part(part))
        for drive in drives:
            self._letter(drive).unlink(missing_ok=True)

    def columns(self) -> list[str]:
        """Names of the table's columns, in its order; empty where no drive is done."""
        import pyarrow as pa
        import pyarrow.parquet as pq

        if parts := self.parts():
            return list(pq.read_schema(self._part(parts[0])).names)
        for drive in self.letters():
            with pa.OSFile(str(self._letter(drive)), "rb") as stream:
                return list(pa.ipc.open_file(stream).schema.names)
        return []

    def table(self, columns: list[str] | None = None) -> Any:
        """Every drive that is done, in the order of rows; all columns, or these."""
        import pyarrow as pa
        import pyarrow.parquet as pq

        tables = [(part, pq.read_table(self._part(part), columns=columns)) for part in self.parts()]
        written, part_size = set(self.parts()), int(self.about()["part"])
        for drive in self.letters():
            if drive // part_size not in written:
                with pa.OSFile(str(self._letter(drive)), "rb") as stream:
                    table = pa.ipc.open_file(stream).read_all()
                tables.append((drive // part_size, table if columns is None else table.select(columns)))
        if not tables:
            return pq.read_table(self.folder / "rows.parquet").slice(0, 0)
        return pa.concat_tables([table for _, table in sorted(tables, key=lambda item: item[0])])
