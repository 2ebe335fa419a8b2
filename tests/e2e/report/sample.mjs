// sample.mjs OUT_DIR EFFECTS.json - writes results of every kind for the report page to be looked at: made-up numbers, seeded, in the shape of
// docs/json_schema.md. diagnose.json has every part; compare.json few; empty.json none; odd.json values that would break a
// careless page; large.json 11 balances of 1000 s, 20000 rows each; gaps.json rows left out and single rows; figures.json the page of `traction reproduce`.
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';

let state = 20240607n; // seed of splitmix64 (Steele, Lea and Flood 2014)
function uniform() {
  state = (state + 0x9e3779b97f4a7c15n) & 0xffffffffffffffffn;
  let z = state;
  z = ((z ^ (z >> 30n)) * 0xbf58476d1ce4e5b9n) & 0xffffffffffffffffn;
  z = ((z ^ (z >> 27n)) * 0x94d049bb133111ebn) & 0xffffffffffffffffn;
  return Number((z ^ (z >> 31n)) >> 11n) / 2 ** 53;
}
const normal = () => Math.sqrt(-2 * Math.log(1 - uniform())) * Math.cos(2 * Math.PI * uniform());

const drive = (t) => 0.35 * Math.sin(0.25 * t) + 0.15 * Math.sin(1.7 * t) + (t > 60 && t < 80 ? 0.3 : 0);

function balance(name, title, unit, sigma, points, missing, duration = 120) {
  const t_s = [], measured = [], model = [];
  for (let i = 0; i < points; ++i) {
    const t = (duration * i) / points;
    const y = drive(t + name.length) * sigma * 40;
    t_s.push(+t.toFixed(4));
    model.push(+y.toPrecision(6));
    measured.push(+(y + sigma * (normal() + missing * Math.max(0, drive(t)) * 9)).toPrecision(6));
  }
  const r = measured.map((m, i) => m - model[i]);
  const rmse = Math.sqrt(r.reduce((a, x) => a + x * x, 0) / points), bias = r.reduce((a, x) => a + x, 0) / points;
  const lag_s = Array.from({ length: 51 }, (_, i) => +(i * 0.04).toFixed(2));
  return { name, title, unit, sigma, sigma_source: 'the model file', t_s, measured, model, rmse, nrmse: rmse / sigma, bias, rows: points, gaps: [], strip: Array.from({ length: 24 }, (_, i) => (i === 3 ? null : 1 + missing * Math.max(0, drive(5 * i)) * 9)), r2: 1 - (0.02 + missing * 0.2),
    worst: [60, 65, 20].map((t0) => ({ t0_s: t0, t1_s: t0 + 5, rmse: rmse * (2 - t0 / 100) })),
    acf: { lag_s, value: lag_s.map((l) => (l === 0 ? 1 : missing * Math.exp(-l / 0.7) + 0.02 * normal())), band: 0.047 },
    ccf: [{ with: 'wheel2.set_speed_rad_s', lag_s: lag_s.map((l) => +(l - 1).toFixed(2)), value: lag_s.map((l) => missing * 0.5 * Math.exp(-Math.abs(l - 1.2)) + 0.02 * normal()), band: 0.047 }] };
}

const names = [0, 1, 2, 3].flatMap((i) => [[`wheel${i}.current_A`, `Motor current, wheel ${i}`, 'A', 0.02, i > 1 ? 0.6 : 0.25], [`wheel${i}.voltage_V`, `Voltage, wheel ${i}`, 'V', 0.05, 0]])
  .concat([['imu.accel_x_m_s2', 'Acceleration of the body', 'm/s^2', 0.05, 0.3], ['radar.speed_m_s', 'Ground speed by radar', 'm/s', 0.012, 0.2], ['camera.x_m', 'Position by camera', 'm', 0.001, 0.9]]);
const balances = names.map(([name, title, unit, sigma, missing]) => balance(name, title, unit, sigma, 3000, missing));

