// timeplots.js - measured against model, before and after, and the residual of a balance over time; zoom and cursor are shared by all
// plots that are shown. Every row stands in the page; what a zoom draws is chosen by levels.js. Lines end at gaps, which are shaded.
import uPlot from 'uplot';
import { h } from './dom.js';
import { alone, breaksOf, drawn, thin } from './levels.js';
import { isNumber, list, num, seconds, unitText } from './words.js';

const SIGMAS = 2.58; // a normal residual stays inside this many sigma 99 % of the time
let plots = []; // { plot, refill }: those on the page now
let whole = [0, 1];
let told = () => {}; // called with the shown range

export const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

export function zoom(from, to) {
  const span = whole[1] - whole[0];
  if (!(to - from > span * 1e-6)) [from, to] = whole;
  const min = Math.max(whole[0], from), max = Math.min(whole[1], to);
  for (const { plot, refill } of plots)
    if (plot.shown_ !== `${min} ${max}` || plot.scales.x.min !== min || plot.scales.x.max !== max) {
      plot.shown_ = `${min} ${max}`;
      plot.batch(() => {
        plot.setData(refill(min, max), false);
        plot.setScale('x', { min, max });
      });
    }
  told(min, max, min === whole[0] && max === whole[1]);
}
export const zoomOut = () => zoom(...whole);
export const onZoom = (callback) => { told = callback; };

// One cursor with what else shows a time (replay/section.js): `pointed` hears where a pointer stands on a plot; cursorTo puts it there.
let pointed = () => {}, placing = false, cursorAt = null;
export const onPoint = (callback) => { pointed = callback; };
export function cursorTo(t) {
  cursorAt = t;
  placing = true;
  for (const { plot } of plots) {
    const { min, max } = plot.scales.x, left = t >= min && t <= max ? plot.valToPos(t, 'x') : -10;
    plot.setCursor({ left, top: left < 0 ? -10 : plot.over.clientHeight / 2 });
    plot.root.dataset.cursor = t.toFixed(4);
  }
  placing = false;
}

function shown() {
  const x = plots[0]?.plot.scales.x;
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

export const axis = (label, size, space) => ({
  label, size, space, labelSize: 22, font: '12px sans-serif', labelFont: '12px sans-serif',
  stroke: () => css('--ink'), grid: { stroke: () => css('--grid'), width: 1 }, ticks: { stroke: () => css('--grid'), width: 1 },
});

const value = (_, v) => (v == null ? '–' : num(v, 4));
const lonely = { show: true, size: 4, filter: (u, s) => alone(u.data[s]) };
const line = (label, stroke, more = {}) => ({ label, stroke: () => css(stroke), width: 1, value, points: lonely, ...more });

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
        u.root.dataset.rows = u.data[0].length; // what stands in the picture, for the tests
        u.root.dataset.most = u.data[1].reduce((most, v) => (v == null ? most : Math.max(most, v)), -Infinity);
        u.root.dataset.range = `${u.scales.x.min} ${u.scales.x.max}`;
        if (u.ready_) queueMicrotask(() => zoom(u.scales.x.min, u.scales.x.max));
      }],
      setCursor: [(u) => {
        if (placing || !u.ready_ || !(u.cursor.left >= 0)) return;
        const t = u.posToVal(u.cursor.left, 'x');
        if (t !== cursorAt) pointed(cursorAt = t);
      }],
      drawAxes: [...(extra.under ?? [])],
      draw: [...(extra.over ?? [])],
    },
  };
}

function paint(u, work) {
  u.ctx.save();
  u.ctx.beginPath();
  u.ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
  u.ctx.clip();
  work(u.ctx, u.bbox);
  u.ctx.restore();
}

