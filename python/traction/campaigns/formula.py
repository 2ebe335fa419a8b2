"""Figures: formulas over a log's signals, such as "mean(wheel0.slip)" or "rms(a.b - c.d)".

Signals stand by their names; arithmetic and comparisons go sample by sample, between signals of one time axis. Functions:
mean min max std rms median sum first last count abs sqrt quantile(x, q) integral(x) [unit s] share(condition) part(x, from_s, to_s).
`duration_s` is the log's.
"""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .._errors import CampaignError
from ..log import Column, Log


@dataclass(frozen=True)
class Samples:
    """Values at their times."""

    t_s: npt.NDArray[np.float64]
    v: npt.NDArray[Any]


_TO_ONE: dict[str, Callable[[npt.NDArray[Any]], Any]] = {
    "mean": np.mean,
    "min": np.min,
    "max": np.max,
    "std": np.std,
    "median": np.median,
    "sum": np.sum,
    "share": np.mean,
    "rms": lambda v: np.sqrt(np.mean(np.square(v))),
    "first": lambda v: v[0],
    "last": lambda v: v[-1],
}
_EACH: dict[str, Callable[[Any], Any]] = {"abs": np.abs, "sqrt": np.sqrt}
_ARGUMENTS = {**{n: 1 for n in (*_TO_ONE, *_EACH, "count", "integral")}, "quantile": 2, "part": 3}
_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}
_COMPARE: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}
_MEND = "write it as docs/campaign.md shows"


class Formula:
    """A formula that was parsed: what cannot be meant is refused here, what a log lacks when it is asked of that log."""

    def __init__(self, text: str, name: str) -> None:
        self.text, self.name = text, name
        try:
            self._tree = ast.parse(text, mode="eval").body
        except SyntaxError as error:
            raise self._wrong(f"is no formula ({error.msg})") from None
        self.signals: set[str] = set()
        self._look(self._tree)

    def _wrong(self, what: str, mend: str = _MEND) -> CampaignError:
        message = f"figure {self.name!r}: {self.text!r} {what}; to mend: {mend}"
        return CampaignError(message, key=f"keep.figures.{self.name}", value=self.text, mend=mend)

    def _look(self, node: ast.expr) -> None:
        match node:
            case ast.BinOp(left=a, op=op, right=b) if type(op) in _BINARY:
                self._look(a)
                self._look(b)
            case ast.Compare(left=a, ops=[op], comparators=[b]) if type(op) in _COMPARE:
                self._look(a)
                self._look(b)
            case ast.UnaryOp(op=ast.USub(), operand=a):
                self._look(a)
            case ast.Constant(value=bool()):
                raise self._wrong("holds a truth value")
            case ast.Constant(value=int() | float()) | ast.Name(id="duration_s"):
                pass
            case ast.Call(func=ast.Name(id=function), args=args, keywords=[]) if function in _ARGUMENTS:
                if len(args) != _ARGUMENTS[function]:
                    raise self._wrong(f"gives {function} {len(args)} arguments", f"give it {_ARGUMENTS[function]}")
                for a in args:
                    self._look(a)
            case ast.Call(func=ast.Name(id=function)):
                raise self._wrong(f"calls {function!r}", "the functions are " + " ".join(sorted(_ARGUMENTS)))
            case ast.Attribute() | ast.Name():
                self.signals.add(_dotted(node))
            case _:
                raise self._wrong(f"holds {ast.unparse(node)!r}, which is not understood")

    def __call__(self, log: Mapping[str, Column], truth: Mapping[str, Column] | None, duration_s: float) -> float:
        """Its value for one drive. Raises CampaignError where a signal is missing or the result is no number."""

        def signal(name: str) -> Samples:
            for source in (log, truth or {}):
                if name in source:
                    return Samples(source[name].t_s, source[name].values)
            raise self._wrong(f"asks for {name!r}, which the log does not have", "give a column of the log, or of its truth")

        out = self._value(self._tree, signal, duration_s)
        if isinstance(out, Samples):
            raise self._wrong("gives a value a sample", "wrap it in mean(), rms(), max(), last() or the like")
        return float(out)

    def _value(self, node: ast.expr, signal: Callable[[str], Samples], duration_s: float) -> Any:
        match node:
            case ast.BinOp(left=a, op=op, right=b):
                return self._pair(self._value(a, signal, duration_s), self._value(b, signal, duration_s), _BINARY[type(op)])
            case ast.Compare(left=a, ops=[compare], comparators=[b]):
                return self._pair(self._value(a, signal, duration_s), self._value(b, signal, duration_s), _COMPARE[type(compare)])
            case ast.UnaryOp(operand=a):
                return self._pair(0.0, self._value(a, signal, duration_s), operator.sub)
            case ast.Constant(value=value):
                return float(value)  # type: ignore[arg-type]
            case ast.Name(id="duration_s"):
                return duration_s
            case ast.Call(func=ast.Name(id=function), args=args):
                return self._call(function, [self._value(a, signal, duration_s) for a in args])
            case _:
                return signal(_dotted(node))

    def _pair(self, a: Any, b: Any, act: Callable[[Any, Any], Any]) -> Any:
        with np.errstate(all="ignore"):
            if isinstance(a, Samples) and isinstance(b, Samples):
                if not np.array_equal(a.t_s, b.t_s):
                    raise self._wrong("joins signals that are sampled at different times", "make a number of each first: mean(), rms()")
                return Samples(a.t_s, act(a.v, b.v))
            if isinstance(a, Samples):
                return Samples(a.t_s, act(a.v, b))
            if isinstance(b, Samples):
                return Samples(b.t_s, act(a, b.v))
            return act(np.float64(a), np.float64(b))

    def _call(self, function: str, args: list[Any]) -> Any:
        x = args[0]
        with np.errstate(all="ignore"):
            if function in _EACH:
                return Samples(x.t_s, _EACH[function](x.v)) if isinstance(x, Samples) else _EACH[function](x)
            if not isinstance(x, Samples):
                raise self._wrong(f"takes the {function} of one number", "give it a signal")
            if any(isinstance(a, Samples) for a in args[1:]):
                raise self._wrong(f"gives {function} a signal where a number belongs", "give a number")
            if function == "count":
                return float(len(x.v))
            if function == "part":
                inside = (x.t_s >= args[1]) & (x.t_s <= args[2])
                return Samples(x.t_s[inside], x.v[inside])
            if len(x.v) == 0:
                return float("nan")
            if function == "integral":
                return float(np.sum(np.diff(x.t_s) * (x.v[1:] + x.v[:-1]) / 2))
            if function == "quantile":
                if not 0 <= args[1] <= 1:
                    raise self._wrong(f"asks for the quantile {args[1]}", "give 0 to 1")
                return np.quantile(x.v, args[1])
            return _TO_ONE[function](x.v)


def _dotted(node: ast.expr) -> str:
    return ast.unparse(node)


def figures(formulas: Mapping[str, Formula], log: Log, truth: Log | None) -> dict[str, float]:
    """Every figure of one drive."""
    return {name: formula(log, truth, log.duration_s) for name, formula in formulas.items()}
