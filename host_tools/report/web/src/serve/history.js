// history.js - every run of this folder, the newest first, with the error that it ends with as a bar: the ladder over all of them.
import { h } from '../dom.js';
import { drawing } from '../effects.js';
import { effectName, even, isNumber, list, num } from '../words.js';
import { post } from './link.js';
import { choose, chosen, clock, now, onChange, onWheel, saying } from './shared.js';

const verbs = { check: 'check', look: 'look', compare: 'compare', diagnose: 'diagnose', next: 'next drive', simulate: 'simulated drive', watch: 'telemetry', rover_logs: 'rover: its logs', rover_fetch: 'rover: fetched a log', game_new: 'game: new', game_look: 'game: look',
  game_guess: 'game: tried', game_add: 'game: kept', game_open: 'game: seal' };
const what = (e) => (e.verb === 'add' || e.verb === 'drop' ? `${e.verb} ${e.effect}${onWheel(e)}` : e.verb.startsWith('game_') && e.effect ? `${verbs[e.verb]} ${e.effect}${onWheel(e)}` : verbs[e.verb] ?? e.verb);
const hidden = (e) => list(e.hidden_effects).map((one) => `${effectName(one)}: ${Object.entries(one.parameters ?? {}).map(([n, p]) => `${n} = ${num(p.value)}${p.unit === '1' ? '' : ` ${p.unit}`}`).join(', ')}`).join('; ');
const short = (x) => even(x, Math.abs(x) < 9.95 ? 2 : 1);
// what the model missed by as it was given, and at the end
const error = (e) => (!isNumber(e.after) ? '–' : isNumber(e.before) ? `${short(e.before)} → ${short(e.after)}` : short(e.after));
function bar(e, most) {
  if (!isNumber(e.after)) return null;
  const wide = (x) => `width:${((100 * Math.min(x, most)) / most).toFixed(2)}%`;
  return [h('div', { class: 'bar before', style: wide(isNumber(e.before) ? e.before : e.after) }), h('div', { class: 'bar', style: wide(e.after) })];
}
export const showable = (e) => e.result && !['simulate', 'watch', 'rover_logs', 'rover_fetch', 'game_new', 'game_guess', 'game_add', 'game_open'].includes(e.verb);

export function history() {
  const [wrong, tried] = saying(), body = h('tbody', {}), none = h('p', { class: 'quiet' }, 'Nothing was run yet. Choose a log and a model above, or let the simulated rover drive.');
  const list_ = h('table', { class: 'runs stack' }, h('caption', {}, 'Error as a multiple of the sensor noise: of the model as it was given → at the end (retuned within its tolerances, or with what was named or added)'), h('thead', {}, h('tr', {}, ['run', 'log and model', 'error', 'as a bar', 'answer', ''].map((x) => h('th', { scope: 'col' }, x || h('span', { class: 'hidden' }, 'show'))))), body);
  const node = h('section', { id: 'history', 'data-short': 'History' }, h('h2', {}, 'What was run'), none, h('div', { class: 'scroll' }, list_), wrong);
  onChange(() => {
    const all = now.history.slice(-60).reverse(), text = JSON.stringify([all, chosen.shown]);
    none.hidden = all.length > 0;
    list_.hidden = !all.length;
    if (body.dataset.text === text) return;
    body.dataset.text = text;
    const most = Math.max(1, ...all.flatMap((e) => [e.before, e.after]).filter(isNumber)), focused = document.activeElement?.dataset?.run;
    body.replaceChildren(...all.map((e) => h('tr', { class: e.id === chosen.shown ? 'shown' : null }, h('th', { scope: 'row' }, what(e), h('div', { class: 'quiet' }, `number ${e.id}, ${clock(e.began_ms)}`)),
      h('td', { 'data-head': 'log and model' }, e.log ?? '', e.model && h('div', { class: 'quiet' }, e.model.replace('shipped/', ''), e.made && ` → ${e.made}`)),
      h('td', { class: 'number', 'data-head': 'error' }, error(e)),
      h('td', { class: 'wide', 'aria-hidden': 'true' }, bar(e, most)),
      h('td', { 'data-head': 'answer' }, e.state === 'running' ? 'runs' : e.state === 'failed' ? h('span', { class: 'wrong' }, e.message) : e.state === 'cancelled' ? 'cancelled' : e.state === 'ended' ? e.message : e.headline ?? e.hidden ?? 'done',
        e.hidden_effects && h('div', {}, list(e.hidden_effects).map((one) => drawing(one.name ?? one.effect)), h('strong', {}, `Hidden: ${hidden(e)}`))),
      h('td', {}, showable(e) && h('button', { type: 'button', 'data-run': e.id, 'aria-pressed': String(e.id === chosen.shown), onclick: () => { choose({ shown: e.id, follow: false }); document.getElementById('result').scrollIntoView(); } }, 'Show'),
        e.sealed && !e.hidden_effects && e.state !== 'running' && h('button', { type: 'button', onclick: () => tried(() => post('/api/seal', { id: e.id })) }, 'Open the seal')))));
    if (focused) body.querySelector(`[data-run="${focused}"]`)?.focus();
  });
  return node;
}
