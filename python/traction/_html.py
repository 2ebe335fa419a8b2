"""What a notebook shows. Colours and fonts are the notebook's own."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .log import Log


def text(words: str) -> str:
    """Words as HTML, between tags."""
    return html.escape(words, quote=False)


def table(title: str, heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table with a caption; every cell escaped."""
    head = "".join(f"<th>{text(h)}</th>" for h in heads)
    body = "".join("<tr>" + "".join(f"<td>{text(str(cell))}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><caption>{text(title)}</caption><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def number(value: float | None, digits: int = 3) -> str:
    """A number for people; a dash where there is none."""
    return "-" if value is None or value != value else f"{value:.{digits}g}"


def log(given: Log) -> str:
    """A log's columns."""
    rows = []
    for name in list(given)[:100]:
        column = given[name]
        span = f"{column.values.min():.4g} to {column.values.max():.4g}" if len(column) else "empty"
        rows.append((name, column.unit, len(column), span, column.meaning))
    more = f"<p>and {len(given) - 100} more columns</p>" if len(given) > 100 else ""
    mended = "".join(f"<li>{text(line)}</li>" for line in given.repairs)
    title = f"log {given.source}: {len(given)} columns, {given.duration_s:.2f} s"
    return table(title, ("column", "unit", "samples", "range", "meaning"), rows) + more + (f"<ul>{mended}</ul>" if mended else "")


def ladder(steps: Iterable[tuple[str, float | None, float | None, float | None]]) -> str:
    """How the error fell, a step a line."""
    rows = [(label, number(train), number(heldout), number(floor)) for label, train, heldout, floor in steps]
    return table("ladder: error in units of noise", ("model", "on training", "held out", "floor"), rows)