// Stretches without rows: shaded and hatched, so that no one takes them for zero.
const shadeGaps = (gaps) => (u) => paint(u, (ctx, box) => {
  for (const g of gaps) {
    const left = u.valToPos(g.t0_s, 'x', true), width = Math.max(1, u.valToPos(g.t1_s, 'x', true) - left);
    if (left > box.left + box.width || left + width < box.left) continue;
    ctx.fillStyle = css('--gap');
    ctx.fillRect(left, box.top, width, box.height);
    ctx.strokeStyle = css('--rule');
    ctx.beginPath();
    const from = Math.max(left, box.left), to = Math.min(left + width, box.left + box.width);
    ctx.save();
    ctx.rect(from, box.top, to - from, box.height);
    ctx.clip();
    ctx.beginPath();
    for (let x = from - box.height; x < to; x += 9 * devicePixelRatio) {
      ctx.moveTo(x, box.top + box.height);
      ctx.lineTo(x + box.height, box.top);
    }
    ctx.stroke();
    ctx.restore();
  }
});

// The area between a residual and zero.
const shadeResidual = (column, colour) => (u) => paint(u, (ctx) => {
  const [ts] = u.data, rs = u.data[column];
  const zero = u.valToPos(0, 'y', true);
  ctx.fillStyle = css(colour);
  for (let i = 0; i < ts.length;) {
    while (i < ts.length && rs[i] == null) ++i;
    const begin = i;
    while (i < ts.length && rs[i] != null) ++i;
    if (i - begin < 2) continue;
    ctx.beginPath();
    ctx.moveTo(u.valToPos(ts[begin], 'x', true), zero);
    for (let k = begin; k < i; ++k) ctx.lineTo(u.valToPos(ts[k], 'x', true), u.valToPos(rs[k], 'y', true));
    ctx.lineTo(u.valToPos(ts[i - 1], 'x', true), zero);
    ctx.fill();
  }
});

const noiseBand = (limit) => (u) => paint(u, (ctx, box) => {
  if (!Number.isFinite(limit)) return;
  const top = Math.max(box.top, u.valToPos(limit, 'y', true)), low = Math.min(box.top + box.height, u.valToPos(-limit, 'y', true));
  ctx.fillStyle = css('--band');
  if (low > top) ctx.fillRect(box.left, top, box.width, low - top);
});

// the residual's axis always holds the noise band, so that plots can be compared by eye
function roomFor(limit) {
  return (_, low, high) => {
    const least = Number.isFinite(limit) ? 1.3 * limit : 0;
    const from = Math.min(low ?? 0, -least), to = Math.max(high ?? 0, least);
    return from < to ? uPlot.rangeNum(from, to, 0.05, true) : [from - 1, to + 1];
  };
}

// Times and columns of a balance, rows without a time left out; numbers that are none become gaps.
function columnsOf(balance) {
  const t = list(balance.t_s), keep = t.map((x, i) => (isNumber(x) ? i : -1)).filter((i) => i >= 0);
  const take = (values) => keep.map((i) => (isNumber(list(values)[i]) ? values[i] : null));
  const measured = take(balance.measured), before = take(balance.model), after = list(balance.after).length ? take(balance.after) : null;
  const minus = (model) => model && measured.map((m, i) => (m == null || model[i] == null ? null : m - model[i]));
  return { t: keep.map((i) => t[i]), measured, before, after, residual: minus(before), residualAfter: minus(after) };
}

export function outsideShare(balance) {
  const { residual, residualAfter } = columnsOf(balance);
  const r = (residualAfter ?? residual).filter((x) => x != null);
  return r.length && isNumber(balance.sigma) ? r.filter((x) => Math.abs(x) > SIGMAS * balance.sigma).length / r.length : null;
}

export const rowsLeftOut = (balance) => list(balance.gaps).reduce((sum, g) => sum + (g.rows ?? 0), 0);

export function gapWords(balance) {
  const n = rowsLeftOut(balance), gaps = list(balance.gaps).length;
  return n ? `Shaded: ${n} rows left out, in ${gaps} ${gaps === 1 ? 'stretch' : 'stretches'}. There the balance says nothing (wheel at rest, or no sample).` : '';
}

