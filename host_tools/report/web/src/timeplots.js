// timeplots.js - measured against model and the residual of every balance over time; zoom and cursor are shared by all plots.
import uPlot from 'uplot';
import { h } from './dom.js';
import { isNumber, list, num, seconds, unitText } from './words.js';

const SIGMAS = 2.58; // a normal residual stays inside this many sigma 99 % of the time
const plots = [];
let whole = [0, 1];
let told = () => {}; // called with the shown range

const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

export function zoom(from, to) {
  const span = whole[1] - whole[0];
  if (!(to - from > span * 1e-6)) [from, to] = whole;
  const min = Math.max(whole[0], from), max = Math.min(whole[1], to);
  for (const plot of plots)
    if (plot.scales.x.min !== min || plot.scales.x.max !== max) plot.setScale('x', { min, max });
  told(min, max, min === whole[0] && max === whole[1]);
}
export const zoomOut = () => zoom(...whole);
export const onZoom = (callback) => { told = callback; };

function shown() {
  const x = plots[0]?.scales.x;
  return x && isNumber(x.min) ? [x.min, x.max] : whole;
}

// + and - zoom, arrows pan, Home or Escape shows the whole log
function keys(event) {
  const [a, b] = shown();
  const step = (b - a) / 4;
  const moves = {
    '+': [a + step, b - step], '=': [a + step, b - step], '-': [a - step * 2, b + step * 2],
    ArrowLeft: [Math.max(whole[0], a - step), Math.max(whole[0], a - step) + (b - a)],
    ArrowRight: [Math.min(whole[1], b + step) - (b - a), Math.min(whole[1], b + step)],
    Home: whole, Escape: whole,
  };
  if (!(event.key in moves) || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  zoom(...moves[event.key]);
}

const axis = (label, size, space) => ({
  label, size, space, labelSize: 22, font: '12px sans-serif', labelFont: '12px sans-serif',
  stroke: () => css('--ink'), grid: { stroke: () => css('--grid'), width: 1 }, ticks: { stroke: () => css('--grid'), width: 1 },
});

const value = (_, v) => (v == null ? '–' : num(v, 4));

function options(host, height, label, series, extra = {}) {
  return {
    width: Math.max(260, host.clientWidth), height, pxAlign: 0,
    scales: { x: { time: false }, ...extra.scales },
    cursor: { sync: { key: 'traction' }, drag: { x: true, y: false }, points: { size: 7 },
      bind: { dblclick: () => () => { zoomOut(); return null; } } },
    legend: { markers: { width: 2, dash: (u, i) => (u.series[i].dash ? 'dashed' : 'solid') } },
    axes: [axis(extra.last ? 'time [s]' : undefined, 26, 50), axis(label, 62, 26)],
    series: [{ label: 'time [s]', value }, ...series],
    hooks: {
      setScale: [(u, key) => {
        // a drag or a double click on one plot reaches all of them
        if (key !== 'x') return;
        u.root.dataset.range = `${u.scales.x.min} ${u.scales.x.max}`;
        if (u.ready_) queueMicrotask(() => zoom(u.scales.x.min, u.scales.x.max));
      }],
      ...extra.hooks,
    },
  };
}

// Fills what lies outside the band between its edge and the curve, and marks it along the lower edge as well.
function shadeOutside(limit) {
  return (u) => {
    const [ts, rs] = u.data;
    const { ctx, bbox } = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.fillStyle = css('--outside');
    const x = (i) => u.valToPos(ts[i], 'x', true), y = (v) => u.valToPos(v, 'y', true);
    const strip = bbox.top + bbox.height - 5 * devicePixelRatio;
    for (let i = 0; i < ts.length; ++i) {
      if (rs[i] == null || Math.abs(rs[i]) <= limit) continue;
      const edge = rs[i] > 0 ? limit : -limit;
      const left = i > 0 ? (x(i - 1) + x(i)) / 2 : x(i), right = i + 1 < ts.length ? (x(i) + x(i + 1)) / 2 : x(i);
      const width = Math.max(right - left, 1);
      ctx.fillRect(left, Math.min(y(rs[i]), y(edge)), width, Math.abs(y(rs[i]) - y(edge)));
      ctx.fillRect(left, strip, width, 5 * devicePixelRatio);
    }
    ctx.restore();
  };
}

function edges(limit) {
  return (u) => {
    const { ctx, bbox } = u;
    ctx.save();
    ctx.fillStyle = css('--band');
    const top = Math.max(bbox.top, u.valToPos(limit, 'y', true)), low = Math.min(bbox.top + bbox.height, u.valToPos(-limit, 'y', true));
    if (low > top) ctx.fillRect(bbox.left, top, bbox.width, low - top);
    ctx.restore();
  };
}

// the residual's axis always holds the noise band, so that plots can be compared by eye
function roomFor(limit) {
  return (_, low, high) => {
    const least = Number.isFinite(limit) ? 1.3 * limit : 0;
    const from = Math.min(low ?? 0, -least), to = Math.max(high ?? 0, least);
    return from < to ? uPlot.rangeNum(from, to, 0.05, true) : [from - 1, to + 1];
  };
}

// The two plots of one balance: { title, unit, sigma, t_s, measured, model }.
export function balancePlots(balance) {
  const clean = (values) => list(values).map((v) => (isNumber(v) ? v : null));
  const keep = list(balance.t_s).map((t, i) => (isNumber(t) ? i : -1)).filter((i) => i >= 0);
  const t = keep.map((i) => balance.t_s[i]), at = (values) => keep.map((i) => values[i] ?? null);
  const measured = at(clean(balance.measured)), model = at(clean(balance.model));
  const residual = t.map((_, i) => (measured[i] == null || model[i] == null ? null : measured[i] - model[i]));
  const limit = isNumber(balance.sigma) ? SIGMAS * balance.sigma : Infinity;
  const outside = residual.filter((r) => r != null && Math.abs(r) > limit).length;
  const unit = unitText(balance.unit || '1');
  const description = `${balance.title || balance.name}: measured and model over time, and the residual, which is outside the noise band in `
    + `${outside} of ${residual.length} samples. Keys: plus and minus zoom, arrows pan, Home shows all.`;
  const host = h('div', { class: 'plots', tabindex: 0, role: 'group', 'aria-label': description, onkeydown: keys });
  const draw = () => {
    if (t.length < 1) {
      host.append(h('p', { class: 'quiet' }, 'No samples.'));
      return;
    }
    const upper = new uPlot(options(host, 210, `${unit}`, [
      { label: 'measured', stroke: () => css('--ink'), width: 1, value, points: { show: t.length < 2 } },
      { label: 'model', stroke: () => css('--model'), width: 2, dash: [8, 4], value, points: { show: t.length < 2 } },
    ]), [t, measured, model], host);
    const lower = new uPlot(options(host, 165, `residual [${unit}]`, [
      { label: `residual (band: ±${SIGMAS} σ = ±${num(limit)} ${unit})`, stroke: () => css('--residual'), width: 1, value, points: { show: t.length < 2 } },
    ], { last: true, scales: { y: { range: roomFor(limit) } }, hooks: { drawAxes: [edges(limit)], draw: [shadeOutside(limit)] } }), [t, residual], host);
    for (const plot of [upper, lower]) {
      plots.push(plot);
      plot.ready_ = true;
    }
  };
  return { host, draw, outside: residual.length ? outside / residual.length : null };
}

// After every plot stands: one x range for all, redrawn at other widths, themes and for print.
export function settle(balances) {
  let low = Infinity, high = -Infinity;
  for (const b of balances)
    for (const t of list(b.t_s)) if (isNumber(t)) { low = Math.min(low, t); high = Math.max(high, t); }
  whole = low < high ? [low, high] : isNumber(low) ? [low - 0.5, low + 0.5] : [0, 1];
  zoomOut();
  const fit = (width) => plots.forEach((p) => p.setSize({ width: Math.max(260, width ?? p.root.parentElement.clientWidth), height: p.height }));
  let last = 0;
  new ResizeObserver(([entry]) => {
    if (Math.abs(entry.contentRect.width - last) < 2) return;
    last = entry.contentRect.width;
    fit();
  }).observe(document.getElementById('page'));
  const print = matchMedia('print');
  print.addEventListener('change', () => fit(print.matches ? 660 : undefined)); // 660 px: A4 less margins at 96 dpi
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => plots.forEach((p) => p.redraw(false)));
  return seconds(...whole);
}
