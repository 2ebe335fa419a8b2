"""Logs: named columns, each with its own sample times, and a header."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core, _html
from ._data import find_map
from ._errors import LogError

if TYPE_CHECKING:
    import pandas
    import xarray

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Column:
    """One quantity at its own times. The arrays are views of the log's memory, read-only, and keep it alive.

    Attributes:
        name: "<object>.<quantity>_<unit>", such as "wheel2.current_A".
        t_s: sample times in seconds, strictly increasing, shape (n,).
        values: in `unit`, shape (n,), finite.
        unit: as the name's suffix writes it ("rad_s"); empty for a number without one.
        meaning: a line from the vocabulary; empty for a name outside it.
        kind: "raw", "measured", "estimate", "command", "truth"; empty for a name outside the vocabulary.

    """

    name: str
    t_s: Floats
    values: Floats
    unit: str
    meaning: str
    kind: str

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        return np.array(self.values, dtype=dtype, copy=True) if copy else np.asarray(self.values, dtype=dtype)

    def __len__(self) -> int:
        return len(self.values)


@dataclass(frozen=True)
class Run:
    """How a simulated log came about.

    Attributes:
        seed: of every sensor's noise, and of the ground's grip.
        ticks: of 10 ms.
        faults: bits of `fault_t` that the firmware latched; 0 for none.
        fault_names: the same in words, empty for none.
        trace_hash: FNV-1a over every tick's trace, 16 hexadecimal digits: equal hashes, equal drives.
        seal: JSON of what was hidden; empty where nothing was. The lab never sees it.
        truth: what really happened, columns `truth.*`; None unless asked for.

    """

    seed: int
    ticks: int
    faults: int
    fault_names: str
    trace_hash: str
    seal: str
    truth: Log | None


class Log(Mapping[str, Column]):
    """A log: a mapping from column names to columns.

    Make one by `Log.read`, `Log.of` or `traction.simulate`. It is not changed after it was made.
    """

    run: Run | None = None

    def __init__(self, core: _core.LogData) -> None:
        self._core = core
        self._index = {name: i for i, name in enumerate(core.names)}

    @staticmethod
    def read(file: str | os.PathLike[str], map: str | os.PathLike[str] | None = None) -> Log:
        """Read a CSV log. A foreign CSV is read through the TOML map `map` (docs/log_format.md), or the name of a shipped one.

        What had to be mended stands in `repairs`. Raises LogError with line and column, FileError where it cannot be opened.
        """
        return Log(_core.LogData.read(os.fspath(file), find_map(map)))

    @staticmethod
    def of(
        columns: Mapping[str, Any] | pandas.DataFrame,
        *,
        t_s: npt.ArrayLike | None = None,
        header: Mapping[str, object] | None = None,
        name: str = "log",
    ) -> Log:
        """Make a log of a dict or a pandas frame, without a file.

        Args:
            columns: values by column name, shape (n,); or (times, values) for a column with times of its own. NaN is "no sample then".
                "t_s", a column or the name of a frame's index, is the time of all others; a frame's DatetimeIndex or TimedeltaIndex is
                taken too, its first time as 0.
            t_s: the common times in seconds, shape (n,), where `columns` has none.
            header: key and value, as the "# key: value" lines of a file: noise, biases, quantum of signals.
            name: what messages call it.

        Known quantities in another unit ("wheel0.speed_rpm") are converted, and told in `repairs`.

        """
        times, named = _columns_of(columns, t_s, name)
        core = _core.LogData.of_columns(
            [(column, *_pair(column, value, times, name)) for column, value in named],
            {key: _header_text(value) for key, value in (header or {}).items()},
            name,
        )
        return Log(core)

    def __getitem__(self, name: str) -> Column:
        i = self._index.get(name)
        if i is None:
            raise KeyError(f"{self.source}: there is no column {name!r}{_near(name, self._index)}")
        known = _core.quantity(name)
        unit, meaning, kind = known if known is not None else ("", "", "")
        return Column(name, self._core.times(i), self._core.values(i), unit, meaning, kind)

    def __iter__(self) -> Iterator[str]:
        return iter(self._index)

    def __len__(self) -> int:
        return len(self._index)

    def __repr__(self) -> str:
        return f"<Log {self.source}: {len(self)} columns, {self.duration_s:.3f} s>"

    def _repr_html_(self) -> str:
        return _html.log(self)

    @property
    def header(self) -> dict[str, str]:
        """The "# key: value" lines."""
        return dict(self._core.header)

    @property
    def repairs(self) -> list[str]:
        """What the reader mended, one sentence each."""
        return list(self._core.repairs)

    @property
    def source(self) -> str:
        """File or scenario it came from."""
        return self._core.source

    @property
    def duration_s(self) -> float:
        """Last time minus first time over all columns, in seconds."""
        return self._core.duration_s

    def write(self, file: str | os.PathLike[str]) -> None:
        """Write it as CSV, whole or not at all; it reads back to the same bits."""
        self._core.write(os.fspath(file))

    def resampled(self, names: Sequence[str] | None = None, *, rate_Hz: float | None = None) -> tuple[Floats, dict[str, Floats]]:
        """Columns on one time axis.

        Without `rate_Hz` the axis holds every time at which any of them has a sample, and the others are NaN there. With it, the axis goes
        evenly from the first to the last time, and each column shows its latest sample, NaN before its first.

        Returns:
            times in seconds, shape (n,); values by name, each of shape (n,).

        """
        wanted = [self[name] for name in (self if names is None else names)]
        if not wanted or all(len(column) == 0 for column in wanted):
            return np.zeros(0), {column.name: np.zeros(0) for column in wanted}
        if rate_Hz is None:
            axis: Floats = np.unique(np.concatenate([column.t_s for column in wanted]))
        else:
            if not rate_Hz > 0:
                raise ValueError(f"rate_Hz: {rate_Hz} is no rate; give a number above 0")
            first = min(column.t_s[0] for column in wanted if len(column))
            last = max(column.t_s[-1] for column in wanted if len(column))
            axis = first + np.arange(int((last - first) * rate_Hz + 1e-9) + 1) / rate_Hz
        out = {}
        for column in wanted:
            values = np.full(len(axis), np.nan)
            if len(column) and rate_Hz is None:
                values[np.searchsorted(axis, column.t_s)] = column.values
            elif len(column):
                at = np.searchsorted(column.t_s, axis + 1e-9, side="right") - 1  # a nanosecond: the axis is made by division
                values[at >= 0] = column.values[at[at >= 0]]
            out[column.name] = values
        return axis, out

    def to_pandas(self, names: Sequence[str] | None = None, *, rate_Hz: float | None = None) -> pandas.DataFrame:
        """A frame with the index `t_s` (seconds), as `resampled` has it. Units: `frame.attrs["units"]`. Needs pandas."""
        import pandas

        axis, values = self.resampled(names, rate_Hz=rate_Hz)
        frame = pandas.DataFrame(values, index=pandas.Index(axis, name="t_s"))
        frame.attrs = {"units": {name: self[name].unit for name in values}, "header": self.header}
        return frame

    def to_xarray(self, names: Sequence[str] | None = None) -> xarray.Dataset:
        """A dataset in which columns of one time axis share a dimension ("t_s", "t_s_1", ...). Units: `attrs`. Needs xarray."""
        import xarray

        axes: list[Floats] = []
        data: dict[str, Any] = {}
        for name in self if names is None else names:
            column = self[name]
            which = next((i for i, axis in enumerate(axes) if np.array_equal(axis, column.t_s)), len(axes))
            if which == len(axes):
                axes.append(column.t_s)
            data[name] = ("t_s" if which == 0 else f"t_s_{which}", column.values, {"units": column.unit, "long_name": column.meaning})
        coords = {"t_s" if i == 0 else f"t_s_{i}": axis for i, axis in enumerate(axes)}
        return xarray.Dataset(data, coords=coords, attrs=self.header)

    def to_parquet(self, file: str | os.PathLike[str], names: Sequence[str] | None = None, *, rate_Hz: float | None = None) -> None:
        """Write `resampled` as Parquet, whole or not at all: `t_s` and the columns, unit and meaning as metadata. Needs pyarrow."""
        import pyarrow as pa

        from ._parquet import write_table

        axis, values = self.resampled(names, rate_Hz=rate_Hz)
        fields = [pa.field("t_s", pa.float64(), metadata={"unit": "s"})]
        fields += [pa.field(n, pa.float64(), metadata={"unit": self[n].unit, "meaning": self[n].meaning}) for n in values]
        arrays = [pa.array(axis)] + [pa.array(v, from_pandas=True) for v in values.values()]
        write_table(pa.table(arrays, schema=pa.schema(fields, metadata=self.header)), file)


def _near(name: str, known: Mapping[str, object]) -> str:
    import difflib

    near = difflib.get_close_matches(name, list(known), 1)
    return f"; is {near[0]!r} meant?" if near else ""


def _header_text(value: object) -> str:
    return repr(float(value)) if isinstance(value, (float, np.floating)) else str(value)


def _columns_of(columns: Any, t_s: npt.ArrayLike | None, name: str) -> tuple[Floats | None, list[tuple[str, Any]]]:
    named = [(str(key), columns[key]) for key in (columns.columns if hasattr(columns, "columns") else columns)]
    if hasattr(columns, "columns") and len({key for key, _ in named}) < len(named):
        raise LogError(f"{name}: two columns have one name; to mend: give each a name of its own", name, mend="rename one")
    if t_s is not None:
        return np.ascontiguousarray(t_s, dtype=np.float64), [(key, value) for key, value in named if key != "t_s"]
    for key, value in named:
        if key == "t_s":
            return np.ascontiguousarray(value, dtype=np.float64), [item for item in named if item[0] != "t_s"]
    index = getattr(columns, "index", None)
    if index is not None:
        kind = getattr(getattr(index, "dtype", None), "kind", "")
        if kind in "mM" and len(index):
            return np.ascontiguousarray((index - index[0]).total_seconds(), dtype=np.float64), named
        if index.name == "t_s":
            return np.ascontiguousarray(index, dtype=np.float64), named
        mend = "name the index or a column t_s (seconds), or give t_s="
        raise LogError(f"{name}: the frame has no times; to mend: {mend}", name, mend=mend)
    return None, named


def _pair(column: str, value: Any, times: Floats | None, name: str) -> tuple[Floats, Floats]:
    if isinstance(value, tuple) and len(value) == 2:
        t, v = value
    elif times is not None:
        t, v = times, value
    else:
        mend = "give 't_s' beside the columns, t_s=, or (times, values)"
        raise LogError(f"{name}: column {column!r} has no times; to mend: {mend}", name, key=column, mend=mend)
    try:
        return np.ascontiguousarray(t, dtype=np.float64).ravel(), np.ascontiguousarray(v, dtype=np.float64).ravel()
    except (TypeError, ValueError) as error:
        mend = "give numbers, NaN where there is no sample"
        raise LogError(f"{name}: column {column!r} holds no numbers ({error}); to mend: {mend}", name, key=column, mend=mend) from None


def as_log(log: Log | str | os.PathLike[str]) -> Log:
    """A log, or the file of one."""
    return log if isinstance(log, Log) else Log.read(log)
