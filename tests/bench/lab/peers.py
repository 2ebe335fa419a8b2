"""peers.py LOGS.json ANSWERS.json - PySINDy (STLSQ) and SysIdentPy (FROLS) asked the lab's question: which effect is missing?

Both regress; neither knows a rover. Their best honest use is to hand them the baseline model's residual equations, stacked and
scaled by sensor noise, with one or more regressors per catalogue effect built from the law and the measured signals:
  torque balance, voltage balance (per wheel), body force balance, yaw balance, radar against camera, accelerometer against camera.
An effect without a regressor that is linear in its strength (backlash) has none. The baseline's own parameters (motor constant,
resistance, inertia, friction, mu, rolling resistance, accelerometer bias) are projected out first, as the lab's fit does.
"""
import json
import sys
import time
import warnings

import numpy as np
from scipy.signal import savgol_filter

warnings.filterwarnings("ignore")
KG, RA, J, B0, T0, R, M, IZ, HB, HT, G = 0.265, 3.24, 5e-3, 1.6e-3, 0.03, 0.057, 2.88, 0.0391, 0.083, 0.12, 9.81
SOIL = {"sand": (5.1 / 7, 0.27, 0.05, False), "gravel": (6.8 / 7, 0.088, 0.03, False), "concrete": (0.8, 0.05, 0.01, True)}
STEP = 0.1
ALONG, SIDE = np.array([-1, -1, 1, 1]), np.array([1, -1, 1, -1])


def read(path):
    with open(path) as file:
        lines = [line for line in file if not line.startswith("#")]
    names = lines[0].strip().split(",")
    table = np.array([[float(x) if x else np.nan for x in line.rstrip("\n").split(",")] for line in lines[1:]])
    signals = {}
    for name, column in zip(names[1:], table[:, 1:].T):
        there = ~np.isnan(column)
        signals[name] = (table[there, 0], column[there])
    return signals


def shape(s, sc, hard):
    x = np.abs(s) / sc
    f = 1 - np.exp(-x) if hard else np.where(x < 1e-4, x / 2, 1 - (1 - np.exp(-x)) / np.maximum(x, 1e-9))
    return np.sign(s) * f


