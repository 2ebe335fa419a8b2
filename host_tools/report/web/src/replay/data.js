// data.js - the replay of a drive as numbers at any time: channels out of their 16-bit text, pose, wheels, and the radar's spectrum.
// Pure functions, tested by themselves (tests/e2e/report/replay_test.mjs). World: z up; body: x forward, y left, z up.

const ABSENT = 65535, WINDOW = 256;

// { lowest, step, data } as numbers; what is absent is NaN.
export function unpack(channel) {
  const text = atob(channel.data), out = new Float64Array(text.length / 2);
  for (let i = 0; i < out.length; ++i) {
    const code = text.charCodeAt(2 * i) + 256 * text.charCodeAt(2 * i + 1);
    out[i] = code === ABSENT ? NaN : channel.lowest + channel.step * code;
  }
  return out;
}

export function openDrive(replay) {
  const { t0_s: t0, dt_s: dt, rows, rover, channels } = replay, unpacked = new Map();
  const has = (name) => name in channels;
  const values = (name) => {
    if (!unpacked.has(name)) unpacked.set(name, has(name) ? unpack(channels[name]) : null);
    return unpacked.get(name);
  };
  // between two rows a straight line; beside a silence what is there
  const at = (name, t) => {
    const v = values(name);
    if (!v) return NaN;
    const place = Math.min(rows - 1, Math.max(0, (t - t0) / dt)), i = Math.min(rows - 1, Math.floor(place)), j = Math.min(rows - 1, i + 1);
    if (Number.isNaN(v[i]) || Number.isNaN(v[j])) return place - i < 0.5 ? v[i] : v[j];
    return v[i] + (place - i) * (v[j] - v[i]);
  };
  const or0 = (x) => (Number.isNaN(x) ? 0 : x);
  const radius = rover.wheel.reduce((sum, w) => sum + w.radius_m, 0) / Math.max(1, rover.wheel.length);
  const sunk = (t) => rover.wheel.reduce((sum, _, i) => sum + or0(at(`wheel${i}.sinkage_m`, t)), 0) / Math.max(1, rover.wheel.length);

  // The centre of mass over the wheels' lowest points: its height at the start, where the ground is taken for height 0; a height that no
  // rover of this size has (a map's, for one) says nothing of it.
  const high = values('z_m')?.find((z) => !Number.isNaN(z));
  const centre = high > 0 && high < 2 * rover.height_m ? high + sunk(t0) : radius;
  const kept = (name) => filled(values(name) ?? new Float64Array(rows)); // through a silence the rover stays where it was
  const where = { x: kept('x_m'), y: kept('y_m'), yaw: kept('yaw_rad') };
  const pose = (t) => {
    const row = Math.min(rows - 1, Math.max(0, Math.floor((t - t0) / dt)));
    const or = (name, key) => { const v = at(name, t); return Number.isNaN(v) ? where[key][row] : v; };
    const z = has('z_m') ? or0(at('z_m', t)) : centre - sunk(t);
    return { x: or('x_m', 'x'), y: or('y_m', 'y'), z, yaw: or('yaw_rad', 'yaw'), pitch: or0(at('pitch_rad', t)), roll: or0(at('roll_rad', t)), joint: or0(at('joint_rad', t)),
      known: !Number.isNaN(at('x_m', t)) };
  };
  const ghost = (t) => (has('ghost.x_m') && !Number.isNaN(at('ghost.x_m', t)) ? { x: at('ghost.x_m', t), y: at('ghost.y_m', t), yaw: at('ghost.yaw_rad', t) } : null);
  const wheel = (i, t) => Object.fromEntries(['slip', 'turn_rad', 'traction_N', 'normal_N', 'lateral_N', 'sinkage_m'].map((q) => [q, at(`wheel${i}.${q}`, t)]));
  return { t0, t1: t0 + (rows - 1) * dt, dt, rows, rover, radius, centre, has, at, values, pose, ghost, wheel, from: (name) => channels[name]?.from,
    notes: replay.notes ?? [], onTruth: replay.pose_from === 'truth', radar: replay.radar, level: !has('z_m') };
}

// What is absent is as it was before; at the beginning as it will be.
function filled(values) {
  const out = Float64Array.from(values), first = out.find((x) => !Number.isNaN(x)) ?? 0;
  for (let i = 0; i < out.length; ++i) if (Number.isNaN(out[i])) out[i] = i ? out[i - 1] : first;
  return out;
}

