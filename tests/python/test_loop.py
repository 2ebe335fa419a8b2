"""Loops of one's own: the firmware's bits, pickles, the Gymnasium environment."""

import copy
import pickle

import numpy as np
import pytest

import traction
from test_log import SHORT
from traction import Command, Firmware, Mode, Plant


def drive(plant, firmware, ticks, command=None):
    traces = []
    for _ in range(ticks):
        frame = plant.step(0.01)
        trace = firmware.step(frame, plant.planned(frame.tick) if command is None else command)
        plant.write(trace)
        traces.append(trace)
    return traces


def test_a_loop_of_ones_own_is_simulates_drive():
    log = traction.simulate(SHORT)
    traces = drive(Plant(SHORT), Firmware(SHORT), 300)
    speed = np.array([t.speed_m_s for t in traces])
    np.testing.assert_allclose(log["estimate.speed_m_s"].values, speed, atol=5e-7)  # the log rounds to 1e-6
    duty = np.array([t.duty[1] for t in traces])
    np.testing.assert_allclose(log["wheel1.duty"].values, duty, atol=1 / 32767)  # the log has what was written: Q15


def test_a_pickled_firmware_goes_on_with_the_same_bits():
    plant, firmware = Plant(SHORT), Firmware(SHORT)
    drive(plant, firmware, 100)
    other, third = pickle.loads(pickle.dumps(firmware)), copy.deepcopy(firmware)
    for _ in range(100):
        frame = plant.step(0.01)
        again = pickle.loads(pickle.dumps(frame))
        traces = [f.step(given, plant.planned(frame.tick)) for f, given in ((firmware, frame), (other, again), (third, frame))]
        plant.write(traces[0])
        assert pickle.dumps(traces[0]) == pickle.dumps(traces[1]) == pickle.dumps(traces[2])


def test_objects_do_not_share_state():
    alone = [t.speed_m_s for t in drive(Plant(SHORT), Firmware(SHORT), 100)]
    a, b, other = Plant(SHORT), Plant(SHORT, seed=9), Firmware(SHORT)
    firmware, together = Firmware(SHORT), []
    for _ in range(100):
        frame = a.step()
        trace = firmware.step(frame, a.planned(frame.tick))
        a.write(trace)
        b.write(other.step(b.step(), Command(Mode.OPEN_LOOP, duty=[0.2] * 4)))
        together.append(trace.speed_m_s)
    assert together == alone


def test_a_plant_steps_by_ticks_and_refuses_the_rest():
    plant = Plant(SHORT)
    plant.step(0.05)
    assert plant.t_s == pytest.approx(0.05)
    plant.write([0.3] * 4)
    plant.step(0.03)
    assert plant.truth["wheel_speed_rad_s"][0] > 0
    for dt in (0, 0.015, -1, float("nan")):
        with pytest.raises(ValueError, match="dt_s"):
            plant.step(dt)
    with pytest.raises(TypeError):
        Command(Mode.STOP, dutty=1)
    with pytest.raises(ValueError):
        Command(17)


def test_any_frame_is_accepted():
    firmware = Firmware(traction.Rover())
    frame = traction.Frame()
    frame.encoder_count[:] = [2**31 - 1, -(2**31), 0, 5]
    for _ in range(50):
        trace = firmware.step(frame, Command(Mode.PLATFORM_SPEED, platform_speed_m_s=float("nan")))
    assert np.all(np.abs(trace.duty) <= 1)


def test_check_env_finds_nothing_and_seeds_are_to_the_bit():
    gymnasium = pytest.importorskip("gymnasium")
    from gymnasium.utils.env_checker import check_env

    import traction.gym  # noqa: F401

    env = gymnasium.make("traction/Rover-v0")
    check_env(env.unwrapped, skip_render_check=True)
    runs = []
    for _ in range(2):
        seen, _ = env.reset(seed=5)
        env.action_space.seed(1)
        bits = [seen.tobytes()]
        for _ in range(50):
            seen, reward, *_ = env.step(env.action_space.sample())
            bits.append(seen.tobytes() + np.float64(reward).tobytes())
        runs.append(bits)
    assert runs[0] == runs[1]
    assert env.reset(seed=6)[0].tobytes() != runs[0][0]
    assert env.reset(seed=5)[0].tobytes() == runs[0][0]
    first, second = env.reset()[0], env.reset()[0]
    assert first.tobytes() != second.tobytes()  # the next episode's noise is another


class SlipPI:
    """A PI slip controller in ten lines: the front wheels slip by 0.3 against the drag of the rear wheels, whose windings are shorted."""

    def __init__(self, slip=0.3, kp=0.2, ki=0.8):
        self.slip, self.kp, self.ki, self.sum = slip, kp, ki, np.zeros(4)

    def __call__(self, seen):
        error = self.slip - seen[4:8]
        error[seen[4:8] == 0] = 0.1  # slip has no meaning yet: pull away
        self.sum = np.clip(self.sum + self.ki * 0.01 * error, -0.9, 0.9)
        duty = np.clip(self.kp * error + self.sum, -1, 1).astype(np.float32)
        duty[:2] = 0
        return duty


def test_a_pi_slip_controller_in_ten_lines_drives_the_rover():
    gymnasium = pytest.importorskip("gymnasium")
    import traction.gym  # noqa: F401

    env = gymnasium.make(
        "traction/Rover-v0", scenario=SHORT.replace("duration_s = 3.0", "duration_s = 12.0").replace("for_s = 3.0", "for_s = 12.0")
    )
    policy = SlipPI()
    seen, _ = env.reset(seed=1)
    slips, ended = [], False
    while not ended:
        seen, _, terminated, truncated, info = env.step(policy(seen))
        ended = terminated or truncated
        slips.append(info["truth"]["wheel_slip"])
    assert truncated and not terminated and info["truth"]["position_m"][0] > 0.5
    # The last six seconds. What is held is the firmware's slip; speed is known to 0.015 m/s (README), here of 0.12: (1 - 0.3) 0.015/0.12
    assert np.all(np.abs(np.median(np.array(slips)[600:, 2:], axis=0) - 0.3) < 0.09)