def equations(path, soil):
    mu, sc, crr, hard = SOIL[soil]
    sig = read(path)
    t0, t1 = 0.5, sig["wheel0.encoder_count"][0][-1] - 0.5
    t = np.arange(t0, t1, STEP)

    def mean(name, delay=0.0):  # over +-STEP/2
        ts, y = sig[name]
        c = np.concatenate(([0], np.cumsum(y)))
        a, b = np.searchsorted(ts - delay, t - STEP / 2), np.searchsorted(ts - delay, t + STEP / 2)
        return (c[b] - c[a]) / np.maximum(b - a, 1)

    ct, cx = sig["camera.x_m"]
    cy, cyaw = sig["camera.y_m"][1], sig["camera.yaw_rad"][1]
    dt = np.median(np.diff(ct))
    vx, vy = savgol_filter(cx, 5, 2, 1, dt), savgol_filter(cy, 5, 2, 1, dt)
    v_cam = vx * np.cos(cyaw) + vy * np.sin(cyaw)
    v, yaw = np.interp(t, ct, v_cam), np.interp(t, ct, cyaw)
    x, y = np.interp(t, ct, cx), np.interp(t, ct, cy)
    path_m = np.cumsum(v) * STEP
    dv = savgol_filter(v, 5, 2, 1, STEP)
    acc, r, volt = mean("imu.accel_x_m_s2", 0.005), mean("imu.gyro_z_rad_s"), mean("battery.voltage_V")
    dr = savgol_filter(r, 5, 2, 1, STEP)
    W = []
    for i in range(4):
        et, count = sig[f"wheel{i}.encoder_count"]
        angle = count * 2 * np.pi / 6000
        w_all = savgol_filter(angle, 11, 2, 1, 0.01)
        w = np.interp(t, et, w_all)
        dw = np.interp(t, et, savgol_filter(w_all, 11, 2, 1, 0.01))
        u = mean(f"wheel{i}.duty", -0.005) * volt
        W.append((w, dw, mean(f"wheel{i}.current_A", 0.005), u, np.interp(t, et, angle)))
    Fn = M * G / 4
    n, rows, columns = len(t), [], {}
    blocks = 4 + 4 + 4  # torque x4, voltage x4, body, yaw, radar, accelerometer
    sigma = {"torque": 0.03, "voltage": 0.006, "body": 0.1, "yaw": 0.3, "radar": 0.03, "accel": 0.1}

    def put(name, block, values):
        columns.setdefault(name, np.zeros((blocks, n)))[block] += values

    target = np.zeros((blocks, n))
    force, rolling, moment = np.zeros(n), np.zeros(n), np.zeros(n)
    patches = [(a, a + 1.0) for a in np.arange(np.floor(path_m.min()), path_m.max(), 0.5)]
    hot = lambda I, tau: np.array(_lag(I**2, tau))
    for i, (w, dw, I, u, theta) in enumerate(W):
        vw = v - SIDE[i] * HT * r
        big = np.maximum(np.maximum(np.abs(R * w), np.abs(vw)), 0.03)
        s = np.clip((R * w - vw) / big, -1, 1)
        F = mu * Fn * shape(s, sc, hard)
        dF = mu * Fn * (shape(s + 1e-4, sc, hard) - shape(s - 1e-4, sc, hard)) / 2e-4
        sgn, sv = np.tanh(w / 0.05), np.tanh(vw / 0.02)
        Q = crr * Fn * sv
        st, sb, sy = sigma["torque"] * KG, sigma["body"] * M, sigma["yaw"] * IZ
        target[i] = (KG * I - (B0 * np.abs(w) + T0) * sgn - J * dw - R * F) / st
        target[4 + i] = (I - (u - KG * w) / RA) / sigma["voltage"]
        force, rolling, moment = force + F, rolling + Q, moment - SIDE[i] * HT * (F - Q)

        def torque(name, values):
            put(name, i, values / st)
            put(f"{name}@{i}", i, values / st)

        def voltage(name, values):
            put(name, 4 + i, values / RA / sigma["voltage"])
            put(f"{name}@{i}", 4 + i, values / RA / sigma["voltage"])

        def grip(name, change):  # change of the wheel's force
            put(name, i, R * change / st)
            put(name, 8, -change / sb)
            put(name, 9, SIDE[i] * HT * change / sy)

        def resistance(name, values):
            put(name, 8, values / sb)
            put(name, 9, -SIDE[i] * HT * values / sy)

        torque("coulomb_friction", sgn)
        torque("viscous_friction", w)
        torque("stribeck_friction", np.exp(-(w**2)) * sgn)
        torque("mesh_loss", np.abs(R * F) * sgn)
        for order in (1, 2, 3, 4, 6, 8):
            torque(f"torque_ripple#{order}c", np.cos(order * theta) * sgn)
            torque(f"torque_ripple#{order}s", np.sin(order * theta) * sgn)
        heat = hot(I, 60)
        put("winding_heating", i, 2e-3 * heat * KG * I / st)
        put("winding_heating", 4 + i, -(3.9e-3 * heat * I) / sigma["voltage"])
        voltage("wiring_resistance", -I)
        voltage("bridge_dead_time", -np.sign(I))
        torque("torque_constant", -KG * I)
        voltage("torque_constant", -KG * w)
        put("current_gain", i, KG * I / st), put(f"current_gain@{i}", i, KG * I / st)
        voltage("current_gain", I * RA)
        torque("current_offset", np.full(n, KG))
        voltage("current_offset", np.full(n, RA))
        voltage("voltage_gain", -u)
        voltage("actuation_delay", -np.gradient(u, STEP))
        follows = 0.5 * (1 - ALONG[i] * np.tanh(v / 0.02))
        grip("multi_pass", F * follows)
        grip("soil_gradient", F * path_m)
        grip("sliding_speed_loss", -F * np.abs(R * w - vw))
        grip("shear_stiffness", -dF * s)
        grip("relaxation_length", -dF * np.gradient(s, STEP) / big)
        grip("load_transfer", -F / Fn * ALONG[i] * M * dv / (4 * HB))
        grip("mass_offset_x", F / Fn * ALONG[i] * M * G / (4 * HB))
        grip("mass_offset_y", F / Fn * SIDE[i] * M * G / (4 * HT))
        for k, (a, b) in enumerate(patches):
            grip(f"soil_patch#{k}", F * ((path_m >= a) & (path_m < b)))
        ds_dR = np.where(np.abs(R * w) > np.abs(vw), vw / np.maximum(np.abs(R * w), 0.03) ** 2 * np.sign(w) * w, w / big) * R
        grip("wheel_radius", dF * ds_dR), grip(f"wheel_radius@{i}", dF * ds_dR)
        grip("encoder_missed", dF * ds_dR), grip(f"encoder_missed@{i}", dF * ds_dR)
        voltage("encoder_missed", -KG * w)
        grip("camera_scale", dF * v / big)
        grip("camera_delay", -dF * dv / big)
        resistance("rolling_resistance", Fn * sv), resistance(f"rolling_resistance@{i}", Fn * sv)
        resistance("slip_sinkage", np.abs(s) * Fn * sv)
        resistance("speed_resistance", np.abs(vw) * Fn * sv)
        lateral = ALONG[i] * HB * np.tanh(ALONG[i] * HB * r / 0.005) * Fn
        put("lateral_scrub", 9, lateral / sy)
        # what the baseline may adjust
        put("_KG", i, KG * I / st), put("_KG", 4 + i, KG * w / RA / sigma["voltage"])
        put("_Ra", 4 + i, I / sigma["voltage"]), put("_J", i, dw / st), put("_b", i, w / st), put("_t0", i, sgn / st)
        grip("_mu", F), grip("_sc", -dF * s), resistance("_crr", Fn * sv)
    target[8] = (M * acc - force + rolling) / (-sigma["body"] * M)
    target[9] = (IZ * dr - moment) / (sigma["yaw"] * IZ) * -1
    rt, radar = sig["radar.speed_m_s"]
    v_mean = np.convolve(np.abs(v), np.ones(5) / 5)[: n]
    kernel = 1 - np.linspace(-1, 1, 9)[1:-1] ** 2  # a local parabola over five frames averages the acceleration like this
    kernel /= kernel.sum()
    acc_slow = np.convolve(acc, kernel, "same")
    have = (np.interp(t, rt, radar), np.min(np.abs(t[:, None] - rt[None, :]), axis=1) < 0.1)
    target[10] = np.where(have[1], (have[0] - v_mean) / sigma["radar"], 0)
    put("radar_scale", 10, np.where(have[1], v_mean, 0) / sigma["radar"])
    put("radar_pitch", 10, np.where(have[1], v_mean * dv, 0) / sigma["radar"])
    put("camera_scale", 10, np.where(have[1], -v_mean, 0) / sigma["radar"])
    put("camera_delay", 10, np.where(have[1], np.abs(dv), 0) / sigma["radar"])
    target[11] = (acc_slow - dv) / sigma["accel"]
    for name, values in {"accel_bias": np.ones(n), "accel_drift": t, "accel_scale": dv, "accel_tilt": np.array(_lag(dv, 0.1))}.items():
        put(name, 11, values / sigma["accel"]), put(name, 8, -values / sigma["body"])
    put("_bias", 11, np.ones(n) / sigma["accel"]), put("_bias", 8, -np.ones(n) / sigma["body"])
    put("grade", 11, np.cos(yaw) / sigma["accel"])
    put("tether_drag", 8, (x * np.cos(yaw) + y * np.sin(yaw)) / M / sigma["body"])
    put("body_drag", 8, np.tanh(v / 0.02) / M / sigma["body"])
    own = [k for k in columns if k.startswith("_")]
    names = [k for k in columns if not k.startswith("_")]
    Y = target.ravel()
    N = np.stack([columns[k].ravel() for k in own], 1)
    X = np.stack([columns[k].ravel() for k in names], 1)
    weight = 1 / np.maximum(1, np.abs(Y) / 5)  # jerks must not rule
    Y, N, X = Y * weight, N * weight[:, None], X * weight[:, None]
    q, _ = np.linalg.qr(N + 1e-12)
    before = np.sqrt((X**2).mean(0)) + 1e-12
    Y, X = Y - q @ (q.T @ Y), X - q @ (q.T @ X)
    size = np.sqrt((X**2).mean(0))
    keep = (size > 1e-3) & (size > 0.05 * before)  # the rest is what the baseline's own parameters can do
    return Y / np.sqrt((Y**2).mean()), X[:, keep] / size[keep], [k for k, ok in zip(names, keep) if ok]


