"""How much of each figure's variance each factor makes: Sobol indices by SALib.

Of a Saltelli design (`method = "saltelli"`, or a list with its rows) first-order and total indices by SALib.analyze.sobol. Of any other
rows first-order indices from given data, by SALib.analyze.rbd_fast (random balance design with the correction of Tissot and Prieur).
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .._extras import extra
from .points import Floats, Points

LEAST_ROWS = 16  # for rbd_fast: two harmonics, and a bootstrap of half the rows that is still wider than they are
LEAST_BLOCKS = 8  # of a Saltelli design
RESAMPLES = 200
SEED = 1  # of SALib's bootstrap, and of the order among equal values


@dataclass(frozen=True)
class Index:
    """One factor's share in a figure's variance.

    Attributes:
        first: first-order index S1, what the factor does alone; about 0 to 1, an estimate may pass either.
        first_conf: half of its 95 % confidence interval, from SALib's bootstrap.
        total, total_conf: the total index ST, its interactions included; None where the rows cannot tell it.

    """

    first: float
    first_conf: float
    total: float | None = None
    total_conf: float | None = None


@dataclass(frozen=True)
class Effects:
    """What the factors do to one figure: `rows` are those it rests on; `why_not` says why `indices` is empty, where it is."""

    rows: int
    indices: dict[str, Index]
    why_not: str = ""


@dataclass(frozen=True)
class Sensitivity:
    """The effect of each factor on each figure.

    Attributes:
        method: "sobol" or "rbd_fast", of SALib.analyze.
        words: the same for people, with what it rests on.
        figures: name and effects.

    """

    method: str
    words: str
    figures: dict[str, Effects]

    @property
    def text(self) -> str:
        """For people: a line a figure and factor."""
        lines = [self.words]
        for name, effects in self.figures.items():
            lines.append(f"{name}, {effects.rows} rows" + (f": {effects.why_not}" if effects.why_not else ""))
            for factor, i in effects.indices.items():
                total = "" if i.total is None else f"   ST {i.total:6.3f} +- {i.total_conf:.3f}"
                lines.append(f"  {factor:32} S1 {i.first:6.3f} +- {i.first_conf:.3f}{total}")
        return "\n".join(lines)

    @property
    def json(self) -> dict[str, Any]:
        """For programs: part of schema traction.campaign/1."""
        figures = {
            name: {"rows": told.rows, "why_not": told.why_not, "indices": {factor: vars(index) for factor, index in told.indices.items()}}
            for name, told in self.figures.items()
        }
        return {"method": self.method, "words": self.words, "figures": figures}


def analyse(points: Points) -> Sensitivity:
    """Of the finished rows. Raises ImportError where SALib is not installed."""
    step = _saltelli_step(points)
    extra(f"SALib.analyze.{'sobol' if step else 'rbd_fast'}", "plot")
    if step:
        blocks = points.drives // points.repeats // step
        seeds = f", each row the mean of {points.repeats} seeds" if points.repeats > 1 else ""
        words = f"Sobol indices with 95 % confidence (SALib.analyze.sobol) of a Saltelli design, {blocks} blocks of {step} rows{seeds}"
        return Sensitivity("sobol", words, {name: _sobol(points, values, step) for name, values in points.figures.items()})
    words = "first-order indices with 95 % confidence from given data (SALib.analyze.rbd_fast): these rows are no Saltelli design"
    return Sensitivity("rbd_fast", words, {name: _given_data(points, values) for name, values in points.figures.items()})


def _saltelli_step(points: Points) -> int:
    """Rows of a block A, AB1 .. ABD, [BA1 .. BAD,] B of SALib's order, ABi being A with column i of B; 0 where the rows are none."""
    if points.method not in ("saltelli", "list") or points.drives % points.repeats:
        return 0
    x = np.column_stack([factor.design for factor in points.factors])[:: points.repeats]
    count = len(points.factors)
    if np.isnan(x).any():
        return 0
    for step in (count + 2, 2 * count + 2):
        if len(x) % step:
            continue
        a, b = x[::step], x[step - 1 :: step]
        mixed = [(a, b, j + 1) for j in range(count)] + [(b, a, j + 1 + count) for j in range(count) if step > count + 2]
        if all(np.array_equal(x[at::step], _with_column(into, of, (at - 1) % count)) for into, of, at in mixed):
            return step
    return 0


def _with_column(into: Floats, of: Floats, column: int) -> Floats:
    out = into.copy()
    out[:, column] = of[:, column]
    return out


def _constant(values: Floats) -> bool:
    """Whether they differ by no more than rounding."""
    return bool(np.ptp(values) <= 1e-12 * np.max(np.abs(values)))


def _sobol(points: Points, values: Floats, step: int) -> Effects:
    whole = np.full(points.drives, math.nan)
    whole[points.drive] = values
    blocks = whole.reshape(-1, points.repeats).mean(axis=1).reshape(-1, step)
    sound = blocks[~np.isnan(blocks).any(axis=1)]
    rows = sound.size * points.repeats
    if len(sound) < LEAST_BLOCKS:
        return Effects(rows, {}, f"{len(sound)} of {len(blocks)} blocks are whole; {LEAST_BLOCKS} are needed")
    if _constant(sound):
        return Effects(rows, {}, "constant: no factor has an effect")
    names = [factor.name for factor in points.factors]
    problem = {"num_vars": len(names), "names": names, "bounds": [[0.0, 1.0]] * len(names)}
    second = step > len(names) + 2
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        told = extra("SALib.analyze.sobol", "plot").analyze(
            problem, sound.ravel(), calc_second_order=second, num_resamples=RESAMPLES, conf_level=0.95, seed=SEED
        )
    columns = zip(*(np.asarray(told[key], dtype=float).tolist() for key in ("S1", "S1_conf", "ST", "ST_conf")), strict=True)
    return Effects(rows, {name: Index(*four) for name, four in zip(names, columns, strict=True)})


def _given_data(points: Points, values: Floats) -> Effects:
    x = np.column_stack([factor.values for factor in points.factors])
    sound = ~(np.isnan(values) | np.isnan(x).any(axis=1))
    x, y = x[sound], values[sound]
    if len(y) < LEAST_ROWS:
        return Effects(len(y), {}, f"{len(y)} rows; {LEAST_ROWS} are needed")
    if _constant(y):
        return Effects(len(y), {}, "constant: no factor has an effect")
    varies = np.ptp(x, axis=0) > 0  # a factor may stand still among the rows that are left
    names = [factor.name for factor, moves in zip(points.factors, varies, strict=True) if moves]
    problem = {"num_vars": len(names), "names": names, "bounds": [[0.0, 1.0]] * len(names)}
    ranks = np.column_stack([_ranks(column) for column in x.T[varies]])
    told = extra("SALib.analyze.rbd_fast", "plot").analyze(
        problem, ranks, y, M=min(10, len(y) // 8), num_resamples=RESAMPLES, conf_level=0.95, seed=SEED
    )
    pairs = zip(told["S1"], told["S1_conf"], strict=True)
    return Effects(len(y), {name: Index(float(s), float(c)) for name, (s, c) in zip(names, pairs, strict=True)})


def _ranks(x: Floats) -> npt.NDArray[np.float64]:
    """Places in the order of x, equal values at random by a fixed seed: in a grid their order in the table is that of another factor."""
    dice = np.random.default_rng(SEED).random(len(x))
    out = np.empty(len(x))
    out[np.lexsort((dice, x))] = np.arange(len(x))
    return out
