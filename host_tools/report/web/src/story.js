// story.js - the first screens: the verdict with its five answers, the seal of a demo, the ladder of errors with what is left in parts.
import { h } from './dom.js';
import { drawing } from './effects.js';
import { effectName, even, isNumber, list, num, verdictKind } from './words.js';

export function section(id, short, title, ...content) {
  return h('section', { id, 'data-short': short }, h('h2', {}, title), ...content);
}

// folded until asked for
export const more = (id, title, ...content) => h('details', { id, 'data-short': title }, h('summary', {}, title), ...content);

const questions = [['good_enough', 'Is the model good enough?'], ['missing', 'What is missing?'], ['sure', 'How sure is that?'],
  ['left', 'What is left, and why?'], ['next', 'What next?']];

export function verdict(result) {
  const { story = {}, score, verdict: v, log, model } = result;
  const facts = [['log', log?.file], ['duration', isNumber(log?.duration_s) && log.duration_s > 0 && `${num(log.duration_s, 4)} s`],
    ['model', model?.name || model?.file], ['effects in the model', model && (list(model.effects).map(effectName).join(', ') || 'none')]];
  const line = story.headline || v?.text || score?.verdict;
  const answers = questions.filter(([key]) => story[key]);
  if (!line && !facts.some(([, x]) => x)) return null;
  return section('verdict', 'Verdict', v ? verdictKind(v) : 'Verdict', line && h('p', { class: 'verdict' }, line),
    answers.length ? h('dl', { class: 'answers' }, answers.map(([key, question]) => h('div', {}, h('dt', {}, question), h('dd', {}, story[key])))) : null,
    h('dl', { class: 'facts' }, facts.filter(([, x]) => x).map(([name, x]) => h('div', {}, h('dt', {}, name), h('dd', {}, x)))));
}

// The demo alone: what was hidden, opened after the answer.
export function seal(result) {
  const d = result.demo;
  if (!d) return null;
  return section('seal', 'Seal', 'The seal, opened last: who was right?',
    h('dl', { class: 'answers' }, h('div', {}, h('dt', {}, 'Hidden in the drive'), h('dd', {}, drawing(d.hidden?.effect ?? d.hidden?.name), d.hidden_text || effectName(d.hidden ?? {}))),
      h('div', {}, h('dt', {}, 'The answer'), h('dd', {}, list(d.named).join(', ') || 'nothing was named')),
      h('div', {}, h('dt', {}, 'Judgement'), h('dd', {}, h('span', { class: `badge ${d.right ? 'good' : 'odd'}` }, d.right ? '✔ right' : 'not named'), ` ${d.judgement ?? ''}`))));
}

// What stands on the ladder: the model as it was given (nothing was fitted to it; `add` compares the one that it made), then each step on
// what was not fitted.
function steps(result) {
  const { score } = result, ladder = list(result.ladder).filter((r) => isNumber(r.heldout));
  const out = score && isNumber(score.error) && result.verb !== 'add' ? [{ label: 'the model as given', error: score.error }] : [];
  if (ladder.length) out.push(...ladder.filter((r) => r.label !== 'noise floor').map((r) => ({ label: r.label === 'baseline' ? 'retuned within its tolerances' : r.label, error: r.heldout })));
  else if (score && isNumber(score.adjusted)) out.push({ label: 'retuned within its tolerances', error: score.adjusted });
  return out;
}

// The squares of the parts add up, so a part's share of the bar is its share of the square.
function parts(left) {
  const all = list(left?.parts).filter((p) => isNumber(p.error) && p.error > 0), sum = all.reduce((x, p) => x + p.error ** 2, 0);
  return sum > 0 ? all.map((p, i) => ({ ...p, share: p.error ** 2 / sum, kind: i })).filter((p) => p.share >= 0.02).sort((a, b) => b.share - a.share) : [];
}

export function ladder(result) {
  const all = steps(result);
  if (!all.length) return null;
  const most = Math.max(1, ...all.map((s) => s.error)), wide = (x) => `width:${((x / most) * 100).toFixed(2)}%`;
  const left = result.left?.after ?? result.left?.before, split = parts(left);
  const row = (label, error, bar) => h('tr', {}, h('th', { scope: 'row' }, label), h('td', { class: 'number' }, even(error, error < 9.95 ? 2 : 1)), h('td', { class: 'wide', 'aria-hidden': 'true' }, bar));
  return section('ladder', 'Ladder', 'How the error fell',
    h('div', { class: 'scroll' }, h('table', { class: 'ladder' }, h('caption', {}, 'Error as a multiple of the sensor noise, on what was not fitted'),
      h('thead', {}, h('tr', {}, h('th', { scope: 'col' }, 'model'), h('th', { scope: 'col', class: 'number' }, 'error'), h('th', { scope: 'col' }, 'as a bar'))),
      h('tbody', {}, all.map((s) => row(s.label, s.error, h('div', { class: 'bar', style: wide(s.error) }))),
        split.length ? row('what is left in the fit, in parts', left.error,
          h('div', { class: 'split', style: wide(left.error) }, split.map((p) => h('span', { class: `part${p.kind}`, style: `flex:${p.share.toFixed(4)}` })))) : null,
        row('noise of the sensors alone', 1, h('div', { class: 'bar noise', style: wide(1) }))))),
    split.length ? h('ul', { class: 'legend' }, split.map((p) => h('li', {}, h('span', { class: `key part${p.kind}` }),
      ` ${num(p.error, 2)} ${p.text} (${num(100 * p.share, 2)} % of the squares)`))) : null);
}
