// models.js - several results beside one another: errors, ladders, residuals over one another, parameters with their intervals, every
// signal of every result as a small picture.
import { h, table } from './dom.js';
import { spark } from './signals.js';
import { section } from './story.js';
import { onZoom, overlay, resizing, zoomOut } from './timeplots.js';
import { effectName, even, isNumber, list, seconds, sized } from './words.js';

// The error that a result ends with: on what was not fitted where it has a ladder, else retuned within the tolerances.
function final(r) {
  const last = list(r.ladder).filter((s) => isNumber(s.heldout) && s.label !== 'noise floor').at(-1);
  return last ? last.heldout : r.score?.adjusted;
}

// Two results are of one log where they hold the same measurements, whatever the files are called.
const measurements = (r) => JSON.stringify(list(r.balances).slice(0, 1).map((b) => [b.name, list(b.measured).slice(0, 50)]));

const effects = (r) => [...list(r.model?.effects), ...list(r.accepted)].map(effectName).join(', ') || 'none';

function errors(all) {
  const least = Math.min(...all.map(final).filter(isNumber));
  return section('verdict', 'Errors', 'Errors side by side',
    h('p', { class: 'verdict' }, isNumber(least) ? `The least error is ${even(least, 2)} times the sensor noise: ${all.filter((r) => final(r) === least).map((r) => r.name).join(', ')}.` : 'No result holds an error.'),
    new Set(all.map(measurements)).size > 1 ? h('p', {}, 'The results are of different logs: an error on one is no measure for another.') : null,
    table('Error as a multiple of the sensor noise', [{ head: 'result' }, { head: 'log' }, { head: 'model' }, { head: 'effects' }, { head: 'as given', number: true }, { head: 'retuned', number: true }, { head: 'held out, at the end', number: true }],
      all.map((r) => [r.name, r.log?.file ?? '–', r.model?.name || r.model?.file || '–', effects(r), even(r.score?.error, 2), even(r.score?.adjusted, 2), list(r.ladder).length ? even(final(r), 2) : '–'])));
}

function ladder(all) {
  const rows = all.flatMap((r) => (list(r.ladder).length ? list(r.ladder).filter((s) => s.label !== 'noise floor').map((s) => [r.name, s.label, s.heldout]) : [[r.name, 'retuned within its tolerances', r.score?.adjusted]])).filter(([, , x]) => isNumber(x));
  if (!rows.length) return null;
  const most = Math.max(...rows.map(([, , x]) => x));
  return section('ladder', 'Ladders', 'The ladders of all', h('div', { class: 'scroll' }, h('table', { class: 'ladder' }, h('caption', {}, 'Error as a multiple of the sensor noise'),
    h('thead', {}, h('tr', {}, ['result', 'model', 'error', 'as a bar'].map((x) => h('th', { scope: 'col' }, x)))),
    h('tbody', {}, rows.map(([name, label, x]) => h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, label), h('td', { class: 'number' }, even(x, 2)),
      h('td', { class: 'wide', 'aria-hidden': 'true' }, h('div', { class: 'bar', style: `width:${((100 * x) / most).toFixed(2)}%` }))))))));
}

const named = (r, name) => list(r.balances).find((b) => b.name === name);

function residuals(all, names) {
  if (!names.length) return [null];
  const first = (name) => all.map((r) => named(r, name)).find(Boolean);
  const shown = h('output', { 'aria-live': 'polite' }), place = h('div', {});
  const reset = h('button', { type: 'button', onclick: zoomOut, disabled: true }, 'All');
  const choice = h('select', { id: 'signal', onchange: () => show() }, names.map((n) => h('option', { value: n }, first(n).title || n)));
  const origin = h('select', { id: 'origin', onchange: () => show() }, h('option', { value: 'log' }, 'as logged'), h('option', { value: 'start' }, "each log's own start"));
  let now;
  function show() {
    now?.remove();
    const some = all.filter((r) => named(r, choice.value));
    now = overlay(some.map((r) => ({ label: r.name, balance: named(r, choice.value) })), first(choice.value).unit, origin.value === 'start');
    place.replaceChildren(now.host);
    now.draw();
  }
  onZoom((a, b, isWhole) => { shown.textContent = seconds(a, b); reset.disabled = isWhole; });
  return [section('balances', 'Residuals', 'Residuals over one another', h('div', { class: 'toolbar' }, h('label', { for: 'signal' }, 'Signal '), choice, ' ', h('label', { for: 'origin' }, 'Time zero '), origin, ' Shown: ', shown, ' ', reset), place),
    () => { show(); resizing(); }];
}

function small(all, names) {
  if (!names.length) return null;
  const most = Math.max(1e-300, ...all.flatMap((r) => list(r.balances).flatMap((b) => list(b.strip).filter(isNumber))));
  return section('runs', 'Signals', 'Every signal of every result', table('Error over its noise, over the log', [{ head: 'signal' }, ...all.map((r) => ({ head: r.name }))],
    names.map((n) => [n, ...all.map((r) => { const b = named(r, n); return b ? [`${even(b.nrmse, 1)} `, spark(b.strip, most)] : '–'; })])));
}

// What a model's fit or diagnosis says of each number: "fitted", the model's own effects, what was accepted.
function numbers(r) {
  const out = Object.fromEntries(Object.entries(r.fitted ?? {}));
  for (const e of list(r.model?.effects)) for (const [k, p] of Object.entries(e.parameters ?? {})) out[`${effectName(e)}: ${k}`] = p;
  for (const c of list(r.accepted)) for (const [k, p] of Object.entries(c.parameters ?? {})) out[`${effectName(c)}: ${k}`] = p;
  return out;
}

function parameters(all) {
  const tables = all.map(numbers), keys = [...new Set(tables.flatMap(Object.keys))];
  return keys.length ? section('parameters', 'Parameters', 'Parameters with their intervals', table('Value [95 %]', [{ head: 'parameter' }, ...all.map((r) => ({ head: r.name }))],
    keys.map((k) => [k, ...tables.map((t) => (t[k] ? sized(t[k]) : '–'))]))) : null;
}

export function models(result) {
  const all = list(result.results), names = [...new Set(all.flatMap((r) => list(r.balances).map((b) => b.name)))];
  const [plots, draw] = residuals(all, names);
  return { parts: [errors(all), ladder(all), plots, parameters(all), small(all, names)], then: draw };
}
