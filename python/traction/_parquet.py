"""Parquet files that are whole or not there."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any


def write_table(table: Any, file: str | os.PathLike[str]) -> None:
    """Write a pyarrow table under a temporary name beside `file`, flush it to the disk, then rename it."""
    import pyarrow.parquet as pq

    path = Path(file)
    spare = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        with open(spare, "wb") as stream:
            pq.write_table(table, stream, compression="zstd")
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(spare, path)
    finally:
        spare.unlink(missing_ok=True)