// The two plots of one balance: { title, unit, sigma, t_s, measured, model, after?, gaps? }. draw(): once it stands in the page.
export function balancePlots(balance) {
  const c = columnsOf(balance);
  const gaps = list(balance.gaps).filter((g) => isNumber(g.t0_s) && isNumber(g.t1_s)), breaks = breaksOf(c.t, gaps);
  const limit = isNumber(balance.sigma) ? SIGMAS * balance.sigma : Infinity;
  const unit = unitText(balance.unit || '1');
  const share = outsideShare(balance);
  const description = `${balance.title || balance.name}: measured and model over time, and the residual, ${share == null ? '' : `of which ${num(100 * share, 2)} percent `
    + 'lies outside the noise band. '}${gapWords(balance)} Keys: plus and minus zoom, arrows pan, Home shows all.`;
  const host = h('div', { class: 'plots', tabindex: 0, role: 'group', 'aria-label': description, onkeydown: keys });
  const draw = () => {
    if (c.t.length < 1) {
      host.append(h('p', { class: 'quiet' }, 'No samples.'));
      return;
    }
    const refill = (columns) => (from, to) =>
      drawn(c.t, columns, thin(c.t, columns, from, to, Math.max(300, Math.round(host.clientWidth * devicePixelRatio))), breaks);
    const above = [c.measured, c.before, ...(c.after ? [c.after] : [])], below = [c.residual, ...(c.after ? [c.residualAfter] : [])];
    const upperFill = refill(above), lowerFill = refill(below);
    const upper = new uPlot(options(host, 230, unit, [
      line('measured', '--ink'), line(c.after ? 'model before' : 'model', '--model', { dash: [8, 4], width: 1.5 }),
      ...(c.after ? [line('model after', '--good', { width: 2 })] : []),
    ], { under: [shadeGaps(gaps)] }), upperFill(...whole), host);
    const lower = new uPlot(options(host, 180, `residual [${unit}]`, [
      line(c.after ? 'residual before' : 'residual', '--model', c.after ? { dash: [8, 4] } : {}),
      ...(c.after ? [line('residual after', '--good')] : []),
    ], { last: true, scales: { y: { range: roomFor(limit) } },
      under: [shadeGaps(gaps), noiseBand(limit), shadeResidual(1, '--before'), ...(c.after ? [shadeResidual(2, '--after')] : [])] }), lowerFill(...whole), host);
    plots.push({ plot: upper, refill: upperFill }, { plot: lower, refill: lowerFill });
    upper.ready_ = lower.ready_ = true;
    zoom(...shown());
  };
  const remove = () => {
    plots = plots.filter(({ plot }) => !host.contains(plot.root) || (plot.destroy(), false));
    host.replaceChildren();
  };
  return { host, draw, remove, band: Number.isFinite(limit) ? `Band: ±${SIGMAS} σ of the noise = ±${num(limit)} ${unit}; noise alone leaves it in 1 of 100 rows.` : '' };
}

// The rows that stand in the shown stretch, as text with the unit in each column's name.
export function shownCsv(balance) {
  const c = columnsOf(balance), [from, to] = shown(), name = (what) => `${what}_${String(balance.unit || '1').replaceAll(/[^A-Za-z0-9]+/g, '_')}`;
  const columns = [['measured', c.measured], [c.after ? 'model_before' : 'model', c.before], ...(c.after ? [['model_after', c.after]] : [])];
  const rows = c.t.map((t, i) => (t >= from && t <= to ? [t, ...columns.map(([, v]) => v[i] ?? '')].join(',') : null)).filter((row) => row != null);
  return [['t_s', ...columns.map(([what]) => name(what))].join(','), ...rows].join('\n') + '\n';
}

const strokes = ['--ink', '--model', '--good', '--residual', '--p3', '--p5', '--p6', '--p7'], dashes = [[], [8, 4], [], [2, 3], [10, 3, 2, 3], [4, 2], [], [6, 6]];

