"""The rover as a Gymnasium environment: `gymnasium.make("traction/Rover-v0")` after `import traction.gym`."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt

from .loop import Command, Firmware, Mode, Plant, Trace
from .scenario import ScenarioLike

Observation = npt.NDArray[np.float32]

# wheel speeds, slips, currents, speed, its deviation, acceleration, yaw rate, battery, speed that is asked for; units as in RoverEnv
_HIGH = np.array([200] * 4 + [1] * 4 + [100] * 4 + [20, 20, 200, 50, 100, 20], dtype=np.float32)


class RoverEnv(gymnasium.Env[Observation, Observation]):
    """Four duties in, what the firmware knows out, every 10 ms.

    Action: duty of the wheels, -1 to 1, shape (4,), float32. The firmware of the rover runs in open loop between agent and bridges, so its
    estimates, faults and stops are those of the rover.

    Observation: shape (18,), float32: wheel speeds [rad/s] (4), slips [1] (4, 0 where the firmware calls them invalid), currents [A] (4),
    fused ground speed and its standard deviation [m/s], forward acceleration [m/s^2], yaw rate [rad/s], battery [V], asked-for speed
    [m/s]; clipped to the space's bounds.

    Reward: minus the distance of true speed from asked-for speed [m/s], minus `energy_weight` times the battery's power [W].

    Episodes end (`terminated`) with a latched fault, and are cut (`truncated`) at the scenario's duration. `info` has the plant's `truth`
    and the firmware's `faults`.

    `reset(seed=s)` makes the noise of sensors and ground from s: same seed and actions, same bits. `reset()` draws the next seed
    from that one.
    """

    metadata = {"render_modes": [], "render_fps": 100}

    def __init__(
        self,
        scenario: ScenarioLike = "cruise",
        *,
        speed_ref_m_s: float = 0.2,
        energy_weight: float = 0.0,
        effects: tuple[str, ...] = (),
        render_mode: str | None = None,
    ) -> None:
        self.render_mode = render_mode
        self._scenario, self._effects = scenario, effects
        self._ref, self._energy_weight = float(speed_ref_m_s), float(energy_weight)
        low = -_HIGH
        self.observation_space = gymnasium.spaces.Box(low, _HIGH, dtype=np.float32)
        self.action_space = gymnasium.spaces.Box(-1, 1, (4,), dtype=np.float32)
        self._command = Command(Mode.OPEN_LOOP)
        self._plant: Plant | None = None

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Observation, dict[str, Any]]:
        """Begin anew; what the rover knows after one tick at rest. `options`: `speed_ref_m_s`, from now on."""
        super().reset(seed=seed)
        self._ref = float((options or {}).get("speed_ref_m_s", self._ref))
        self._plant = Plant(self._scenario, seed=int(self.np_random.integers(2**62)), effects=self._effects)
        self._firmware = Firmware(self._scenario)
        self._ticks = round(self._plant.duration_s * 100)
        self._command.duty = [0, 0, 0, 0]
        trace = self._tick()
        return self._seen(trace), self._info(trace)

    def step(self, action: Observation) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """One tick of 10 ms under four duties."""
        self._command.duty = [float(duty) for duty in action]
        trace = self._tick()
        assert self._plant is not None
        self._ticks -= 1
        info = self._info(trace)
        power_W = info["truth"]["battery_voltage_V"] * sum(
            abs(i * d) for i, d in zip(info["truth"]["wheel_current_A"], trace.duty, strict=True)
        )
        reward = -abs(self._plant.speed_m_s - self._ref) - self._energy_weight * power_W
        return self._seen(trace), float(reward), trace.faults != 0, self._ticks <= 0, info

    def _tick(self) -> Trace:
        if self._plant is None:
            raise gymnasium.error.ResetNeeded("call reset() first")
        trace = self._firmware.step(self._plant.step(0.01), self._command)
        self._plant.write(trace)
        return trace

    def _seen(self, trace: Trace) -> Observation:
        slips = np.where(trace.slip_valid, trace.slip, 0)
        rest = (
            trace.speed_m_s,
            trace.speed_std_m_s,
            trace.accel_x_m_s2,
            trace.gyro_z_rad_s,
            trace.battery_voltage_V,
            self._ref,
        )
        seen = np.concatenate([trace.wheel_speed_rad_s, slips, trace.current_A, rest]).astype(np.float32)
        return np.clip(np.nan_to_num(seen), -_HIGH, _HIGH)

    def _info(self, trace: Trace) -> dict[str, Any]:
        assert self._plant is not None
        return {"truth": self._plant.truth, "faults": trace.faults}


if "traction/Rover-v0" not in gymnasium.registry:
    gymnasium.register(id="traction/Rover-v0", entry_point="traction.gym:RoverEnv")
