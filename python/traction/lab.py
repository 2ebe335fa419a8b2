"""The lab: where a model fails a log, which effect is missing, how large it is, and which drive would tell."""

from __future__ import annotations

import builtins
import json
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np

from . import _core, _html
from ._data import find, find_map
from ._errors import LogError, ModelError
from .log import Floats, Log, as_log

LogLike: TypeAlias = "Log | str | os.PathLike[str]"
ModelLike: TypeAlias = "Model | str | os.PathLike[str]"


@dataclass(frozen=True)
class LadderStep:
    """A step of a model's history: its errors in units of noise, held out in blocks of 5 s; None where they were not measured."""

    label: str
    train: float | None
    heldout: float | None
    floor: float | None


class Model:
    """A model of a machine (docs/model_format.md). It is not changed: what adds, fits or drops gives a new one."""

    def __init__(self, core: _core.ModelData) -> None:
        self._core = core

    @staticmethod
    def read(file: str | os.PathLike[str]) -> Model:
        """Read a model's TOML file, or a shipped one by its name ("rover_sand"). Raises ModelError with line, key and mend."""
        return Model(_core.ModelData.read(find(file, "models")))

    @staticmethod
    def parse(text: str, name: str = "model") -> Model:
        """The same from TOML text; `name` stands for the file in messages."""
        return Model(_core.ModelData.parse(text, name))

    @property
    def name(self) -> str:
        """Its name."""
        return self._core.name

    @property
    def text(self) -> str:
        """The whole model as its file's TOML."""
        return self._core.text

    @property
    def effects(self) -> list[dict[str, Any]]:
        """Its effects: name, wheel where it is one wheel's, parameters with value, unit, low, high (95 %)."""
        return list(json.loads(self._core.head)["model"]["effects"])

    @property
    def ladder(self) -> list[LadderStep]:
        """Its history."""
        return _ladder(json.loads(self._core.ladder))

    def write(self, file: str | os.PathLike[str]) -> None:
        """Write it, whole or not at all."""
        self._core.write(os.fspath(file))

    def without(self, effect: str, wheel: int | None = None) -> Model:
        """The model without an effect, on one wheel or on whichever. Raises ModelError where it has none of it."""
        return Model(self._core.without(effect, -2 if wheel is None else wheel))

    def __repr__(self) -> str:
        added = ", ".join(effect["name"] for effect in self.effects)
        return f"<Model {self.name}{': ' + added if added else ''}>"

    def _repr_html_(self) -> str:
        rows = []
        for effect in self.effects:
            for key, p in effect["parameters"].items():
                interval = f"{_html.number(p['low'])} to {_html.number(p['high'])}" if p.get("low") is not None else ""
                rows.append((effect["name"], effect.get("wheel", "all"), key, _html.number(p["value"], 5), interval, p["unit"]))
        heads = ("effect", "wheel", "parameter", "value", "95 %", "unit")
        return _html.table(f"model {self.name}", heads, rows) + _html.ladder(_steps(self.ladder))


def as_model(model: ModelLike) -> Model:
    """A model, or the file of one."""
    return model if isinstance(model, Model) else Model.read(model)


@dataclass(frozen=True)
class Balance:
    """A measured signal against what the model says it should have been, at most 3000 points of it.

    `measured`, `model`, `residual` (measured - model) are in `unit`, at `t_s` in seconds, shape (n,), NaN where there is none. `sigma` is
    the noise of a row, `rmse` in `unit`, `nrmse` in units of noise.
    """

    name: str
    title: str
    unit: str
    sigma: float
    rmse: float
    nrmse: float
    t_s: Floats
    measured: Floats
    model: Floats

    @property
    def residual(self) -> Floats:
        """Measured - model."""
        return np.asarray(self.measured - self.model)


@dataclass(frozen=True)
class Candidate:
    """An effect that was tried. Gains are of the held-out error, with their 95 % interval; `verdict` as in docs/json_schema.md."""

    effect: str
    wheel: int | None
    verdict: str
    heldout_gain: float | None
    gain_low: float | None
    gain_high: float | None
    p_value: float | None
    parameters: dict[str, Any]


@dataclass(frozen=True)
class Verdict:
    """What the lab says: `kind` is named, class, partial, unknown, nothing or wrong_model."""

    kind: str
    effects: tuple[str, ...]
    text: str


@dataclass(frozen=True)
class FittedValue:
    """A fitted parameter with its 95 % interval."""

    value: float
    unit: str
    low: float
    high: float


