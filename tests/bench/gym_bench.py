"""How fast the Gymnasium environment steps: CPU time of 1,000 steps of 10 ms, over what they last and beside the same drive by simulate().

python tests/bench/gym_bench.py, with an interpreter that has the package and gymnasium. The best of several rounds, for machines are shared.
"""

import time

import gymnasium
import numpy as np
import traction.gym

STEPS, TICK_S, ROUNDS = 1000, 0.01, 10


def stepping() -> float:
    env = gymnasium.make("traction/Rover-v0", speed_ref_m_s=0.1)
    env.reset(seed=1)
    action = np.full(4, 0.1, np.float32)
    began = time.process_time()
    for _ in range(STEPS):
        env.step(action)
    return time.process_time() - began


def whole_drive() -> float:
    began = time.process_time()
    length = STEPS * TICK_S
    traction.simulate({"duration_s": length, "drive": [{"for_s": length, "mode": "platform_speed", "speed_m_s": 0.1}]})
    return time.process_time() - began


steps, drive = min(stepping() for _ in range(ROUNDS)), min(whole_drive() for _ in range(ROUNDS))
lasts = STEPS * TICK_S
print(f"{STEPS} steps: {1e3 * steps:.0f} ms, {lasts / steps:.0f} x real time; simulate() of the same length: {1e3 * drive:.0f} ms, {lasts / drive:.0f} x")
