"""A campaign in one picture: parallel coordinates, each figure over each factor, and the effect of each factor on each figure."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .._errors import FileError
from .._extras import extra
from .points import Factor, Floats, Points
from .sensitivity import Effects, Sensitivity

ENDINGS = (".svg", ".png")
LABELS = 20  # texts on an axis: more cannot be read
LINES = 2000  # of the parallel coordinates: more cannot be told apart
AS_PIXELS = 2000  # marks of a panel beyond which an SVG holds them as an image
FIRST, TOTAL, MARK, GREY = "#3b6ea5", "#d98c3f", "#3b6ea5", "#777777"


def check_ending(file: str | os.PathLike[str]) -> Path:
    """Where a picture goes. Raises FileError for an ending that is neither .svg nor .png."""
    path = Path(file)
    if path.suffix not in ENDINGS:
        mend = "let it end in .svg or .png"
        raise FileError(f"{path}: is no picture's name; to mend: {mend}", str(path), mend=mend)
    return path


def draw(points: Points, told: Sensitivity, file: str | os.PathLike[str]) -> None:
    """Write the picture, SVG or PNG by its ending: whole or not at all, the same bytes for the same rows."""
    path = check_ending(file)
    matplotlib = extra("matplotlib", "plot")
    canvas = extra("matplotlib.backends.backend_agg", "plot").FigureCanvasAgg  # no display, no window
    plain = {k: v for k, v in matplotlib.rcParamsDefault.items() if k not in ("backend", "backend_fallback", "interactive")}
    own = {"font.size": 8, "axes.titlesize": 8, "axes.grid": True, "grid.alpha": 0.25, "svg.hashsalt": "traction", "savefig.dpi": 110}
    spare = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    with matplotlib.rc_context({**plain, **own}):  # a user's matplotlibrc changes nothing
        picture = _picture(points, told)
        canvas(picture)
        nothing = {"Date": None, "Creator": None} if path.suffix == ".svg" else {"Software": None}
        try:
            picture.savefig(spare, format=path.suffix[1:], metadata=nothing)
            os.replace(spare, path)
        except OSError as error:
            mend = "give a place that can be written"
            raise FileError(f"{path}: {error.strerror}; to mend: {mend}", str(path), mend=mend) from None
        finally:
            spare.unlink(missing_ok=True)


def _picture(points: Points, told: Sensitivity) -> Any:
    columns, rows = len(points.factors) + 1, len(points.figures)
    bars = 0.6 + 0.3 * len(points.factors)
    heights = [3.0, *[max(2.2, bars)] * rows]
    picture = extra("matplotlib.figure", "plot").Figure(figsize=(max(9.0, 2.5 * columns + 1.2), sum(heights) + 1.6), layout="constrained")
    grid = picture.add_gridspec(rows + 1, columns, height_ratios=heights, width_ratios=[*[1.0] * (columns - 1), 1.5])
    words = [points.title, points.rows_told, f"Right: {told.words}.", *_notes(points)]
    picture.suptitle(_safe("\n".join(words)), x=0.01, ha="left", fontsize=9)
    _parallel(picture.add_subplot(grid[0, :]), points)
    for row, (name, values) in enumerate(points.figures.items(), 1):
        for column, factor in enumerate(points.factors):
            axes = picture.add_subplot(grid[row, column])
            _scatter(axes, points, factor, values)
            axes.set_xlabel(_safe(factor.name))
            axes.set_ylabel(_safe(name) if column == 0 else "")
        _effects(picture.add_subplot(grid[row, columns - 1]), name, told.figures[name], [factor.name for factor in points.factors])
    return picture


def _notes(points: Points) -> list[str]:
    notes = list(points.notes)
    for name, values in points.figures.items():
        if missing := int(np.isnan(values).sum()):
            notes.append(f"{name}: {missing} rows are no number and left out")
    if points.done > LINES:
        notes.append(f"parallel coordinates: {LINES} of {points.done} rows, evenly taken")
    if points.repeats > 1:
        notes.append("scatter: mean of each point, bar: its standard deviation over seeds")
    return ["; ".join(notes[at : at + 3]) for at in range(0, len(notes), 3)]


def _safe(words: str) -> str:
    """Without matplotlib's mathematics."""
    return words.replace("$", r"\$")