class Result:
    """What a verb of the lab answers.

    Attributes:
        json: the whole answer, schema traction.lab/1 (docs/json_schema.md), as `traction VERB --json` writes it.
        text: the same in words, as the command line prints it.
        negative: it ran, and the answer is no (exit code 1 of the command line).

    """

    def __init__(self, core: _core.LabResult) -> None:
        self._core = core
        self.json: dict[str, Any] = json.loads(core.json)
        self.text: str = core.text
        self.negative: bool = core.negative

    @property
    def model(self) -> Model | None:
        """The model that the verb arrived at; None where there is none."""
        return None if self._core.model is None else Model(self._core.model)

    @property
    def score(self) -> dict[str, Any]:
        """Errors in units of noise over all balances: error, adjusted, floor, ratio, verdict."""
        return dict(self.json.get("score", {}))

    @cached_property
    def balances(self) -> dict[str, Balance]:
        """Measured and model by name."""
        keys = ("name", "title", "unit", "sigma", "rmse", "nrmse")
        return {
            b["name"]: Balance(*(b[k] for k in keys), *(np.array(b[k], dtype=np.float64) for k in ("t_s", "measured", "model")))
            for b in self.json.get("balances", [])
        }

    @property
    def ladder(self) -> list[LadderStep]:
        """How the error fell, a step a line."""
        return _ladder(self.json.get("ladder", []))

    @property
    def verdict(self) -> Verdict | None:
        """The verdict of diagnose and add; None elsewhere."""
        given = self.json.get("verdict")
        return Verdict(given["kind"], tuple(given["effects"]), given["text"]) if isinstance(given, dict) else None

    @property
    def messages(self) -> list[str]:
        """What was missing, mended or left out."""
        return list(self.json.get("messages", []))

    def report(self, file: str | os.PathLike[str]) -> None:
        """Write the page that `--report` writes: one HTML file that needs no network."""
        _core.write_report(self._core.json, os.fspath(file), self._core.replay)

    def __repr__(self) -> str:
        verdict = self.verdict
        return f"<{type(self).__name__}: {verdict.text if verdict else self.score.get('verdict', '')}>"

    def _repr_html_(self) -> str:
        out = f"<p><b>{_html.text(str(self.json.get('title', '')))}</b></p>"
        if self.verdict is not None:
            out += f"<p>{_html.text(self.verdict.text)}</p>"
        elif self.score:
            out += f"<p>{_html.text(str(self.score.get('verdict', '')))}</p>"
        if self.ladder:
            out += _html.ladder(_steps(self.ladder))
        rows = [(b.title, b.unit, _html.number(b.rmse), _html.number(b.nrmse)) for b in self.balances.values()]
        if rows:
            out += _html.table("residuals", ("balance", "unit", "rms", "x noise"), rows) + _core.residual_svg(self._core.json, 3)
        return out


class Comparison(Result):
    """Where the model fails."""


class Diagnosis(Result):
    """Which physics the model lacks. `model` is the model with what was named, refitted; None where nothing was."""

    @property
    def kind(self) -> str:
        """Of the verdict."""
        return self._core.kind

    @property
    def candidates(self) -> list[Candidate]:
        """First round, best first."""
        return _candidates(self.json.get("candidates", []))

    @property
    def accepted(self) -> list[Candidate]:
        """What was accepted, with final values."""
        return _candidates(self.json.get("accepted", []))

    @property
    def classes(self) -> list[tuple[str, ...]]:
        """Effects that this log cannot tell apart."""
        return [tuple(c["members"]) for c in self.json.get("classes", [])]

    def _repr_html_(self) -> str:
        rows = [(c.effect, "all" if c.wheel is None else c.wheel, c.verdict, _html.number(c.heldout_gain)) for c in self.candidates[:10]]
        return super()._repr_html_() + _html.table("candidates", ("effect", "wheel", "verdict", "held-out gain"), rows)


class Addition(Result):
    """An effect fitted into the model: `model` has it, `ladder` shows whether the held-out error fell."""


class Fit(Result):
    """Parameters fitted; `model` has them with their intervals."""

    @property
    def fitted(self) -> dict[str, FittedValue]:
        """Values by "table.key", or "table.key on wheel N"."""
        return {k: FittedValue(v["value"], v["unit"], v["low"], v["high"]) for k, v in self.json.get("fitted", {}).items()}

    @property
    def profiles(self) -> list[dict[str, Any]]:
        """Likelihood profiles, where they were asked for."""
        return list(self.json.get("profiles", []))