const parameter = (value, unit, spread) => ({ value, unit, low: value - spread, high: value + spread });
const candidate = (rank, effect, gain, verdict, parameters, extra = {}) => ({ rank, effect, wheel: null, variant: {}, heldout_gain: gain,
  gain_low: gain - 0.05, gain_high: gain + 0.04, p_value: 10 ** (-20 * gain), parameters, verdict, class: null, detectability: 30 * gain,
  evidence: Array.from({ length: 24 }, (_, i) => ({ t0_s: 5 * i, t1_s: 5 * i + 5, share: Math.max(0, drive(5 * i + 2.5)) / 6 })), explains: '', ...extra });

const compare = {
  schema: 'traction.lab/1', verb: 'compare', title: 'sand_identification.csv against the baseline rover',
  log: { file: 'sand_identification.csv', scenario: 'identification on sand', duration_s: 120 },
  model: { file: 'rover_baseline.toml', name: 'baseline rover', effects: [] },
  score: { error: 5.31, adjusted: 3.12, floor: 1, ratio: 3.1, verdict: 'The model misses by 5.3 times the sensor noise; retuning it within its tolerances leaves 3.1. Whether an effect is missing, traction diagnose tells.' }, balances,
  left: { before: { error: 3.12, parts: [{ cause: 'sensors', error: 1, text: 'noise of the sensors' }, { cause: 'ground', error: 2.9, text: 'how the ground varies from place to place' }, { cause: 'encoders', error: 0.57, text: 'quick changes of a wheel\'s speed, which the encoders blur' }] } },
  story: { headline: 'The model misses by 5.3 times the sensor noise; retuning it within its tolerances leaves 3.1.', where: 'The model fails most at slip 0.3 to 0.6, in 0.1 to 0.2 m/s: 6.3 times the noise.' },
  regimes: [
    { title: 'Slip and speed, wheel 2', x_label: 'slip', x_edges: [-1, -0.6, -0.3, -0.1, 0.1, 0.3, 0.6], y_labels: ['0 to 0.1 m/s', '0.1 to 0.2 m/s', '0.2 to 0.4 m/s'],
      value: [[1.1, 1.0, 1.0, 1.3, 2.2, 4.1], [1.0, 1.1, 1.0, 1.5, 3.0, 6.3], [null, 1.0, 1.1, 1.6, 3.4, null]], count: [[40, 210, 260, 800, 130, 60], [22, 150, 340, 900, 210, 45], [0, 30, 80, 340, 60, 0]] },
    { title: 'Wheel and time', x_label: 'time [s]', x_edges: [0, 20, 40, 60, 80, 100, 120], y_labels: ['wheel 0', 'wheel 1', 'wheel 2', 'wheel 3'],
      value: [[1, 1.1, 1, 1.4, 1.1, 1], [1, 1, 1, 1.3, 1, 1.1], [1.2, 1.6, 1.4, 5.2, 1.7, 1.3], [1.1, 1.5, 1.4, 4.9, 1.8, 1.2]], count: [] }],
  messages: ['camera: 3 gaps longer than 0.5 s (at 12.1, 48.0 and 77.4 s); the samples between are used',
    'wheel1.encoder_count: one jump of 65536 at 31.2 s was taken for a counter overflow'],
};

