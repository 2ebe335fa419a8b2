// charts.js - small still charts in SVG: correlations with their band, a shape with its band, evidence along the log.
import { s } from './dom.js';
import { isNumber, list, num, unitText } from './words.js';

function extent(values, withZero) {
  const finite = values.filter(isNumber);
  if (withZero) finite.push(0);
  let low = finite.reduce((a, b) => Math.min(a, b), Infinity), high = finite.reduce((a, b) => Math.max(a, b), -Infinity);
  if (!(low <= high)) [low, high] = [0, 1];
  if (high - low <= Math.abs(high) * 1e-12) [low, high] = [low - (Math.abs(low) || 1) * 0.1, high + (Math.abs(high) || 1) * 0.1];
  return [low, high];
}

function ticks(low, high, wanted) {
  const rough = (high - low) / wanted, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((k) => k >= rough) ?? 10 * power;
  const out = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + step * 1e-9 && out.length < 20; ++k) out.push(k * step);
  return out;
}

function frame(width, height, xs, ys, xLabel, yLabel, description) {
  const left = 58, right = 10, top = 8, bottom = 38;
  const px = (x) => left + ((x - xs[0]) / (xs[1] - xs[0])) * (width - left - right);
  const py = (y) => height - bottom - ((y - ys[0]) / (ys[1] - ys[0])) * (height - top - bottom);
  const root = s('svg', { class: 'chart', viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': description });
  for (const y of ticks(...ys, 6))
    root.append(s('line', { class: 'grid', x1: left, x2: width - right, y1: py(y), y2: py(y) }),
      s('text', { x: left - 5, y: py(y) + 4, 'text-anchor': 'end' }, num(y, 2)));
  for (const x of ticks(...xs, 5))
    root.append(s('line', { class: 'grid', x1: px(x), x2: px(x), y1: top, y2: height - bottom }),
      s('text', { x: px(x), y: height - bottom + 14, 'text-anchor': 'middle' }, num(x, 2)));
  root.append(s('text', { x: (left + width - right) / 2, y: height - 6, 'text-anchor': 'middle' }, xLabel));
  root.append(s('text', { x: 12, y: (top + height - bottom) / 2, 'text-anchor': 'middle',
    transform: `rotate(-90 12 ${(top + height - bottom) / 2})` }, yLabel));
  return { root, px, py };
}

// stems inside the shaded band are what chance gives; those outside carry a dot
export function correlation(c, description) {
  const lags = list(c.lag_s), values = list(c.value), band = isNumber(c.band) ? c.band : 0;
  const { root, px, py } = frame(360, 180, extent(lags), extent([...values, band, -band], true), 'lag [s]', 'correlation', description);
  const [x0, x1] = extent(lags);
  if (band > 0) root.append(s('rect', { class: 'band', x: px(x0), width: px(x1) - px(x0), y: py(band), height: py(-band) - py(band) }));
  let stems = '';
  lags.forEach((lag, i) => {
    if (!isNumber(values[i])) return;
    stems += `M${px(lag).toFixed(1)},${py(0).toFixed(1)}V${py(values[i]).toFixed(1)}`;
    if (Math.abs(values[i]) > band && values[i] < 1 && lags.length <= 200) root.append(s('circle', { class: 'out', cx: px(lag), cy: py(values[i]), r: 2.6 }));
  });
  root.append(s('path', { class: 'stems', d: stems || 'M0,0' }));
  root.append(s('line', { class: 'zero', x1: px(x0), x2: px(x1), y1: py(0), y2: py(0) }));
  return root;
}

// y(x) with the band low..high
export function shape(u) {
  const xs = list(u.x), ys = list(u.y), low = list(u.low), high = list(u.high);
  const { root, px, py } = frame(620, 260, extent(xs), extent([...ys, ...low, ...high], true), `${u.variable} [${unitText(u.unit_x || '1')}]`,
    `${u.balance ?? 'residual'} [${unitText(u.unit_y || '1')}]`, `shape of the unexplained part over ${u.variable}`);
  const at = (values) => xs.map((x, i) => (isNumber(values[i]) ? `${px(x).toFixed(1)},${py(values[i]).toFixed(1)}` : null)).filter(Boolean);
  if (low.length && high.length) root.append(s('path', { class: 'band', d: `M${[...at(low), ...at(high).reverse()].join(' ')}z` }));
  root.append(s('line', { class: 'zero', x1: px(extent(xs)[0]), x2: px(extent(xs)[1]), y1: py(0), y2: py(0) }));
  const points = at(ys);
  if (points.length) root.append(s('path', { class: 'curve', d: `M${points.join(' ')}` }));
  for (const point of points) root.append(s('circle', { class: 'out', cx: point.split(',')[0], cy: point.split(',')[1], r: 3 }));
  return root;
}

// where along the log the evidence for a candidate lies: darker and higher is more
export function evidenceStrip(windows, duration, describe, choose) {
  const width = 300, height = 30, most = Math.max(1e-300, ...windows.map((w) => w.share ?? 0));
  const root = s('svg', { class: 'chart strip', viewBox: `0 0 ${width} ${height}`, preserveAspectRatio: 'none', role: 'img', 'aria-label': describe });
  root.append(s('line', { class: 'zero', x1: 0, x2: width, y1: height - 0.5, y2: height - 0.5 }));
  for (const w of windows) {
    const tall = Math.max(1, ((w.share ?? 0) / most) * (height - 2));
    root.append(s('rect', { class: 'evidence', x: (w.t0_s / duration) * width, width: Math.max(1, ((w.t1_s - w.t0_s) / duration) * width - 0.5),
      y: height - tall, height: tall, onclick: () => choose(w.t0_s, w.t1_s) },
    s('title', {}, `${num(w.t0_s)} to ${num(w.t1_s)} s: ${num(100 * (w.share ?? 0))} % of the evidence`)));
  }
  return root;
}
