"""What a campaign is: its factors, its rows, what is kept of each drive (docs/campaign.md)."""

from __future__ import annotations

import difflib
import hashlib
import itertools
import json
import math
import os
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from .. import _core
from .._data import find
from .._errors import CampaignError
from .._extras import extra
from .formula import Formula
from .plan import LAYOUT, Row, Task, plain

METHODS = ("grid", "latin_hypercube", "sobol", "saltelli", "list")
_KEYS = ("title", "about", "scenario", "seed", "method", "drives", "base", "repeats", "hide", "set", "vary", "row", "keep", "part")
_KEEP = ("figures", "columns", "rate_Hz", "logs", "diagnosis")
_FILES = {"scenario": "scenarios", "rover": "rovers", "believes": "rovers"}
OWN = (
    "drive repeat seed hide_seed status error ticks faults fault_names trace_hash hidden "
    "verdict named error_before error_after"
)  # columns of every table


def read_table(file: str | os.PathLike[str]) -> dict[str, Any]:
    """The keys of a campaign's TOML file. Raises CampaignError."""
    name = os.fspath(file)
    try:
        with open(name, "rb") as stream:
            return tomllib.load(stream)
    except OSError as error:
        raise CampaignError(f"{name}: {error.strerror}; to mend: give a campaign's TOML file", name, mend="give a file") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise CampaignError(f"{name}: is no TOML: {error}; to mend: write it as docs/campaign.md shows", name) from None


def wrong(file: str, key: str, value: object, what: str, mend: str) -> CampaignError:
    """What is wrong with a key of a campaign's file, or of a dict where there is no file."""
    where = f"{file}: {key}" if file else key
    shown = "" if value is None else f" = {value!r}"
    return CampaignError(f"{where}{shown}: {what}; to mend: {mend}", file, key=key, value="" if value is None else str(value), mend=mend)


@dataclass(frozen=True)
class Range:
    """A factor that goes evenly from low to high; `log`: by its logarithm; `count`: values in a grid."""

    low: float
    high: float
    log: bool = False
    count: int = 0

    def at(self, u: float) -> float:
        """The value at a share u of the way, 0 to 1."""
        if self.log:
            return float(self.low * (self.high / self.low) ** u)
        return float(self.low + (self.high - self.low) * u)

    @property
    def values(self) -> list[float]:
        """Of a grid."""
        return [self.at(i / (self.count - 1)) if self.count > 1 else self.low for i in range(self.count)]


