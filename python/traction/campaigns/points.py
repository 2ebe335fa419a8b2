"""A campaign's finished rows as numbers: what pictures and analyses are made of."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .._errors import CampaignError
from .spec import _flat
from .store import Store

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Factor:
    """What varies. A number stands for itself, a text for its place among `labels`; NaN where a row gives none.

    Attributes:
        name: the key of the scenario.
        values: one a finished row, float64 of shape (rows,), in the unit that the name tells.
        design: one a row of the whole campaign, finished or not, shape (drives,).
        labels: the texts, sorted; empty for a number.
        log: whether it goes evenly by its logarithm.

    """

    name: str
    values: Floats
    design: Floats
    labels: tuple[str, ...] = ()
    log: bool = False


@dataclass(frozen=True, eq=False)
class Points:
    """The rows that are done, with what varies and what came of it.

    Attributes:
        title, method: the campaign's.
        drives: rows of the whole campaign; done, failed: of them.
        drive, repeat: int64 of shape (done,).
        repeats: drives of each point.
        factors: those that vary, numbers and texts.
        figures: name and values, float64 of shape (done,); NaN where a formula gave no number.
        notes: what was left out, in words.

    """

    title: str
    method: str
    drives: int
    failed: int
    drive: npt.NDArray[np.int64]
    repeat: npt.NDArray[np.int64]
    repeats: int
    factors: tuple[Factor, ...]
    figures: dict[str, Floats]
    notes: tuple[str, ...]

    @property
    def done(self) -> int:
        """Rows that are done and did not fail."""
        return len(self.drive)

    @property
    def rows_told(self) -> str:
        """How many rows these are, in words."""
        waiting = self.drives - self.done - self.failed
        failed = f", {self.failed} failed and left out" if self.failed else ""
        return f"{self.done} of {self.drives} drives{failed}" + (f", {waiting} not driven yet" if waiting else "")


def read_points(store: Store) -> Points:
    """The finished rows of a campaign's folder. Raises CampaignError where there is no figure, finished row, or number that varies."""
    import pyarrow.parquet as pq

    where, about = str(store.folder), store.about()
    spec = about["spec"]
    keep = spec.get("keep", {})
    figures = [*keep.get("figures", {}), *(("error_before", "error_after") if keep.get("diagnosis") else ())]
    if "kind" in spec:
        raise _cannot(where, "is a bench of the lab", "look at its table: traction campaign --status --out FOLDER")
    if not figures:
        raise _cannot(where, "keeps no figure", "write [keep.figures] with a formula each, or diagnosis, and drive it into another folder")
    rows = pq.read_table(store.folder / "rows.parquet")
    keys = [name for name in rows.column_names if name not in ("drive", "repeat", "seed", "hide_seed")]
    figures = [name for name in store.columns() if name in figures]  # in the table's order
    if not figures:
        raise _cannot(where, f"none of its {rows.num_rows} drives is finished", "drive it: traction campaign FILE.toml --out FOLDER")
    table = store.table(["drive", "repeat", "status", "error", *figures])
    status = table.column("status").to_pylist()
    order = np.array([i for i, word in enumerate(status) if word == "done"], dtype=np.int64)
    failed = len(status) - len(order)
    if not len(order):
        first = next(word for word in table.column("error").to_pylist() if word)
        raise _cannot(where, f"all {failed} finished drives failed, the first with: {first}", "mend what the column `error` tells")
    taken = table.take(order).sort_by("drive")
    drive = taken.column("drive").to_numpy()
    ranges = {key: value for key, value in _flat(spec.get("vary", {})).items() if isinstance(value, dict)}
    factors, notes = list[Factor](), list[str]()
    for key in keys:
        factor = _factor(key, rows.column(key).to_pylist(), drive, bool(ranges.get(key, {}).get("log", False)))
        if isinstance(factor, Factor):
            factors.append(factor)
        else:
            notes.append(f"{key} {factor}: left out")
    if not any(not factor.labels for factor in factors):
        left = f" ({'; '.join(notes)})" if notes else ""
        raise _cannot(where, f"has no number that varies{left}", "give a factor of numbers under [vary], at least two of them")
    return Points(
        title=str(about["title"]),
        method=str(spec.get("method", "list" if spec.get("row") else "grid")),
        drives=rows.num_rows,
        failed=failed,
        drive=drive,
        repeat=taken.column("repeat").to_numpy().astype(np.int64),
        repeats=int(spec.get("repeats", 1)),
        factors=tuple(factors),
        figures={name: _finite(taken.column(name).to_pylist()) for name in figures},
        notes=tuple(notes),
    )


def _cannot(where: str, what: str, mend: str) -> CampaignError:
    return CampaignError(f"{where}: {what}, so there is nothing to plot; to mend: {mend}", where, mend=mend)


def _finite(values: Sequence[float | None]) -> Floats:
    out = np.array([math.nan if value is None else value for value in values], dtype=np.float64)
    out[~np.isfinite(out)] = math.nan
    return out


def _factor(name: str, given: Sequence[Any], drive: npt.NDArray[np.int64], log: bool) -> Factor | str:
    """The factor, or why it is none."""
    present = [value for value in given if value is not None]
    if len(set(present)) < 2:
        return "does not vary"
    if all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in present):
        design = _finite(given)
        return Factor(name, design[drive], design, (), log and bool(np.nanmin(design) > 0))
    words = [None if value is None else str(value).lower() if isinstance(value, bool) else str(value) for value in given]
    labels = tuple(sorted({word for word in words if word is not None}))
    place = {label: float(i) for i, label in enumerate(labels)}
    design = np.array([math.nan if word is None else place[word] for word in words], dtype=np.float64)
    return Factor(name, design[drive], design, labels)
