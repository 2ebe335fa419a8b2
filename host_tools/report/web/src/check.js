// check.js - what a log is worth: findings with their mend, rates of the signals, what the drive excited.
import { h, table } from './dom.js';
import { isNumber, list, num, percent, seconds } from './words.js';

const marks = { error: '✘', warning: '▲', note: '·' };
const words = (name) => name.replaceAll('_', ' ');

function findings(result) {
  const all = list(result.findings);
  if (!all.length) return null;
  return h('section', { id: 'findings', 'data-short': 'Findings' }, h('h2', {}, 'Findings'),
    table('What was found', [{ head: 'kind' }, { head: 'signal' }, { head: 'what' }, { head: 'mend' }, { head: 'where' }],
      all.map((f) => [h('span', { class: `badge ${f.severity === 'error' ? 'odd' : ''}` }, `${marks[f.severity] ?? ''} ${f.severity}`), f.signal || '–', f.text ?? '–', f.mend || '–',
        isNumber(f.t0_s) && isNumber(f.t1_s) && f.t1_s > f.t0_s ? seconds(f.t0_s, f.t1_s) : '–'])));
}

function rates(result) {
  const all = list(result.rates);
  return all.length ? h('section', { id: 'rates', 'data-short': 'Rates' }, h('h2', {}, 'Rates'),
    table('Signals and their sampling', [{ head: 'signal' }, { head: 'samples', number: true }, { head: 'median period [s]', number: true }, { head: 'jitter', number: true },
      { head: 'missing', number: true }, { head: 'largest gap [s]', number: true }],
    all.map((r) => [r.signal, isNumber(r.samples) ? String(r.samples) : '–', num(r.median_s), percent(r.jitter), percent(r.missing), num(r.largest_gap_s)]))) : null;
}

function excitation(result) {
  const e = result.excitation;
  if (!e) return null;
  const wheels = list(e.wheels), columns = [...new Set(wheels.flatMap((w) => Object.keys(w)))];
  const show = (x) => (isNumber(x) ? num(x) : typeof x === 'boolean' ? (x ? 'yes' : 'no') : x ?? '–');
  return h('section', { id: 'excitation', 'data-short': 'Excitation' }, h('h2', {}, 'What the drive excited'),
    table('The whole rover', [{ head: 'quantity' }, { head: 'value', number: true }],
      Object.entries(e).filter(([, x]) => !Array.isArray(x)).map(([name, x]) => [words(name), show(x)])),
    wheels.length ? table('Each wheel', columns.map((c) => ({ head: words(c), number: true })), wheels.map((w) => columns.map((c) => show(w[c])))) : null);
}

export function check(result) {
  const found = (kind) => list(result.findings).filter((f) => f.severity === kind).length;
  const line = result.passed ? 'The log is fit to learn from' : 'The log must be mended, or the findings overridden, before anything is fitted';
  return { parts: [h('section', { id: 'verdict', 'data-short': 'Verdict' }, h('h2', {}, 'Verdict'),
    h('p', { class: 'verdict' }, `${line}: ${found('error')} errors, ${found('warning')} warnings.`),
    h('dl', { class: 'facts' }, ['log', 'map', 'model'].filter((k) => result[k]).map((k) => h('div', {}, h('dt', {}, k), h('dd', {}, result[k]))))),
  findings(result), rates(result), excitation(result)] };
}