// A point of the body frame in the world; each half turns about the hinge by its share of the joint's angle.
export function toWorld(pose, halves, [x, y, z]) {
  const own = halves ? (y > 0 ? -0.5 : 0.5) * pose.joint : 0; // left half: y > 0; the joint is the right half against the left one
  const cp = Math.cos(pose.pitch + own), sp = Math.sin(pose.pitch + own), cr = Math.cos(pose.roll), sr = Math.sin(pose.roll);
  const cy = Math.cos(pose.yaw), sy = Math.sin(pose.yaw);
  const y1 = cr * y - sr * z, z1 = sr * y + cr * z; // roll, then pitch, then yaw
  const x2 = cp * x + sp * z1, z2 = -sp * x + cp * z1;
  return [pose.x + cy * x2 - sy * y1, pose.y + sy * x2 + cy * y1, pose.z + z2];
}

// The lowest point of a wheel in the world.
export function foot(drive, i, pose) {
  const { x_m, y_m } = drive.rover.wheel[i];
  return toWorld(pose, drive.rover.halves, [x_m, y_m, -drive.centre]);
}

// Rows that are worth a piece of a wheel's track: each a third of the radius farther on than the one before, or more where the drive is long,
// so that all tracks have `most` pieces at most. First and last row always.
export function trackRows(drive, i, most = 4000) {
  const share = most / Math.max(1, drive.rover.wheel.length), feet = [];
  for (let k = 0; k < drive.rows; ++k) feet.push(foot(drive, i, drive.pose(drive.t0 + k * drive.dt)));
  const far = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  const way = feet.reduce((sum, f, k) => sum + (k ? far(f, feet[k - 1]) : 0), 0), step = Math.max(drive.rover.wheel[i].radius_m / 3, (1.1 * way) / share);
  const kept = [0];
  for (let k = 1; k < drive.rows; ++k) if (k + 1 === drive.rows || far(feet[k], feet[kept.at(-1)]) >= step) kept.push(k);
  return kept;
}

// Samples of the radar and where its stretches without a hole begin.
export function openRadar(radar) {
  if (!radar) return null;
  const samples = unpack(radar), { rate_Hz: rate, stretches } = radar, stale = Math.max(1, radar.every_s ?? 0);
  const window = Float64Array.from({ length: WINDOW }, (_, i) => 0.5 - 0.5 * Math.cos((2 * Math.PI * i) / WINDOW)); // Hann
  // The 256 samples that end at t, the last ones of a stretch for a second more (or until the next window that was kept); else null.
  const spectrum = (t) => {
    let low = 0, high = stretches.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (stretches[middle][0] + (WINDOW - 1) / rate <= t) low = middle + 1;
      else high = middle;
    }
    if (low === 0) return null;
    const [begin, from, count] = stretches[low - 1], last = Math.min(count - 1, Math.floor((t - begin) * rate + 1e-6));
    const end_s = begin + last / rate;
    if (t - end_s > stale) return null;
    const part = samples.subarray(from + last - WINDOW + 1, from + last + 1);
    const mean = part.reduce((sum, v) => sum + v, 0) / WINDOW, power = fftPower(part.map((v, i) => (v - mean) * window[i]));
    // a sine of amplitude a gives (a N/4)^2: Hann's mean is 1/2. As the amplitude of a sine, in counts
    return { t_s: end_s, rate, amplitude: power.map((p) => (4 * Math.sqrt(p)) / WINDOW) };
  };
  return { spectrum, rate, Hz_per_m_s: radar.Hz_per_m_s };
}

// |X[k]|^2, k = 0..n/2, of n = 2^m real numbers: decimation in time, in place (Cooley and Tukey 1965).
export function fftPower(values) {
  const n = values.length, re = Float64Array.from(values), im = new Float64Array(n);
  for (let i = 1, j = 0; i < n; ++i) {
    let bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) [re[i], re[j]] = [re[j], re[i]];
  }
  for (let size = 2; size <= n; size <<= 1)
    for (let k = 0; k < size / 2; ++k) {
      const c = Math.cos((2 * Math.PI * k) / size), s = -Math.sin((2 * Math.PI * k) / size);
      for (let i = k; i < n; i += size) {
        const j = i + size / 2, a = re[j] * c - im[j] * s, b = re[j] * s + im[j] * c;
        re[j] = re[i] - a; im[j] = im[i] - b;
        re[i] += a; im[i] += b;
      }
    }
  return Float64Array.from({ length: n / 2 + 1 }, (_, k) => re[k] ** 2 + im[k] ** 2);
}