class Proposal(Result):
    """The next drive: `scenario` is its TOML for `traction.simulate`, empty where no drive helps."""

    @property
    def scenario(self) -> str:
        """TOML text."""
        return self._core.scenario

    @property
    def questions(self) -> list[dict[str, Any]]:
        """What is open, and what would answer it (docs/json_schema.md, `next`)."""
        return list((self.json.get("next") or {}).get("questions", []))

    def _repr_html_(self) -> str:
        rows = [(", ".join(q["members"]), q["status"], _html.number(q["d_before"]), _html.number(q["d_after"])) for q in self.questions]
        title = (self.json.get("next") or {}).get("title") or "no drive is proposed"
        return _html.table(str(title), ("question", "status", "d' before", "d' after"), rows)


@dataclass(frozen=True)
class Finding:
    """What the check says of a log: `severity` is error, warning or note; [t0_s, t1_s] where in the log."""

    id: str
    severity: str
    signal: str
    text: str
    mend: str
    value: float | None
    t0_s: float | None
    t1_s: float | None


class Check:
    """Whether a log is fit to learn from, and what its drive did not excite. `json`: schema traction.check/1."""

    def __init__(self, given: dict[str, Any]) -> None:
        self.json = given

    @property
    def passed(self) -> bool:
        """No finding is an error."""
        return bool(self.json["passed"])

    @property
    def findings(self) -> list[Finding]:
        """Everything found."""
        return [Finding(**f) for f in self.json["findings"]]

    @property
    def excitation(self) -> dict[str, Any]:
        """What the drive went through."""
        return dict(self.json["excitation"])

    def report(self, file: str | os.PathLike[str]) -> None:
        """Write it as one HTML page."""
        _core.write_report(json.dumps(self.json), os.fspath(file))

    def __bool__(self) -> bool:
        return self.passed

    def __repr__(self) -> str:
        return f"<Check {'passed' if self.passed else 'failed'}: {len(self.findings)} findings>"

    def _repr_html_(self) -> str:
        rows = [(f.severity, f.signal, f.text, f.mend) for f in self.findings]
        return _html.table(f"check {'passed' if self.passed else 'failed'}", ("severity", "signal", "finding", "mend"), rows)


def check(log: LogLike, model: ModelLike | None = None, *, map: str | os.PathLike[str] | None = None) -> Check:
    """Look for gaps, dead or stuck sensors, wrong signs and units, swapped wheels, clock jumps. With a model, scales are judged too.

    A file that cannot be read as a log is a finding here, not an exception; `map` is for a file.
    """
    used = None if model is None else as_model(model)
    core, name = (None, "") if used is None else (used._core, used._core.file)
    if isinstance(log, Log):
        return Check(json.loads(_core.check_log(log._core, core, log.source, name)))
    return Check(json.loads(_core.check_file(os.fspath(log), find_map(map), core, name)))


def compare(
    model: ModelLike,
    log: LogLike | Iterable[LogLike],
    *,
    fitted: bool = False,
    repeat: LogLike | None = None,
    from_s: float = 0,
    to_s: float = 0,
    despite: Sequence[str] = (),
) -> Comparison:
    """Show where the model fails the log, or the logs of one machine.

    Args:
        model: the model, or its file.
        log: a log, its file, or several.
        fitted: after the parameters moved within their priors.
        repeat: a second run of the same drive: noise is then measured instead of taken from the header.
        from_s: the part of the log to use, seconds.
        to_s: its end; 0 for the log's.
        despite: ids of the check's errors that shall not refuse it.

    Raises Refused where the log fails the check, ModelError, LogError.

    """
    return Comparison(_core.compare(as_model(model)._core, _inputs(log, (), repeat, from_s, to_s, despite), fitted))


def diagnose(
    model: ModelLike,
    log: LogLike | Iterable[LogLike],
    *,
    validate: LogLike | Iterable[LogLike] = (),
    repeat: LogLike | None = None,
    from_s: float = 0,
    to_s: float = 0,
    despite: Sequence[str] = (),
    progress: Callable[[int, int], None] | None = None,
) -> Diagnosis:
    """Name the physical effect that the model lacks, with its size and interval, or say that the log cannot tell.

    Args are those of `compare`; `validate` are runs that the result is judged on and never fitted to; `progress(done, guess_of_all)` is
    called as candidates are tried. Other threads run meanwhile; Ctrl-C ends it before the next fit.
    """
    return Diagnosis(_core.diagnose(as_model(model)._core, _inputs(log, validate, repeat, from_s, to_s, despite), progress))