const diagnose = { ...compare, verb: 'diagnose', title: 'What is missing in the baseline rover on sand',
  verdict: { kind: 'named', effects: ['slip_sinkage'], text: 'The model lacks slip_sinkage: on what was not fitted the error falls by 67 %, from 3.120 to 1.030 x noise.' },
  story: { headline: 'The model misses by 5.3 times the sensor noise; retuning it within its tolerances leaves 3.1. slip_sinkage explains it. 1.1 times the sensor noise is left, of which 1.0 is noise of the sensors.',
    good_enough: 'No. The model misses by 5.3 times the sensor noise.', missing: 'slip_sinkage (resistance grows with slip): coefficient = 0.15 [0.13, 0.17].', sure: 'Sure of the effect, as far as a log can be: on parts of the log that took no part in the fit, the error falls by 67 %.',
    left: '1.1 times the sensor noise is left, of which 1.0 is noise of the sensors.', next: 'Drive this, it tells them apart: one wheel drags (40 s).', where: compare.story.where },
  left: { before: compare.left.before, after: { error: 1.1, parts: [{ cause: 'sensors', error: 1, text: 'noise of the sensors' }, { cause: 'ground', error: 0.46, text: 'how the ground varies from place to place' }] } },
  balances: balances.map((b) => ({ ...b, after: b.model.map((m, i) => +(m + 0.8 * (b.measured[i] - m)).toPrecision(6)), rmse_after: b.sigma * 1.05, nrmse_after: 1.05 })),
  candidates: [
    candidate(1, 'slip_sinkage', 0.66, 'named', { coefficient: parameter(0.15, '1', 0.02) }, { explains: 'rolling resistance that grows with slip: front wheels, 60 to 80 s' }),
    candidate(2, 'mesh_loss', 0.41, 'class', { fraction: parameter(0.22, '1', 0.06) }, { class: 1, words: 'possible: this log cannot tell it from the others marked so' }),
    candidate(3, 'coulomb_friction', 0.12, 'not_significant', { torque_Nm: parameter(0.0062, 'N m', 0.005) }, { wheel: 2, p_value: 0.21, words: 'no sure help' }),
    candidate(4, 'stribeck_friction', 0.08, 'too_small', { torque_Nm: parameter(0.0009, 'N m', 0.0004) }, { variant: { speed_rad_s: 2 } }),
    candidate(5, 'rolling_resistance', 0.05, 'wrong_sign', { coefficient: parameter(-0.04, '1', 0.01) }),
    candidate(6, 'multi_pass', 0.02, 'not_excited', { gain: parameter(0.1, '1', 0.4) }, { p_value: 0.7, evidence: [] })],
  classes: [{ members: ['mesh_loss', 'slip_sinkage'], separate_by: 'three wheels that push while one drags' }],
  not_excited: [{ effect: 'multi_pass', why: 'the rover never reversed over its own track' }, { effect: 'winding_heating', why: 'the windings warm by 2 K in this log' }],
  unknown: { variable: 'wheel2.speed_rad_s', balance: 'wheel2.current_A', gain: 0.18, unit_x: 'rad/s', unit_y: 'A', expression: '0.021 * exp(-(w / 1.8)^2) * sign(w)',
    x: Array.from({ length: 13 }, (_, i) => i - 6), y: Array.from({ length: 13 }, (_, i) => 0.021 * Math.exp(-(((i - 6) / 1.8) ** 2)) * Math.sign(i - 6)),
    low: Array.from({ length: 13 }, (_, i) => 0.021 * Math.exp(-(((i - 6) / 1.8) ** 2)) * Math.sign(i - 6) - 0.004),
    high: Array.from({ length: 13 }, (_, i) => 0.021 * Math.exp(-(((i - 6) / 1.8) ** 2)) * Math.sign(i - 6) + 0.004) },
  accepted: [candidate(1, 'slip_sinkage', 0.66, 'named', { coefficient: parameter(0.15, '1', 0.02) })],
  ladder: [{ label: 'baseline', train: 3.05, heldout: 3.12, floor: 1.006 }, { label: '+ slip_sinkage', train: 1.01, heldout: 1.03, floor: 1.006 },
    { label: 'noise floor', train: 1.006, heldout: 1.006, floor: 1.006 }],
  next: { title: 'one wheel drags', separates: ['mesh_loss', 'slip_sinkage'], scenario_toml: 'title = "one wheel drags"\nduration_s = 40\n\n[ground]\nname = "sand"\n\n[[command]]\nt_s = 2\nmode = "duty"\nduty = [0.4, 0.4, 0.4, 0.0]\n' },
  lineage: [{ when: '2024-06-01', who: 'field team', from_log: 'first_drive.csv', change: 'baseline' }, { when: '2024-06-07', who: 'field team', from_log: 'sand_identification.csv', change: '+ slip_sinkage' }] };
