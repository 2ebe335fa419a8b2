"""What a campaign's folder and its workers ask of a campaign, of whatever kind."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Protocol

Row = dict[str, Any]
LAYOUT = 2  # of a campaign's folder (store.py): one that was written otherwise is not gone on with


class Task(Protocol):
    """What all drives of a campaign have in common. It can be pickled."""

    def run(self, row: Row) -> Row:
        """What a row's table row has beside its factors; `status` among it. Raises what `drive.run_row` makes a failed row of."""
        ...


class Plan(Protocol):
    """A campaign that was read and found sound."""

    @property
    def table(self) -> dict[str, Any]:
        """What was asked for."""
        ...

    @property
    def title(self) -> str:
        """For people."""
        ...

    @property
    def part(self) -> int:
        """Rows of a Parquet file."""
        ...

    @property
    def rows(self) -> list[Row]:
        """Every drive: `drive`, its number from 0, then its factors and seeds."""
        ...

    @property
    def fingerprint(self) -> str:
        """Of everything that the results depend on."""
        ...

    def schema(self) -> Any:
        """The table's columns (pyarrow), known before the first drive; so a part does not depend on which drives failed."""
        ...

    def task(self, folder: str | os.PathLike[str]) -> Task:
        """Of a campaign that writes into `folder`."""
        ...


def apart(name: str, kind: Any) -> Any:
    """A column that is another each time: it goes to `times/`, not to the table."""
    import pyarrow as pa

    return pa.field(name, kind, metadata={"apart": "times"})


def plain(table: Mapping[str, Any]) -> dict[str, Any]:
    """Without what is for people."""
    return {key: value for key, value in table.items() if key not in ("title", "about")}