def _short(word: str) -> str:
    return _safe(word if len(word) <= 18 else word[:17] + "\u2026")


def _share(values: Floats, log: bool) -> Floats:
    """Places between the least and the largest, 0 to 1; what stands still is in the middle."""
    scaled = np.log(values) if log else values
    low, high = np.nanmin(scaled), np.nanmax(scaled)
    return (scaled - low) / (high - low) if high > low else np.where(np.isnan(scaled), np.nan, 0.5)


def _parallel(axes: Any, points: Points) -> None:
    """A line a row through its factors and figures; coloured by the first figure that varies."""
    figures = [Factor(name, values, values) for name, values in points.figures.items() if not np.isnan(values).all()]
    leading = next((i for i, figure in enumerate(figures) if np.nanmin(figure.values) < np.nanmax(figure.values)), None)
    shown = [*points.factors, *figures]
    places = np.column_stack([_share(factor.values, factor.log) for factor in shown])
    sound = np.flatnonzero(~np.isnan(places).any(axis=1))
    if len(sound) > LINES:
        sound = sound[np.linspace(0, len(sound) - 1, LINES).astype(np.int64)]
    places = places[sound]
    at = np.arange(len(shown))
    collections = extra("matplotlib.collections", "plot")
    lines = collections.LineCollection(
        [np.column_stack([at, place]) for place in places],
        cmap="viridis",
        linewidths=0.7,
        alpha=max(0.08, min(0.8, 60 / max(1, len(places)))),
        rasterized=len(places) > AS_PIXELS // 4,
    )
    lines.set_clip_on(False)  # it is inside; and the name of its clip path was seen to change from run to run
    if leading is not None:
        lines.set_array(places[:, len(points.factors) + leading])
    axes.add_collection(lines)
    axes.set_xlim(-0.3, len(shown) - 0.7)
    axes.set_ylim(-0.14, 1.14)
    axes.grid(False)
    axes.set_yticks([])
    axes.set_xticks(at, [_short(factor.name) for factor in shown])
    coloured = "" if leading is None else f"; colour: {figures[leading].name}"
    axes.set_title(_safe(f"factors and figures of {len(places)} rows{coloured}"), loc="left")
    for spine in ("left", "right", "top", "bottom"):
        axes.spines[spine].set_visible(False)
    for place, factor in enumerate(shown):
        axes.axvline(place, color=GREY, linewidth=0.8, zorder=3)
        for share, word in _scale(factor):
            if np.isfinite(share):
                axes.text(
                    place + 0.02,
                    share,
                    _short(word),
                    fontsize=7,
                    va="center",
                    zorder=4,
                    bbox={"fc": "white", "ec": "none", "alpha": 0.7, "pad": 0.5},
                )


def _scale(factor: Factor) -> Sequence[tuple[float, str]]:
    if len(factor.labels) > LABELS:
        return []
    if factor.labels:
        used = sorted({int(value) for value in factor.values[~np.isnan(factor.values)]})
        low, high = used[0], used[-1]
        return [((place - low) / (high - low) if high > low else 0.5, factor.labels[place]) for place in used]
    low_value, high_value = float(np.nanmin(factor.values)), float(np.nanmax(factor.values))
    if low_value == high_value:
        return [(0.5, f"{low_value:.4g}")]
    return [(-0.07, f"{low_value:.4g}"), (1.07, f"{high_value:.4g}")]