def add(
    model: ModelLike,
    effect: str,
    log: LogLike | Iterable[LogLike],
    *,
    wheel: int | None = None,
    effect_file: str | os.PathLike[str] | None = None,
    validate: LogLike | Iterable[LogLike] = (),
    repeat: LogLike | None = None,
    from_s: float = 0,
    to_s: float = 0,
    despite: Sequence[str] = (),
) -> Addition:
    """Fit an effect of the catalogue, or of one's own in `effect_file` (TOML, [[effect]]), into the model, for all wheels or one."""
    core = as_model(model)._core
    inputs = _inputs(log, validate, repeat, from_s, to_s, despite)
    return Addition(_core.add(core, inputs, effect, -1 if wheel is None else wheel, os.fspath(effect_file or "")))


def drop(model: ModelLike, effect: str, *, wheel: int | None = None) -> Model:
    """The model without an effect; fit again afterwards."""
    return as_model(model).without(effect, wheel)


def fit(
    model: ModelLike,
    log: LogLike | Iterable[LogLike],
    *,
    profile: bool | Sequence[str] = False,
    validate: LogLike | Iterable[LogLike] = (),
    repeat: LogLike | None = None,
    from_s: float = 0,
    to_s: float = 0,
    despite: Sequence[str] = (),
) -> Fit:
    """Fit the model's parameters within their priors. `profile`: likelihood profiles, of every effect's strength or of those named."""
    which = None if profile is False else [] if profile is True else list(profile)
    return Fit(_core.fit(as_model(model)._core, _inputs(log, validate, repeat, from_s, to_s, despite), which))


def next(
    model: ModelLike,
    log: LogLike | Iterable[LogLike] = (),
    *,
    effects: Sequence[str] = (),
    all: bool = False,
    despite: Sequence[str] = (),
) -> Proposal:
    """Propose the drive that answers what a log left open, or that separates `effects`, with the d' it is predicted to reach.

    Without `effects` the log is diagnosed first; `all` also asks what that diagnosis did not doubt.
    """
    used = as_model(model)
    logs = _logs(log)
    if not effects and not logs:
        mend = "give a log, or effects, or both"
        raise ModelError(f"{used._core.file}: neither a log nor effects are given; to mend: {mend}", used._core.file, mend=mend)
    return Proposal(_core.next(used._core, _inputs(logs, (), None, 0, 0, despite, needed=False), list(effects), all))


def _logs(log: LogLike | Iterable[LogLike]) -> list[Log]:
    if isinstance(log, (Log, str, os.PathLike)):
        return [as_log(log)]
    return [as_log(item) for item in log]


def _inputs(
    log: LogLike | Iterable[LogLike],
    validate: LogLike | Iterable[LogLike],
    repeat: LogLike | None,
    from_s: float,
    to_s: float,
    despite: Sequence[str],
    *,
    needed: bool = True,
) -> _core.Inputs:
    inputs = _core.Inputs()
    inputs.logs = [item._core for item in _logs(log)]
    if needed and not inputs.logs:
        raise LogError("no log is given; to mend: give a log, its file, or several", mend="give a log, its file, or several")
    inputs.validate = [item._core for item in _logs(validate)]
    if repeat is not None:
        inputs.repeat = as_log(repeat)._core
    inputs.from_s, inputs.to_s, inputs.despite = from_s, to_s, [despite] if isinstance(despite, str) else list(despite)
    return inputs


def _ladder(steps: Iterable[dict[str, Any]]) -> list[LadderStep]:
    return [LadderStep(s["label"], s.get("train"), s.get("heldout"), s.get("floor")) for s in steps]


def _steps(ladder: Iterable[LadderStep]) -> builtins.list[tuple[str, float | None, float | None, float | None]]:
    return [(s.label, s.train, s.heldout, s.floor) for s in ladder]


def _candidates(given: Iterable[dict[str, Any]]) -> list[Candidate]:
    return [
        Candidate(
            effect=c["effect"],
            wheel=c.get("wheel"),
            verdict=c["verdict"],
            heldout_gain=c.get("heldout_gain"),
            gain_low=c.get("gain_low"),
            gain_high=c.get("gain_high"),
            p_value=c.get("p_value"),
            parameters=c.get("parameters", {}),
        )
        for c in given
    ]
