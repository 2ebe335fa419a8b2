// replay_test.mjs DATA.js - what the replay computes in the page, against closed forms.
import assert from 'node:assert/strict';
import { pathToFileURL } from 'node:url';
const { fftPower, foot, openDrive, openRadar, toWorld, unpack } = await import(pathToFileURL(process.argv[2]));

const near = (a, b, within, words) => assert.ok(Math.abs(a - b) <= within, `${words ?? ''} ${a} is not ${b} within ${within}`);
function packed(values) { // as pack.h says
  const real = values.filter(Number.isFinite), lowest = Math.min(...real), highest = Math.max(...real), step = (highest - lowest) / 65534;
  const bytes = Buffer.alloc(2 * values.length);
  values.forEach((v, i) => bytes.writeUInt16LE(Number.isFinite(v) ? (step ? Math.round((v - lowest) / step) : 0) : 65535, 2 * i));
  return { lowest, step, data: bytes.toString('base64') };
}
const rover = { name: 'r', mass_kg: 3, length_m: 0.3, width_m: 0.27, height_m: 0.185, halves: true,
  wheel: [[-0.1, 0.12], [-0.1, -0.12], [0.1, 0.12], [0.1, -0.12]].map(([x_m, y_m]) => ({ x_m, y_m, radius_m: 0.057, width_m: 0.04 })) };
const drive = (channels, rows = 101) => openDrive({ t0_s: 1, dt_s: 0.1, rows, pose_from: 'camera', rover, channels: Object.fromEntries(Object.entries(channels).map(([k, f]) => [k, packed(Array.from({ length: rows }, (_, i) => f(1 + 0.1 * i)))])) });

// unpack: lowest, highest, nothing
assert.deepEqual([...unpack({ lowest: -1, step: 2, data: Buffer.from([0, 0, 1, 0, 255, 255]).toString('base64') })], [-1, 1, NaN]);

// pose: between rows a line, beyond the ends what was there, through a silence where it was
const d = drive({ x_m: (t) => (t > 4.05 && t < 6.05 ? NaN : 2 * t), y_m: (t) => -t, yaw_rad: () => 0.3, 'wheel0.slip': (t) => (t < 3 ? 0.5 : NaN) });
near(d.pose(2.05).x, 4.1, 1e-3);
near(d.pose(-5).y, -1, 1e-3);
near(d.pose(99).y, -11, 1e-3);
near(d.pose(5).x, 8, 1e-3);
assert.equal(d.pose(5).known, false);
near(d.pose(8).x, 16, 1e-3);
assert.ok(Number.isNaN(d.wheel(0, 4).slip) && Math.abs(d.wheel(0, 2).slip - 0.5) < 1e-9);
near(d.pose(2).z, 0.057, 1e-9, 'level ground: the middle stands a radius high'); // no height in the log

// body to world: nose down is positive pitch, right side down positive roll, and the right half turns down by half the joint's angle
const flat = { x: 1, y: 2, z: 3, yaw: 0, pitch: 0, roll: 0, joint: 0 };
assert.deepEqual(toWorld(flat, true, [1, 0, 0]), [2, 2, 3]);
near(toWorld({ ...flat, yaw: Math.PI / 2 }, true, [1, 0, 0])[1], 3, 1e-12);
near(toWorld({ ...flat, pitch: 0.1 }, true, [1, 0, 0])[2], 3 - Math.sin(0.1), 1e-12);
near(toWorld({ ...flat, roll: 0.1 }, true, [0, -1, 0])[2], 3 - Math.sin(0.1), 1e-12);
near(toWorld({ ...flat, joint: 0.2 }, true, [1, -1, 0])[2], 3 - Math.sin(0.1), 1e-12);
near(toWorld({ ...flat, joint: 0.2 }, true, [1, 1, 0])[2], 3 + Math.sin(0.1), 1e-12);
near(toWorld({ ...flat, joint: 0.2 }, false, [1, 1, 0])[2], 3, 1e-12);

// feet: on terrain the height at the start says how high the middle stands; a height over the sea says nothing of it
const climb = drive({ x_m: (t) => t, y_m: () => 0, yaw_rad: () => 0, z_m: (t) => 0.08 + 0.1 * (t - 1) });
near(climb.centre, 0.08, 1e-4);
near(foot(climb, 0, climb.pose(1))[2], 0, 1e-4);
near(foot(climb, 3, climb.pose(6))[2], 0.5, 1e-4);
near(drive({ x_m: (t) => t, y_m: () => 0, yaw_rad: () => 0, z_m: () => 240 }).centre, 0.057, 1e-9);

// Fourier: a sum of squares against Parseval, a single line, against the sum itself
const noise = Array.from({ length: 64 }, (_, i) => Math.sin(i * i) + 0.3 * Math.cos(7 * i));
const power = fftPower(noise), both = power.reduce((sum, p, k) => sum + (k === 0 || k === 32 ? p : 2 * p), 0);
near(both / 64, noise.reduce((sum, v) => sum + v * v, 0), 1e-9, 'Parseval');
for (const k of [0, 1, 5, 32]) {
  const re = noise.reduce((sum, v, i) => sum + v * Math.cos((2 * Math.PI * k * i) / 64), 0), im = noise.reduce((sum, v, i) => sum + v * Math.sin((2 * Math.PI * k * i) / 64), 0);
  near(power[k], re * re + im * im, 1e-9, `line ${k}`);
}

// radar: a sine of 100 counts on a line of 2 Hz is read as 100; the window is the last 256 samples; holes are silence
const samples = Array.from({ length: 1280 }, (_, i) => 512 + 100 * Math.sin((2 * Math.PI * (i < 768 ? 40 : 90) * i) / 512));
const radar = openRadar({ ...packed(samples), rate_Hz: 512, stretches: [[0, 0, 768], [5, 768, 512]], Hz_per_m_s: 90 });
assert.equal(radar.spectrum(0.3), null); // not yet 256 samples
const early = radar.spectrum(1), top = (s) => s.amplitude.indexOf(Math.max(...s.amplitude));
assert.equal(top(early), 20); // 40 Hz in lines of 2 Hz
near(early.amplitude[20], 100, 0.01, 'amplitude'); // half a step of 200/65534 counts, averaged
near(early.t_s, 1, 1 / 512);
assert.equal(radar.spectrum(4), null); // long after the first stretch
assert.equal(top(radar.spectrum(5.9)), 45);
console.log('what the replay computes agrees with its closed forms');
