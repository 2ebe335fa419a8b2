// levels_test.mjs LEVELS.JS - what a zoom draws is true: no point that is not in the data, no extreme lost, no line over a gap. Seeded cases.
import assert from 'node:assert/strict';
import { pathToFileURL } from 'node:url';

const { alone, breaksOf, drawn, thin } = await import(pathToFileURL(process.argv[2]).href);
let state = 20261122n; // seed of splitmix64 (Steele, Lea and Flood 2014)
function uniform() {
  state = (state + 0x9e3779b97f4a7c15n) & 0xffffffffffffffffn;
  let z = state;
  z = ((z ^ (z >> 30n)) * 0xbf58476d1ce4e5b9n) & 0xffffffffffffffffn;
  z = ((z ^ (z >> 27n)) * 0x94d049bb133111ebn) & 0xffffffffffffffffn;
  return Number((z ^ (z >> 31n)) >> 11n) / 2 ** 53;
}
const whole = (low, high) => low + Math.floor(uniform() * (high - low));

function made() {
  const n = whole(1, 5000), t = [], gaps = [], a = [], b = [];
  let now = whole(-100, 100);
  for (let i = 0; i < n; ++i) {
    const step = uniform() < 0.01 ? 5 + uniform() : 0.01 + 0.1 * uniform();
    if (i > 0 && step > 1) gaps.push({ t0_s: now, t1_s: now + step });
    t.push(now += i > 0 ? step : 0);
    a.push(uniform() < 0.02 ? null : 100 * (uniform() - 0.5));
    b.push(uniform() < 0.003 ? 1e6 * uniform() : uniform());
  }
  const from = t[0] + uniform() * (t[n - 1] - t[0]) * 0.7, to = uniform() < 0.3 ? t[n - 1] : from + uniform() * (t[n - 1] - from);
  return uniform() < 0.3 ? { t, a, b, gaps, from: t[0], to: t[n - 1] } : { t, a, b, gaps, from, to };
}

// the first place in rising times that is not before x
function first(times, x) {
  let low = 0, high = times.length;
  while (low < high) { const middle = (low + high) >> 1; if (times[middle] < x) low = middle + 1; else high = middle; }
  return low;
}
// [lowest, highest] of what is there from one place to before another; null where nothing is
function extremes(begin, end, value) {
  let found = null;
  for (let i = begin; i < end; ++i) { const v = value(i); if (v != null) found = found ? [Math.min(found[0], v), Math.max(found[1], v)] : [v, v]; }
  return found;
}

let held = 0;
for (let run = 0; run < 400; ++run) {
  const { t, a, b, gaps, from, to } = made(), bins = whole(10, 1200), breaks = breaksOf(t, gaps);
  const kept = thin(t, [a, b], from, to, bins);
  assert.ok(kept.every((i, k) => Number.isInteger(i) && i >= 0 && i < t.length && (k === 0 || i > kept[k - 1])), `run ${run}: rising rows of the data`);
  assert.ok(kept.length <= 2 * bins + 2 || kept.length <= 6 * bins + 2, `run ${run}: ${kept.length} points for ${bins} bins`);
  const shown = kept.map((i) => t[i]); // times rise, so the rows of a bin stand together
  // of two bins: then the neighbour may hold the extreme
  const onEdge = (x) => { const k = first(t, x); return [k - 1, k, k + 1].some((i) => Math.abs(t[i] - x) < 1e-9 * Math.abs(t[i]) + 1e-12); };
  for (let bin = 0; bin < bins; ++bin) {
    const low = from + ((to - from) * bin) / bins, high = from + ((to - from) * (bin + 1)) / bins;
    if (onEdge(low) || onEdge(high)) continue;
    for (const column of [a, b]) {
      const all = extremes(first(t, low), first(t, high), (i) => column[i]);
      if (!all) continue;
      const of = extremes(first(shown, low), first(shown, high), (k) => column[kept[k]]);
      assert.equal(of?.[1], all[1], `run ${run}: the highest of a bin`);
      assert.equal(of?.[0], all[0], `run ${run}: the lowest of a bin`);
      held += 1;
    }
  }
  const [x, ya, yb] = drawn(t, [a, b], kept, breaks);
  const row = new Map(t.map((time, i) => [time, i]));
  x.forEach((time, k) => {
    const i = row.get(time);
    if (i === undefined) return assert.ok(ya[k] === null && yb[k] === null, `run ${run}: a drawn point that is not in the data`);
    assert.ok(ya[k] === a[i] && yb[k] === b[i], `run ${run}: a drawn value that is not in the data`);
    if (k > 0 && row.has(x[k - 1])) // two points that a line joins: no gap between them
      assert.ok(!gaps.some((g) => g.t0_s >= x[k - 1] && g.t1_s <= time), `run ${run}: a line over a gap`);
  });
}
assert.deepEqual(alone([1, null, 2, null, 3, 4]), [0, 2]);
console.log('400 runs: no point that is not in the data, no extreme lost, no line over a gap');