def _lag(values, tau):
    state, out = 0.0, []
    for value in values:
        state += STEP / (tau + STEP) * (value - state)
        out.append(state)
    return out


def effects(order, names):
    said = []
    for k in order:
        name = names[k].split("@")[0].split("#")[0]
        if name not in said:
            said.append(name)
    return said


def sindy(Y, X, names):
    from pysindy.optimizers import STLSQ

    rows = len(Y) // 12
    fit, hold = np.arange(len(Y)) % rows < 0.7 * rows, np.arange(len(Y)) % rows >= 0.7 * rows
    best = None
    for threshold in (0.02, 0.05, 0.1, 0.2, 0.4):  # chosen on the held-out last 30 % of time
        model = STLSQ(threshold=threshold, alpha=1e-3, max_iter=20)
        model.fit(X[fit], Y[fit, None])
        coefficients = np.ravel(model.coef_)
        error = np.mean((Y[hold] - X[hold] @ coefficients) ** 2)
        if best is None or error < best[0]:
            best = (error, coefficients)
    c = best[1]
    return effects([k for k in np.argsort(-np.abs(c)) if c[k] != 0], names)


def frols(Y, X, names):
    from sysidentpy.basis_function import Polynomial
    from sysidentpy.model_structure_selection import FROLS

    model = FROLS(order_selection=True, n_info_values=15, info_criteria="bic", model_type="NFIR",
                  xlag=[[1]] * X.shape[1], basis_function=Polynomial(degree=1))
    model.fit(X=np.vstack([X[1:], X[-1:]]), y=Y[:, None])  # lag 1 pairs y[k] with x[k - 1]: shifted back here
    order = []
    for regressor in np.asarray(model.final_model)[:, 0]:
        if regressor >= 2000:
            order.append(int(regressor // 1000) - 2)
    return effects(order, names)


def main():
    with open(sys.argv[1]) as file:
        logs = json.load(file)
    peers = {
        "PySINDy STLSQ": {"ask": sindy, "use": "STLSQ on the stacked residual equations, threshold chosen on held-out time"},
        "SysIdentPy FROLS": {"ask": frols, "use": "FROLS, one lag-free linear term per regressor, order by BIC"},
    }
    for peer in peers.values():
        peer["answers"], peer["seconds"] = [], 0.0
    for log in logs:
        start = time.time()
        Y, X, names = equations(log["log"], log["soil"])
        prepared = time.time() - start
        for peer in peers.values():
            start = time.time()
            peer["answers"].append(peer["ask"](Y, X, names))
            peer["seconds"] += prepared + time.time() - start
    out = {"peers": {name: {"answers": p["answers"], "seconds_a_log": p["seconds"] / len(logs), "use": p["use"]} for name, p in peers.items()}}
    with open(sys.argv[2], "w") as file:
        json.dump(out, file, indent=1)


if __name__ == "__main__":
    main()
