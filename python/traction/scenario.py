"""The simulated rover: scenarios in, logs out."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from . import _core, _html
from ._data import find
from ._errors import ScenarioError
from .log import Log, Run

ScenarioLike: TypeAlias = "str | os.PathLike[str] | Mapping[str, Any]"


@dataclass(frozen=True)
class RoverParameter:
    """One number of a rover: its dotted key, SI unit, whether the description gives it (else it is the reference's), and its source."""

    key: str
    value: float
    unit: str
    given: bool
    source: str


class Rover:
    """A rover's description (docs/rover_format.md)."""

    def __init__(self, core: _core.RoverData | None = None) -> None:
        self._core = _core.RoverData() if core is None else core

    @staticmethod
    def read(file: str | os.PathLike[str]) -> Rover:
        """Read a rover's TOML file, or a shipped one by its name ("heavy"). Raises ScenarioError with line and key."""
        return Rover(_core.RoverData.read(find(file, "rovers")))

    @staticmethod
    def parse(text: str, name: str = "rover") -> Rover:
        """The same from TOML text; `name` stands for the file in messages."""
        return Rover(_core.RoverData.parse(text, name))

    @property
    def name(self) -> str:
        """Its name."""
        return self._core.name

    @property
    def parameters(self) -> dict[str, RoverParameter]:
        """Every number by its dotted key."""
        return {row[0]: RoverParameter(*row) for row in self._core.rows}

    def firmware_text(self) -> str:
        """The parameter file of its firmware."""
        return self._core.firmware_text()

    def model_text(self, soil: str) -> str:
        """A model of it on `soil`, as TOML: what the lab starts from."""
        return self._core.model_text(soil)

    def __repr__(self) -> str:
        return f"<Rover {self.name}>"

    def _repr_html_(self) -> str:
        rows = [(p.key, f"{p.value:.6g}", p.unit, p.source if p.given else "") for p in self.parameters.values()]
        return _html.table(f"rover {self.name}", ("key", "value", "unit", "source"), rows)


def as_rover(rover: Rover | str | os.PathLike[str]) -> Rover:
    """A rover, or the file of one."""
    return rover if isinstance(rover, Rover) else Rover.read(rover)


def load(
    scenario: ScenarioLike,
    changes: Mapping[str, Any] | None = None,
    *,
    rover: Rover | str | os.PathLike[str] | None = None,
    believes: Rover | str | os.PathLike[str] | None = None,
    name: str = "scenario",
) -> _core.ScenarioData:
    """The scenario that is meant by a file, a shipped one's name, TOML text or a dict, with `changes` by dotted key."""
    changed = {key.replace("__", "."): _plain(value) for key, value in (changes or {}).items()}
    if isinstance(scenario, Mapping):
        core = _core.ScenarioData.of_dict(_plain(scenario), name, changed)
    elif isinstance(scenario, str) and ("\n" in scenario or ("=" in scenario and not os.path.exists(scenario))):
        core = _core.ScenarioData.of_text(scenario, name, changed)
    else:
        file = find(scenario, "scenarios")
        try:
            with open(file, encoding="utf-8") as stream:
                text = stream.read()
        except (OSError, UnicodeDecodeError) as error:
            why = error.strerror if isinstance(error, OSError) else "is not UTF-8 text"
            mend = "give a scenario file, the name of a shipped one such as 'cruise', TOML text, or a dict"
            raise ScenarioError(f"{file}: {why}; to mend: {mend}", file, mend=mend) from None
        core = _core.ScenarioData.of_text(text, file, changed)
    if rover is not None:
        core.set_rover(as_rover(rover)._core)
    if believes is not None:
        core.set_believes(as_rover(believes)._core)
    return core


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    item = getattr(value, "tolist", None)  # NumPy's scalars and arrays
    return value if item is None else item()


def simulate(
    scenario: ScenarioLike,
    *,
    seed: int | None = None,
    effects: Sequence[str] = (),
    hide: int | None = None,
    hide_count: int = 1,
    rover: Rover | str | os.PathLike[str] | None = None,
    believes: Rover | str | os.PathLike[str] | None = None,
    firmware: str = "",
    truth: bool = False,
    **changes: Any,
) -> Log:
    """Drive the simulated rover through a scenario; its log is `traction simulate`'s, bit for bit.

    Args:
        scenario: a file, the name of a shipped scenario ("cruise"), TOML text, or a dict of the same keys.
        seed: of sensors' noise and grip, instead of the scenario's, 0 to 2^63 - 1.
        effects: effects to add, "slip_sinkage:coefficient=0.2,wheel=2" (`traction.effects()` lists them).
        hide: seed by which an effect is drawn that the log does not tell; it is sealed in `log.run.seal`.
        hide_count: how many are drawn, 1 to 5.
        rover: the rover that drives, instead of the scenario's.
        believes: the rover that the firmware takes itself for.
        firmware: "default" or "paper", instead of the scenario's.
        truth: also keep what really happened, in `log.run.truth`.
        **changes: keys of the scenario by dotted name, `**{"ground.soil": "gravel", "drive[0].speed_m_s": 0.2}`; two underscores stand
            for a dot: `ground__soil="gravel"`.

    Returns:
        the log; `log.run` tells seed, faults, hash, seal.

    Raises ScenarioError with file, line, key and mend; KeyboardInterrupt within a tenth of a second. Other Python threads run meanwhile.

    """
    core = load(scenario, changes, rover=rover, believes=believes)
    return drive(core, seed=seed, effects=effects, hide=hide, hide_count=hide_count, firmware=firmware, truth=truth)


def drive(
    core: _core.ScenarioData,
    *,
    seed: int | None = None,
    effects: Sequence[str] = (),
    hide: int | None = None,
    hide_count: int = 1,
    firmware: str = "",
    truth: bool = False,
) -> Log:
    """`simulate` of a scenario that is loaded already."""
    for name, number in (("seed", seed), ("hide", hide)):
        if number is not None and not 0 <= number < 2**63:
            raise ScenarioError(
                f"{name}: {number} is no seed; to mend: give 0 to 2^63 - 1", key=name, value=str(number), mend="give 0 to 2^63 - 1"
            )
    if not 1 <= hide_count <= 5:
        raise ScenarioError(
            f"hide_count: {hide_count} effects cannot be hidden; to mend: give 1 to 5", key="hide_count", mend="give 1 to 5"
        )
    if firmware not in ("", "default", "paper"):
        mend = "give 'default' or 'paper'"
        raise ScenarioError(f"firmware: there is no configuration {firmware!r}; to mend: {mend}", key="firmware", value=firmware, mend=mend)
    if isinstance(effects, str):
        effects = [effects]
    result = _core.drive(core, seed, list(effects), hide, hide_count, firmware, truth, True)
    log = Log(result.log)
    log.run = Run(
        result.seed,
        result.ticks,
        result.faults,
        result.fault_words,
        result.trace_hash,
        result.seal,
        None if result.truth is None else Log(result.truth),
    )
    return log


@dataclass(frozen=True)
class EffectParameter:
    """A parameter of an effect. `strength`: 0 of it is no effect; `variants`: the shapes it may take, where it is a choice."""

    name: str
    unit: str
    meaning: str
    strength: bool
    minimum: float
    maximum: float
    typical: float
    of_interest: float
    variants: Any


@dataclass(frozen=True)
class Effect:
    """An effect of the catalogue: its equation and source, what its residual looks like, and which manoeuvre reveals it."""

    name: str
    title: str
    acts_on: str
    per_wheel: bool
    equation: str
    source: str
    signature: str
    reveals: str
    parameters: tuple[EffectParameter, ...]

    def _repr_html_(self) -> str:
        rows = [(p.name, f"{p.minimum:g} to {p.maximum:g}", f"{p.typical:g}", p.unit, p.meaning) for p in self.parameters]
        words = "".join(f"<p>{_html.text(line)}</p>" for line in (self.equation, self.signature, self.reveals, self.source))
        return _html.table(f"{self.name}: {self.title}", ("parameter", "range", "typical", "unit", "meaning"), rows) + words


def effects() -> dict[str, Effect]:
    """Every effect of the catalogue by its name."""
    return {
        e["name"]: Effect(**{**e, "parameters": tuple(EffectParameter(**p) for p in e["parameters"])}) for e in json.loads(_core.effects())
    }