diagnose.model = { ...compare.model, effects: [{ name: 'rolling_resistance', wheel: null, parameters: { coefficient: parameter(0.05, '1', 0.01) } }] };

const odd = { schema: 'traction.lab/1', title: '</script><b>"quoted" & odd</b>', score: { error: null, floor: 0, ratio: null },
  log: { file: '', duration_s: null }, model: {}, verdict: { kind: 'nothing', effects: [], text: '' },
  balances: [
    { name: 'empty', unit: 'A', sigma: null, t_s: [], measured: [], model: [], worst: [] },
    { name: 'one', unit: 'A', sigma: 1, t_s: [3], measured: [1], model: [1.5], rmse: 0.5 },
    { name: 'constant', unit: 'm', sigma: 0.1, t_s: [0, 1, 2], measured: [1, 1, 1], model: [1, 1, 1], rmse: 0, acf: { lag_s: [0], value: [null], band: null } },
    { name: 'nulls', unit: 'V', sigma: 1, t_s: [0, 1, 2, 3], measured: [null, 1, null, 2], model: [null, null, 1, 2] },
    { name: 'huge', unit: 'V', sigma: 1e-300, t_s: [0, 1, 2], measured: [1e300, -1e300, 1e-300], model: [0, 0, 0], rmse: 1e300 }],
  regimes: [{ title: 'nothing', x_label: '', x_edges: [], y_labels: [], value: [] }], candidates: [{ effect: 'bare' }], classes: [{ members: [] }],
  unknown: { variable: 'v', x: [], y: [] }, ladder: [{ label: 'only', train: null, heldout: null, floor: null }], next: {}, messages: [] };

const large = { ...compare, title: 'Large log', log: { file: 'long.csv', duration_s: 1000 },
  balances: names.map(([name, title, unit, sigma, missing], i) => balance(name, title, unit, sigma, 20000, i % 3 === 0 ? missing : 0, 1000)) };
large.balances[0].measured[7777] = 9.5; // one row stands out: a picture without it lies

// 30 rows are missing from 40 to 55 s, one row stands alone at 80 s, the log goes on after the last row
const cut = balance('wheel0.current_A', 'Motor current, wheel 0', 'A', 0.02, 240, 0.3);
const stays = cut.t_s.map((s) => s < 40 || (s >= 55 && s < 70) || s === 80 || (s >= 90 && s < 110));
for (const key of ['t_s', 'measured', 'model']) cut[key] = cut[key].filter((_, i) => stays[i]);
cut.after = cut.model.map((m) => +(m * 1.02).toPrecision(6));
cut.nrmse_after = 1.1;
cut.gaps = [{ t0_s: 40, t1_s: 55, rows: 30 }, { t0_s: 70, t1_s: 80, rows: 20 }, { t0_s: 80.5, t1_s: 90, rows: 19 }, { t0_s: 110, t1_s: 120, rows: 20 }];
const gaps = { ...compare, title: 'A log with gaps', balances: [cut] };

const runs = { ...compare, verb: 'fit', title: 'Two runs, one machine', balances: [cut],
  validation: [{ log: 'sand.csv', stated: 7.5, fitted: 26.5, result: 26.4, left_out: true }, { log: 'gravel.csv', stated: 26.6, fitted: 25.3, result: 25.3, left_out: true }],
  between_runs: [{ parameter: 'soil.shear_slip', unit: '1', value: [0.292, 0.0918], half_width: [0.0705, 0.0076], times: 5.5, differs: true },
    { parameter: 'motor.resistance_ohm', unit: 'ohm', value: [3.1, 3.2], half_width: [0.1, 0.1], times: 1.4, differs: false }] };
