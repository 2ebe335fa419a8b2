"""Loops of one's own: the simulated world tick by tick, and the firmware as one step.

    plant, firmware = Plant("cruise"), Firmware("cruise")
    command = Command(Mode.SLIP, slip_ref=0.3, slip_wheels=0b0001, platform_speed_m_s=0.2)
    for _ in range(1000):
        trace = firmware.step(plant.step(0.01), command)
        plant.write(trace)

A tick is 10 ms. Wheels: 0 rear left, 1 rear right, 2 front left, 3 front right.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from enum import IntEnum
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import Frame, Trace
from .scenario import Rover, ScenarioLike, as_rover, load

__all__ = ["Command", "Firmware", "Frame", "Mode", "Plant", "Trace"]


class Mode(IntEnum):
    """What drives the wheels."""

    STOP = 0
    OPEN_LOOP = 1
    WHEEL_SPEED = 2
    PLATFORM_SPEED = 3
    SLIP = 4
    SOIL_SWEEP = 5


class Command(_core.Command):
    """What is asked of the firmware. Out-of-range references are clamped there, NaN counts as 0.

    Attributes:
        mode: a `Mode`.
        platform_speed_m_s: PLATFORM_SPEED, SLIP, SOIL_SWEEP.
        yaw_rate_rad_s: PLATFORM_SPEED, SLIP; positive to the left.
        wheel_speed_rad_s: WHEEL_SPEED, shape (4,).
        duty: OPEN_LOOP, -1 to 1, shape (4,).
        slip_ref: SLIP, -1 to 1.
        slip_wheels: SLIP: bit i, wheel i is slip-servoed.
        age_ticks: since it was received; the firmware stops the rover on an old one.

    """

    def __init__(self, mode: int = Mode.STOP, **fields: Any) -> None:
        super().__init__()
        self.mode = int(mode)
        for name, value in fields.items():
            if not hasattr(type(self), name):
                raise TypeError(f"Command has no {name!r}")
            setattr(self, name, value)


class Firmware:
    """The rover's firmware: one pure C step, whose configuration and state this object owns.

    Any frame is accepted. Objects do not share state, may run in different threads, and can be pickled or copied at any tick: a copy goes
    on with the same bits. `of`: a `Rover`, or a scenario, whose firmware it is then.
    """

    def __init__(self, of: Rover | ScenarioLike, *, config: str = "") -> None:
        if isinstance(of, Rover):
            self._core = _core.FirmwareCore(of._core)
        else:
            self._core = _core.FirmwareCore(load(of), config)

    def step(self, frame: Frame, command: Command | None = None) -> Trace:
        """One tick of 10 ms: what the devices gave, what is asked for (nothing: stop), what came of it."""
        return self._core.step(frame, _STOP if command is None else command)

    def reset(self) -> None:
        """As after power-on."""
        self._core.reset()

    @property
    def wheel_radius_m(self) -> float:
        """Of the rover that it takes itself for."""
        return self._core.wheel_radius_m


class Plant:
    """The simulated world of a scenario: plant, sensors, late orders, failing sensors. It does not end with the scenario's duration.

    Same scenario, seed and orders: same bits. It cannot be copied or pickled (the ODE world has no such means): make it again and repeat
    the orders. Args as `traction.simulate` has them.
    """

    def __init__(
        self,
        scenario: ScenarioLike,
        *,
        seed: int | None = None,
        effects: Sequence[str] = (),
        rover: Rover | str | os.PathLike[str] | None = None,
        changes: Mapping[str, Any] | None = None,
    ) -> None:
        self._scenario = load(scenario, changes, rover=None if rover is None else as_rover(rover))
        self._core = _core.PlantCore(self._scenario, seed, [effects] if isinstance(effects, str) else list(effects))

    def step(self, dt: float = 0.01) -> Frame:
        """Advance by `dt` seconds, a multiple of 0.01, under the last order; what the devices give then.

        Orders older than 50 ms are released by the bridges, as on the rover: write again at least every fifth tick.
        """
        return self._core.step(dt)

    def write(self, order: Trace | npt.ArrayLike) -> None:
        """What the bridges do from now on: a firmware's trace, or duties, -1 to 1, shape (4,)."""
        if isinstance(order, Trace):
            self._core.write(order)
        else:
            self._core.set_duty(np.asarray(order, dtype=np.float64).tolist())

    def planned(self, tick: int) -> _core.Command:
        """What the scenario's own drive plan asks for in a tick."""
        return self._core.planned(tick)

    @property
    def truth(self) -> dict[str, Any]:
        """What really is: t_s, position_m (3), v_body_m_s (3), yaw_rad, battery_voltage_V, and of the wheels (4) wheel_speed_rad_s,
        wheel_slip, wheel_current_A, wheel_traction_N, wheel_sinkage_m."""
        core = self._core
        return {name: getattr(core, name) for name in _TRUTH}

    @property
    def t_s(self) -> float:
        """Simulated time in seconds."""
        return self._core.t_s

    @property
    def speed_m_s(self) -> float:
        """True forward speed of the body in m/s."""
        return self._core.v_body_m_s[0]

    @property
    def seed(self) -> int:
        """Of its noise."""
        return self._core.seed

    @property
    def duration_s(self) -> float:
        """Of the scenario."""
        return self._scenario.duration_s


_STOP = Command()
_TRUTH = (
    *("t_s", "position_m", "v_body_m_s", "yaw_rad", "battery_voltage_V"),
    *("wheel_speed_rad_s", "wheel_slip", "wheel_current_A", "wheel_traction_N", "wheel_sinkage_m"),
)
