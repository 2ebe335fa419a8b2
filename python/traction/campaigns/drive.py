"""One drive: a pure function of its row."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import _core
from .._errors import InputError
from ..lab import Model, diagnose
from ..log import Log
from ..scenario import Rover, drive, load
from .formula import Formula, figures
from .plan import Row, Task
from .spec import Spec, _flat


@dataclass(frozen=True)
class Job:
    """What every drive of a campaign has in common. It can be pickled: workers need none of the files."""

    table: dict[str, Any]
    texts: dict[str, str]
    paths: dict[str, str]
    logs: str  # folder for whole logs; empty: none is kept

    @staticmethod
    def of(spec: Spec, folder: str | os.PathLike[str]) -> Job:
        """Of a campaign that writes into `folder`."""
        return Job(spec.table, spec.texts, spec.paths, str(Path(folder) / "logs") if spec.keep.get("logs") else "")

    def run(self, row: Row) -> Row:
        """One drive."""
        return {"status": "done", "error": None, **_drive(self, row)}


def run_row(job: Task, row: Row) -> Row:
    """What a row's table row has beside the factors. What goes wrong in the drive is told in `error`, and stops no other."""
    try:
        return job.run(row)
    except (InputError, ArithmeticError, LookupError, RuntimeError, TypeError, ValueError) as error:
        return {"status": "failed", "error": str(error) or type(error).__name__}


def _drive(job: Job, row: Row) -> Row:
    keep = job.table.get("keep", {})
    formulas = {name: Formula(text, name) for name, text in keep.get("figures", {}).items()}
    series = keep.get("columns", [])
    given = _flat(job.table.get("set", {})) | {k: v for k, v in row.items() if k not in ("drive", "repeat", "seed", "hide_seed")}
    options: dict[str, Any] = {"firmware": str(given.pop("firmware", "")), "seed": row["seed"], "effects": _effects(given)}
    if "hide_seed" in row:
        options |= {"hide": row["hide_seed"], "hide_count": job.table["hide"]}
    options["truth"] = any(name.split(".")[0] == "truth" for f in formulas.values() for name in f.signals) or any(
        name.startswith("truth.") for name in series
    )
    log = drive(_scenario(job, given), **options)
    assert log.run is not None
    out: Row = {
        "ticks": log.run.ticks,
        "faults": log.run.faults,
        "fault_names": log.run.fault_names,
        "trace_hash": log.run.trace_hash,
        "hidden": _hidden(log.run.seal),
    }
    out |= figures(formulas, log, log.run.truth)
    out |= _series(series, keep.get("rate_Hz"), log)
    if keep.get("diagnosis"):
        out |= _diagnosis(job, log)
    if job.logs:
        os.makedirs(job.logs, exist_ok=True)
        log.write(Path(job.logs) / f"drive-{row['drive']:08d}.csv")
    return out


def _scenario(job: Job, given: Row) -> _core.ScenarioData:
    rovers = {key: Rover.parse(job.texts[f"{key}:{given[key]}"], str(given[key])) for key in ("rover", "believes") if key in given}
    name = given.get("scenario", job.table.get("scenario"))
    changes = {key: value for key, value in given.items() if key not in ("scenario", "rover", "believes")}
    if isinstance(name, Mapping):
        return load(name, changes, rover=rovers.get("rover"), believes=rovers.get("believes"))
    text, file = job.texts[f"scenario:{name}"] + "\n", job.paths[f"scenario:{name}"]
    return load(text, changes, rover=rovers.get("rover"), believes=rovers.get("believes"), name=file)


def _effects(given: Row) -> list[str]:
    """Takes "effect.NAME.PARAMETER" out of the keys: effects as the command line writes them."""
    found: dict[str, list[str]] = {}
    for key in [key for key in given if key.startswith("effect.")]:
        _, name, parameter = key.split(".", 2)
        value = given.pop(key)
        found.setdefault(name, []).append(f"{parameter}={value!r}" if isinstance(value, float) else f"{parameter}={value}")
    return [f"{name}:{','.join(parameters)}" for name, parameters in found.items()]


def _hidden(seal: str) -> str | None:
    return json.dumps(json.loads(seal)["effects"], sort_keys=True) if seal else None


def _series(names: list[str], rate_Hz: float | None, log: Log) -> Row:
    if not names:
        return {}
    assert log.run is not None
    both: dict[str, Any] = {**(log.run.truth or {}), **log}
    missing = [name for name in names if name not in both]
    if missing:
        raise LookupError(f"keep.columns: the log has no {missing[0]!r}")
    axis, values = Log.resampled(both, names, rate_Hz=rate_Hz)  # type: ignore[arg-type]
    return {"series.t_s": axis.tolist(), **{f"series.{name}": v.tolist() for name, v in values.items()}}


def _diagnosis(job: Job, log: Log) -> Row:
    name = job.table["keep"]["diagnosis"]
    told = diagnose(Model.parse(job.texts[f"keep.diagnosis:{name}"], name), log)
    ladder = told.ladder
    return {
        "verdict": told.kind,
        "named": json.dumps(list(told.verdict.effects if told.verdict else ())),
        "error_before": ladder[0].heldout if ladder else None,
        "error_after": ladder[-1].heldout if ladder else None,
    }