const demo = { ...diagnose, title: 'demo', demo: { seed: 1, hidden: { name: 'slip_sinkage' }, hidden_text: 'slip_sinkage: coefficient = 0.15', named: ['slip_sinkage'], right: true, judgement: 'the lab was right' } };
const method = { schema: 'traction.figures/1', title: 'A verdict on a method', figures: [{ id: 'table-3', title: 'Table III', paper: '5.1 N', paper_here: '4.13 N', ours: '5.07 N', verdict: 'not reproduced', svg: '@SVG@' },
  { id: 'fig-10', title: 'Fig. 10', paper: 'mean right', paper_here: '0.18 m/s', ours: '0.175 m/s', verdict: 'reproduced', svg: '@SVG@' }] };
const compared = { schema: 'traction.compared/1', title: '3 results side by side', results: [{ ...compare, name: 'baseline' }, { ...diagnose, name: 'diagnosed' }, { ...gaps, name: 'other' }] };
const figures = { schema: 'traction.figures/1', title: 'The experiments of the paper, made again', intro: 'Every figure of the paper from firmware and simulator.\n\nBounds stand beside each.',
  figures: [{ id: 'fig-3', title: 'Fig. 3: drawbar pull against slip', paper: 'fit passes through ±5 N of noise', ours: 'rms 4.9 N', verdict: 'agrees', svg: '@SVG@', notes: 'Sand, dead weight 60 N.' },
    { id: 'fig-8', title: 'Fig. 8: radar spectrum at 0.18 m/s', paper: 'peak near 11 Hz', ours: '11.2 Hz', verdict: 'differs', svg: 'not a drawing', notes: '' }],
  tables: [{ title: 'Table III', columns: ['ground', 'Fm paper [N]', 'Fm ours [N]'], rows: [['sand', 5.1, 5.08], ['gravel', 6.8, 6.91], ['concrete', null, 5.6]], notes: 'Mean over 20 seeds.' }] };

const check = { schema: 'traction.check/1', log: 'sand_identification.csv', map: '', model: 'rover_sand.toml', passed: false,
  findings: [{ id: 'wrong_unit', severity: 'error', signal: 'wheel2.speed_rad_s', text: 'is 57.3 times what the encoder says: degrees, not radians', mend: 'scale = 0.01745 in the map', value: 57.3, t0_s: 0, t1_s: 120 },
    { id: 'gap', severity: 'warning', signal: 'camera.x_m', text: '3 gaps longer than 0.5 s', mend: '', value: 3, t0_s: 12.1, t1_s: 12.9 }],
  rates: [{ signal: 'wheel2.speed_rad_s', samples: 12000, median_s: 0.01, jitter: 0.002, missing: 0, largest_gap_s: 0.01 }],
  excitation: { duration_s: 120, speed_max_m_s: 0.41, constant_input: false, wheels: [{ wheel: 0, slip_low: -0.2, slip_high: 0.4 }, { wheel: 1, slip_low: null, slip_high: 0.4 }] } };

const [out, catalogue] = process.argv.slice(2); // catalogue: what `traction effects --json` wrote
const every_effect = { ...diagnose, title: 'Every effect', accepted: [], candidates: JSON.parse(readFileSync(catalogue, 'utf8')).effects.map((e, i) => ({ ...candidate(i + 1, e.name, 0, 'no_help', {}), title: e.title })) };
mkdirSync(out, { recursive: true });
for (const [name, result] of Object.entries({ every_effect, check, compare, diagnose, odd, large, figures, gaps, runs, demo, compared, method, empty: { schema: 'traction.lab/1' } }))
  writeFileSync(`${out}/${name}.json`, JSON.stringify(result));