// Residuals of one signal by several results over one another: [{ label, balance }], unit; `fromStart`: each log's own start is time zero.
export function overlay(all, unit, fromStart) {
  const host = h('div', { class: 'plots', tabindex: 0, role: 'group', onkeydown: keys,
    'aria-label': `residual over time of ${all.map((a) => a.label).join(', ')}. Keys: plus and minus zoom, arrows pan, Home shows all.` });
  const tables = all.map(({ label, balance }) => {
    const c = columnsOf(balance), start = fromStart ? c.t[0] ?? 0 : 0;
    const gaps = list(balance.gaps).map((g) => ({ t0_s: g.t0_s - start, t1_s: g.t1_s - start }));
    const t = c.t.map((x) => x - start);
    return { label, t, residual: c.residualAfter ?? c.residual, breaks: breaksOf(t, gaps) }; // of the model that a result ends with
  });
  const draw = () => {
    settleOn(tables.map((x) => x.t));
    const refill = (from, to) => uPlot.join(tables.map((x) => drawn(x.t, [x.residual], thin(x.t, [x.residual], from, to, Math.max(300, Math.round(host.clientWidth * devicePixelRatio))), x.breaks)));
    const plot = new uPlot(options(host, 260, `residual [${unitText(unit || '1')}]`,
      tables.map((x, i) => line(x.label, strokes[i % 8], { dash: dashes[i % 8], points: { show: false } })), { last: true }), refill(...whole), host);
    plots.push({ plot, refill });
    plot.ready_ = true;
    zoom(...whole);
  };
  return { host, draw, remove: () => { plots = plots.filter(({ plot }) => !host.contains(plot.root) || (plot.destroy(), false)); } };
}

// Signals of one unit over one clock: [{ label, values }]; NaN is nothing. `last`: with the axis of time.
export function linesPlot(name, unit, t, all, last) {
  const host = h('div', { class: 'plots', tabindex: 0, role: 'group', onkeydown: keys,
    'aria-label': `${name} over time: ${all.map((a) => a.label).join(', ')}. Keys: plus and minus zoom, arrows pan, Home shows all.` });
  const columns = all.map(({ values }) => Array.from(values, (v) => (Number.isNaN(v) ? null : v)));
  const draw = () => {
    const refill = (from, to) => drawn(t, columns, thin(t, columns, from, to, Math.max(300, Math.round(host.clientWidth * devicePixelRatio))), []);
    const plot = new uPlot(options(host, last ? 190 : 165, `${name} [${unitText(unit || '1')}]`,
      all.map((a, i) => line(a.label, strokes[i % 8], { dash: dashes[i % 8], points: { show: false } })), { last }), refill(...whole), host);
    plots.push({ plot, refill });
    plot.ready_ = true;
  };
  return { host, draw };
}

export function settleTimes(t) {
  settleOn([t]);
  resizing();
}

function settleOn(times) {
  const low = Math.min(...times.map((t) => t[0] ?? Infinity)), high = Math.max(...times.map((t) => t.at(-1) ?? -Infinity));
  whole = low < high ? [low, high] : [0, 1];
}

// One time range for all.
export function settle(balances) {
  let low = Infinity, high = -Infinity;
  for (const b of balances) {
    for (const t of list(b.t_s)) if (isNumber(t)) { low = Math.min(low, t); high = Math.max(high, t); }
    for (const g of list(b.gaps)) if (isNumber(g.t0_s) && isNumber(g.t1_s)) { low = Math.min(low, g.t0_s); high = Math.max(high, g.t1_s); }
  }
  whole = low < high ? [low, high] : isNumber(low) ? [low - 0.5, low + 0.5] : [0, 1];
  resizing();
  return seconds(...whole);
}

// Another result comes in its place (`traction serve`).
export function forget() {
  plots.forEach(({ plot }) => plot.destroy());
  plots = [];
  told = () => {};
}

let watching = false;

// Redrawn at other widths, in other colours, and for print.
export function resizing() {
  if (watching) return;
  watching = true;
  const fit = (width) => {
    plots.forEach(({ plot }) => plot.setSize({ width: Math.max(260, width ?? plot.root.parentElement.clientWidth), height: plot.height }));
    plots.forEach(({ plot }) => { plot.shown_ = ''; });
    zoom(...shown());
  };
  let last = 0;
  new ResizeObserver(([entry]) => {
    if (Math.abs(entry.contentRect.width - last) < 2) return;
    last = entry.contentRect.width;
    fit();
  }).observe(document.getElementById('page'));
  const print = matchMedia('print');
  print.addEventListener('change', () => fit(print.matches ? 660 : undefined)); // 660 px: A4 less margins at 96 dpi
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => plots.forEach(({ plot }) => plot.redraw(false)));
}
