// lab.js - a result of the lab in the order in which a reader asks: verdict, ladder, where it fails, before and after, what was ruled out,
// what cannot be seen, then the details.
import { correlation } from './charts.js';
import { h, table } from './dom.js';
import { drawing } from './effects.js';
import { signals } from './signals.js';
import { ladder, more, seal, section, verdict } from './story.js';
import { found, ruledOut, statistics, unknown, unseen } from './tried.js';
import { where } from './where.js';
import { effectName, even, isNumber, list, num, percent, sized, unit } from './words.js';

function messages(result) {
  const said = list(result.messages);
  return said.length ? more('messages', 'What the lab says about the data', h('ul', {}, said.map((m) => h('li', {}, m)))) : null;
}

// Of several runs, each fitted by itself: what differs beyond chance is no constant of the machine.
function betweenRuns(result) {
  const all = list(result.between_runs), apart = all.filter((b) => b.differs);
  if (!all.length) return null;
  return [h('p', {}, `Each run was also fitted by itself: of ${all.length} numbers of the machine ${apart.length || 'none'} differ${apart.length === 1 ? 's' : ''} between the runs by more than chance and their intervals allow.`),
    apart.length ? table('Numbers that differ between the runs', [{ head: 'parameter' }, { head: 'by each run [95 %]' }, { head: 'times what the intervals allow', number: true }],
      apart.map((b) => [b.parameter, b.value.map((v, i) => h('div', {}, sized({ value: v, unit: b.unit, low: v - b.half_width[i], high: v + b.half_width[i] }))), even(b.times, 1)])) : null];
}

function validation(result) {
  const all = list(result.validation), apart = betweenRuns(result);
  return all.length || apart ? section('validation', 'Other runs', 'On runs that nothing was fitted to',
    all.length ? table('Error as a multiple of the sensor noise', [{ head: 'run' }, { head: 'model as given', number: true }, { head: 'fitted, no effects', number: true }, { head: 'result', number: true }],
      all.map((v) => [v.log, even(v.stated, 2), even(v.fitted, 2), even(v.result, 2)])) : null, apart) : null;
}

function steps(result) {
  const all = list(result.ladder);
  return all.length ? more('steps', 'Ladder in numbers', table('Error after each step, as a multiple of the sensor noise', [{ head: 'model' }, { head: 'in the fit', number: true },
    { head: 'held out', number: true }, { head: 'noise', number: true }], all.map((r) => [r.label, even(r.train, 3), even(r.heldout, 3), even(r.floor, 3)]))) : null;
}

function fits(result) {
  const all = list(result.balances);
  return all.length ? more('fits', 'Statistics of each signal', table('Residual of each signal', [{ head: 'signal' }, { head: 'noise σ', number: true }, { head: 'where σ is from' },
    { head: 'RMS', number: true }, { head: 'RMS over σ', number: true }, { head: 'bias', number: true }, { head: 'R²', number: true }],
  all.map((b) => [b.title || b.name, `${num(b.sigma)}${unit(b.unit)}`, b.sigma_source ?? '–', `${num(b.rmse)}${unit(b.unit)}`, even(b.nrmse, 2), `${num(b.bias)}${unit(b.unit)}`, even(b.r2, 3)]))) : null;
}

function whiteness(result) {
  const all = list(result.balances).filter((b) => b.acf || list(b.ccf).length);
  if (!all.length) return null;
  const outside = (c) => `${list(c.value).filter((v, i) => isNumber(v) && Math.abs(v) > c.band && !(v === 1 && c.lag_s?.[i] === 0)).length} of ${list(c.value).length} lags outside the 99 % band`;
  const one = (c, title) => h('figure', {}, correlation(c, `${title}: ${outside(c)}`), h('figcaption', {}, title, h('div', { class: 'quiet' }, outside(c))));
  return more('whiteness', 'Is the residual noise?',
    h('p', {}, 'A residual that is noise alone stays inside the shaded 99 % bands. A slow decay means a missing dynamic part; a cross-correlation names the signal it follows.'),
    all.map((b) => h('details', {}, h('summary', {}, b.title || b.name),
      h('div', { class: 'grid' }, b.acf && one(b.acf, 'autocorrelation'), list(b.ccf).map((c) => one(c, `cross-correlation with ${c.with}`))))));
}

function lineage(result) {
  const effects = list(result.model?.effects), history = list(result.lineage ?? result.model?.lineage);
  const fitted = Object.entries(result.fitted ?? {}), limits = list(result.limits);
  if (!effects.length && !history.length && !fitted.length && !limits.length) return null;
  const keys = [...new Set(history.flatMap((entry) => Object.keys(entry ?? {})))];
  const text = (x) => (x == null ? '–' : isNumber(x) ? num(x, 4) : typeof x === 'object' ? JSON.stringify(x) : String(x));
  return more('lineage', 'The model and where it comes from',
    effects.length ? table(`Effects in ${result.model.name || result.model.file || 'the model'}`, [{ head: 'effect' }, { head: 'size [95 %]' }],
      effects.map((e) => [[drawing(e.name), effectName(e)], Object.entries(e.parameters ?? {}).map(([n, p]) => h('div', {}, `${n} = ${sized(p)}`))])) : null,
    fitted.length ? table('Fitted parameters', [{ head: 'parameter' }, { head: 'value [95 %]' }], fitted.map(([name, p]) => [name, sized(p)])) : null,
    limits.length ? h('ul', {}, limits.map((l) => h('li', {}, l.text))) : null,
    history.length ? table('Lineage, oldest first', keys.map((k) => ({ head: k.replaceAll('_', ' ') })), history.map((entry) => keys.map((k) => text(entry?.[k])))) : null);
}

export function lab(result) {
  const [plots, draw] = signals(result);
  const details = [messages, steps, statistics, fits, whiteness, lineage].map((part) => part(result)).filter(Boolean);
  return { parts: [verdict(result), seal(result), ladder(result), where(result), plots, found(result), unknown(result), validation(result), ruledOut(result), unseen(result),
    details.length ? section('details', 'Details', 'Details', details) : null], then: draw };
}