def _scatter(axes: Any, points: Points, factor: Factor, values: Floats) -> None:
    """A figure over a factor: every row, or where seeds repeat each point's mean and standard deviation."""
    sound = np.flatnonzero(~np.isnan(values) & ~np.isnan(factor.values))
    x, y, std, _ = over_seeds(points, sound, factor.values, values)
    pixels = len(x) > AS_PIXELS
    if np.isnan(std).all():
        axes.scatter(x, y, s=7, color=MARK, alpha=0.5, linewidths=0, rasterized=pixels)
    else:
        bar = axes.errorbar(x, y, yerr=np.nan_to_num(std), fmt="o", markersize=2.5, color=MARK, alpha=0.6, elinewidth=0.7)
        for part in (bar[0], *bar[2]):
            part.set_rasterized(pixels)
    if len(factor.labels) > LABELS:
        axes.set_xticks([])
    elif factor.labels:
        axes.set_xticks(range(len(factor.labels)), [_short(label) for label in factor.labels], rotation=20 if len(factor.labels) > 3 else 0)
    elif factor.log:
        ticker = extra("matplotlib.ticker", "plot")
        axes.set_xscale("log")
        axes.xaxis.set_major_locator(ticker.MaxNLocator(4))
        axes.xaxis.set_major_formatter(ticker.StrMethodFormatter("{x:g}"))
        axes.xaxis.set_minor_locator(ticker.NullLocator())
    if not len(sound):
        axes.text(0.5, 0.5, "no number", transform=axes.transAxes, ha="center")


def over_seeds(points: Points, rows: Any, x: Floats, y: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Means over the repeats of each point.

    Args:
        points: the campaign's rows.
        rows: places of the rows that count, int64.
        x, y: one a row of `points`, shape (done,).

    Returns:
        x, mean of y, its standard deviation over seeds (n - 1; NaN of a single seed), and the number of seeds; one a point.

    """
    point = (points.drive[rows] - points.repeat[rows]) // points.repeats  # rows of a point follow each other
    _, first, where, count = np.unique(point, return_index=True, return_inverse=True, return_counts=True)
    chosen = y[rows]
    mean = np.bincount(where, chosen) / count if len(rows) else np.empty(0)
    square = np.bincount(where, (chosen - mean[where]) ** 2) if len(rows) else np.empty(0)
    with np.errstate(divide="ignore", invalid="ignore"):
        std = np.where(count > 1, np.sqrt(square / np.maximum(count - 1, 1)), np.nan)
    return x[rows][first], mean, std, count.astype(np.float64)


def _effects(axes: Any, name: str, effects: Effects, factors: Sequence[str]) -> None:
    """Bars of S1, and of ST where it is known, with their intervals."""
    axes.set_title(_safe(f"effect on {name}, {effects.rows} rows"), loc="left")
    if not effects.indices:
        axes.text(
            0.5, 0.5, _safe(effects.why_not.replace(": ", ":\n").replace("; ", ";\n")), transform=axes.transAxes, ha="center", va="center"
        )
        axes.set_xticks([])
        axes.set_yticks([])
        return
    shown = [factor for factor in factors if factor in effects.indices]
    place = np.arange(len(shown), dtype=np.float64)[::-1]
    told = [effects.indices[factor] for factor in shown]
    both = all(index.total is not None for index in told)
    height = 0.38 if both else 0.6
    error = {"ecolor": "black", "elinewidth": 0.8, "capsize": 2}
    axes.barh(
        place + (height / 2 if both else 0),
        [i.first for i in told],
        height,
        xerr=[i.first_conf for i in told],
        color=FIRST,
        error_kw=error,
        label="S1, alone",
    )
    if both:
        total, conf = [i.total for i in told], [i.total_conf for i in told]
        axes.barh(place - height / 2, total, height, xerr=conf, color=TOTAL, error_kw=error, label="ST, with interactions")
    axes.axvline(0, color=GREY, linewidth=0.8)
    axes.set_yticks(place, [_short(factor) for factor in shown])
    low, high = axes.get_xlim()
    axes.set_xlim(min(low, -0.05), max(high, 1.05))
    axes.set_xlabel("share of the variance")
    axes.set_ylim(-1.2, len(shown) - 0.4)
    axes.legend(fontsize=6, loc="lower center", ncol=2, frameon=False)