@dataclass(frozen=True)
class Spec:
    """A campaign that was read and found sound. Make one by `Spec.read`, `Spec.of`."""

    table: dict[str, Any]
    file: str = ""
    factors: dict[str, Range | list[Any]] = field(default_factory=dict)
    formulas: dict[str, Formula] = field(default_factory=dict)
    texts: dict[str, str] = field(default_factory=dict)  # of the files that it names
    paths: dict[str, str] = field(default_factory=dict)  # where they were, for messages and what they name beside them

    @staticmethod
    def read(file: str | os.PathLike[str]) -> Spec:
        """Read a campaign's TOML file. Raises CampaignError with key, value, mend; with the line where it is no TOML."""
        return Spec.of(read_table(file), os.fspath(file))

    @staticmethod
    def of(table: Mapping[str, Any], file: str = "") -> Spec:
        """The same from a dict of the file's keys."""
        spec = Spec(json.loads(json.dumps(table, default=_plain)), file)
        spec._check_keys()
        spec.factors.update(spec._factors())
        spec._check_method()
        for name, text in spec.table.get("keep", {}).get("figures", {}).items():
            if not isinstance(text, str):
                raise wrong(file, f"keep.figures.{name}", text, "is no formula", "write a text such as 'mean(wheel0.slip)'")
            spec.formulas[name] = Formula(text, name)
        spec._read_texts()
        spec._check_columns()
        return spec

    def _check_keys(self) -> None:
        for table, known, prefix in ((self.table, _KEYS, ""), (self.table.get("keep", {}), _KEEP, "keep.")):
            for key in table:
                if key not in known:
                    near = difflib.get_close_matches(key, known, 1)
                    mend = f"is {near[0]!r} meant?" if near else "the keys are " + " ".join(known)
                    raise wrong(self.file, prefix + key, None, "is no key of a campaign", mend)
        for key, low in (("drives", 1), ("base", 1), ("repeats", 1), ("seed", 0), ("hide", 0), ("part", 1)):
            value = self.table.get(key, low)
            if not isinstance(value, int) or isinstance(value, bool) or value < low or (key == "hide" and value > 5):
                raise wrong(
                    self.file, key, value, "cannot be", f"give a whole number of {low} or more" + (", 5 at most" if key == "hide" else "")
                )
        for key in ("set", "vary", "keep"):
            if not isinstance(self.table.get(key, {}), dict):
                raise wrong(self.file, key, self.table[key], "is no table", f"write [{key}]")
        if "scenario" not in self.table and "scenario" not in self.table.get("vary", {}) and not self.table.get("row"):
            raise wrong(self.file, "scenario", None, "is missing", "give a scenario file, or a list of them under [vary]")
        keep = self.table.get("keep", {})
        if not isinstance(keep.get("columns", []), list):
            raise wrong(self.file, "keep.columns", keep["columns"], "is no list", "give a list of column names")
        rate = keep.get("rate_Hz", 1)
        if isinstance(rate, bool) or not isinstance(rate, (int, float)) or not rate > 0:
            raise wrong(self.file, "keep.rate_Hz", rate, "is no rate", "give a number above 0")

    def _factors(self) -> dict[str, Range | list[Any]]:
        out: dict[str, Range | list[Any]] = {}
        for key, value in _flat(self.table.get("vary", {})).items():
            if isinstance(value, dict):
                out[key] = self._range(key, value)
            elif isinstance(value, list) and value:
                out[key] = value
            else:
                raise wrong(self.file, f"vary.{key}", value, "is no factor", "give a list of values, or { low = , high = }")
        return out

    def _range(self, key: str, value: dict[str, Any]) -> Range:
        where = f"vary.{key}"
        unknown = set(value) - {"low", "high", "log", "count"}
        numbers = all(isinstance(value.get(n), (int, float)) and math.isfinite(value[n]) for n in ("low", "high"))
        if unknown or not numbers or not value["low"] < value["high"]:
            raise wrong(self.file, where, value, "is no range", "give { low = , high = } with low below high, log and count if wanted")
        count = value.get("count", 0)
        if not isinstance(count, int) or count < 0:
            raise wrong(self.file, where, value, "has no such count", "give a whole number")
        if value.get("log") and value["low"] <= 0:
            raise wrong(self.file, where, value, "has no logarithm at its low end", "give a low above 0")
        return Range(float(value["low"]), float(value["high"]), bool(value.get("log", False)), count)

    def _check_method(self) -> None:
        if self.method not in METHODS:
            raise wrong(self.file, "method", self.method, "is none", "give " + ", ".join(METHODS))
        if self.method == "list" and not self.table.get("row"):
            raise wrong(self.file, "row", None, "is missing", "write [[row]] tables, or another method")
        if self.method == "grid":
            for key, factor in self.factors.items():
                if isinstance(factor, Range) and factor.count < 1:
                    raise wrong(self.file, f"vary.{key}", None, "has no count, which a grid needs", "give count, or a list of values")
        if self.method in ("latin_hypercube", "sobol") and ("drives" not in self.table or not self.factors):
            raise wrong(self.file, "drives", None, f"and [vary] are what {self.method} needs", "say how many drives, and of what")

        base = self.table.get("base")
        if self.method == "saltelli" and (base is None or not self.factors or base & (base - 1)):
            mend = "give a power of two, 64 or more for indices of use; the drives are base x (factors + 2)"
            raise wrong(self.file, "base", base, "cannot be" if base and self.factors else "and [vary] are what saltelli needs", mend)
        for key, factor in self.factors.items():
            if self.method == "saltelli" and isinstance(factor, list) and len(factor) < 2:
                raise wrong(self.file, f"vary.{key}", factor, "does not vary", "put it under [set], or give more values")

    @property
    def title(self) -> str:
        """For people."""
        return str(self.table.get("title", Path(self.file).stem or "campaign"))

    @property
    def method(self) -> str:
        """How rows are made."""
        return str(self.table.get("method", "list" if self.table.get("row") else "grid"))

    @property
    def part(self) -> int:
        """Rows of a Parquet file."""
        return int(self.table.get("part", 1000))

    @property
    def keep(self) -> dict[str, Any]:
        """What is kept of each drive."""
        return dict(self.table.get("keep", {}))

    @property
    def fingerprint(self) -> str:
        """Of everything that the results depend on: the specification, the files that it names, and the compiled half of this package."""
        core = hashlib.sha256(Path(_core.__file__).read_bytes()).hexdigest()
        whole = json.dumps([plain(self.table), self.texts, core, LAYOUT], sort_keys=True)
        return hashlib.sha256(whole.encode()).hexdigest()

    @cached_property
    def points(self) -> list[Row]:
        """The factors' values, point by point; without repeats."""
        if self.method == "list":
            return [_flat(row) for row in self.table["row"]]
        if self.method == "grid":
            axes = [factor.values if isinstance(factor, Range) else factor for factor in self.factors.values()]
            return [dict(zip(self.factors, values, strict=True)) for values in itertools.product(*axes)]
        return [
            {
                k: f.at(float(u)) if isinstance(f, Range) else f[min(int(u * len(f)), len(f) - 1)]
                for (k, f), u in zip(self.factors.items(), point, strict=True)
            }
            for point in self._shares()
        ]

    def _shares(self) -> Any:
        """Points of the unit cube, of shape (points, factors), by the campaign's seed."""
        seed = int(self.table.get("seed", 0))
        if self.method == "saltelli":
            names = list(self.factors)
            problem = {"num_vars": len(names), "names": names, "bounds": [[0.0, 1.0]] * len(names)}
            return extra("SALib.sample.sobol", "plot").sample(problem, int(self.table["base"]), calc_second_order=False, seed=seed)
        from scipy.stats import qmc

        make = qmc.Sobol if self.method == "sobol" else qmc.LatinHypercube
        sampler = make(d=len(self.factors), seed=seed)
        import warnings

        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # Sobol points that are no power of two: balance is the user's choice
            return sampler.random(int(self.table["drives"]))

    @cached_property
    def rows(self) -> list[Row]:
        """Every drive: `drive`, `repeat`, `seed`, `hide_seed` where something is hidden, and the factors' values.

        A row's seeds are made of the campaign's seed, its values and its repeat, so that rows that come or go do not change the others.
        """
        out: list[Row] = []
        for point in self.points:
            for repeat in range(int(self.table.get("repeats", 1))):
                row = {"drive": len(out), "repeat": repeat, "seed": self._seed("noise", point, repeat)}
                if self.table.get("hide", 0):
                    row["hide_seed"] = self._seed("hide", point, repeat)
                out.append(row | point)
        return out

    def _seed(self, what: str, point: Row, repeat: int) -> int:
        given = json.dumps([int(self.table.get("seed", 0)), what, point, repeat], sort_keys=True)
        return (
            int.from_bytes(hashlib.sha256(given.encode()).digest()[:8], "big") >> 11
        )  # 53 bits: every reader of tables holds them exactly

    @cached_property
    def keys(self) -> list[str]:
        """The factors' names."""
        return list(dict.fromkeys(key for point in self.points for key in point))

    def schema(self) -> Any:
        """The table's columns (pyarrow), known before the first drive; so a part does not depend on which drives failed."""
        import pyarrow as pa

        fields = [pa.field("drive", pa.int64()), pa.field("repeat", pa.int32()), pa.field("seed", pa.int64())]
        if self.table.get("hide", 0):
            fields.append(pa.field("hide_seed", pa.int64()))
        fields += [pa.field(key, _type_of([point.get(key) for point in self.points])) for key in self.keys]
        fields += [
            pa.field("status", pa.string()),
            pa.field("error", pa.string()),
            pa.field("ticks", pa.int64()),
            pa.field("faults", pa.int64()),
        ]
        fields += [pa.field(name, pa.string()) for name in ("fault_names", "trace_hash", "hidden")]
        fields += [pa.field(name, pa.float64(), metadata={"formula": f.text}) for name, f in self.formulas.items()]
        if self.keep.get("diagnosis"):
            fields += [pa.field("verdict", pa.string()), pa.field("named", pa.string())]
            fields += [pa.field("error_before", pa.float64()), pa.field("error_after", pa.float64())]
        if self.keep.get("columns"):
            fields += [pa.field(name, pa.list_(pa.float64())) for name in ("series.t_s", *(f"series.{c}" for c in self.keep["columns"]))]
        return pa.schema(fields)

    def task(self, folder: str | os.PathLike[str]) -> Task:
        """What its workers are given."""
        from .drive import Job

        return Job.of(self, folder)

    def _read_texts(self) -> None:
        """The files that rows name, so that a run does not depend on what happens to them."""
        wanted: list[tuple[str, str]] = [("scenario", str(self.table["scenario"]))] if isinstance(self.table.get("scenario"), str) else []
        if isinstance(self.table.get("scenario"), dict):
            self.texts["scenario:"] = json.dumps(self.table["scenario"])
        for point in (*self.points, _flat(self.table.get("set", {}))):
            wanted += [(key, str(point[key])) for key in _FILES if key in point]
        diagnosis = self.keep.get("diagnosis")
        if diagnosis is not None:
            wanted.append(("keep.diagnosis", str(diagnosis)))
        base = Path(self.file).parent
        for key, name in wanted:
            if f"{key}:{name}" in self.texts:
                continue
            folder = _FILES.get(key, "models")
            beside = base / name
            path = str(beside) if self.file and beside.is_file() else find(name, folder)
            self.paths[f"{key}:{name}"] = os.path.abspath(path)
            try:
                self.texts[f"{key}:{name}"] = Path(path).read_text(encoding="utf-8")
            except OSError as error:
                raise wrong(self.file, key, name, f"cannot be read ({error.strerror})", "give a file that is there") from None

    def _check_columns(self) -> None:
        own = set(OWN.split())
        for name in (*self.keys, *self.formulas):
            if name in own:
                raise wrong(self.file, name, None, "is a column of every campaign's table", "choose another name")
        for name in self.formulas:
            if name in self.keys:
                raise wrong(self.file, f"keep.figures.{name}", None, "is a factor too", "choose another name")


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


def _plain(value: Any) -> Any:
    item = getattr(value, "tolist", None)
    if item is not None:
        return item()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"{value!r} has no place in a campaign: give numbers, texts, lists, dicts")


def _flat(table: Mapping[str, Any], prefix: str = "") -> Row:
    """Nested tables as dotted keys; a table with low or high is a range."""
    out: Row = {}
    for key, value in table.items():
        if isinstance(value, dict) and not {"low", "high"} & set(value):
            out |= _flat(value, f"{prefix}{key}.")
        else:
            out[prefix + key] = value
    return out
