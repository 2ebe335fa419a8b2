// tried.js - what was found, what was ruled out and why, what this log cannot show, and the drive that would.
import { evidenceStrip, shape } from './charts.js';
import { h, table } from './dom.js';
import { drawing } from './effects.js';
import { more, section } from './story.js';
import { zoom } from './timeplots.js';
import { candidateVerdict, effectName, isNumber, list, num, parameters, percent, seconds, variant } from './words.js';

const SHOWN = 8; // candidates that a reader sees without asking for more
const titled = (c, drawn = true) => [drawn && drawing(c.effect ?? c.name), h('strong', {}, effectName(c)), c.title && h('div', { class: 'quiet' }, c.title), variant(c.variant) && h('div', { class: 'quiet' }, variant(c.variant))];

export function found(result) {
  const all = list(result.accepted);
  return all.length ? section('found', 'Found', 'What was found and added',
    table('Effects that held up, refitted together', [{ head: 'effect' }, { head: 'size [95 %]' }, { head: 'law' }],
      all.map((c) => [titled(c), parameters(c.parameters).map((p) => h('div', {}, p)), [c.equation && h('code', {}, c.equation), c.signature && h('div', { class: 'quiet' }, c.signature)]]))) : null;
}

export function unknown(result) {
  const u = result.unknown;
  if (!u) return null;
  if (u.expression === '0') { // something is there, and no curve
    return section('unknown', 'Unexplained', `Unexplained: ${u.balance}`, h('p', {}, `It depends on ${u.variable}.`));
  }
  return section('unknown', u.instead_of ? 'Or' : 'Unexplained', `${u.instead_of ? `Or, instead of ${u.instead_of}, it` : 'Unexplained:'} depends on ${u.variable}`,
    h('p', {}, u.instead_of ? `In no catalogue, and it explains as much: ${u.balance}. This log cannot tell them apart.` : `No known effect has this shape: ${u.balance ?? 'what is left'}, over ${u.variable}.`), list(u.x).length ? shape(u) : null,
    u.expression && [h('p', {}, 'As an expression for an effect of your own:'), copyable(u.expression, 'expression')]);
}

export function ruledOut(result) {
  const all = list(result.candidates).filter((c) => c.verdict !== 'named');
  if (!all.length) return null;
  const part = (caption, some) => table(caption, [{ head: 'effect' }, { head: 'why not' }], some.map((c) => [titled(c), candidateVerdict(c)]));
  return section('ruled-out', 'Ruled out', 'What was ruled out, and why', part('Came nearest', all.slice(0, SHOWN)),
    all.length > SHOWN ? more('ruled-out-more', `${all.length - SHOWN} more`, part('Further away', all.slice(SHOWN))) : null);
}

export function copyable(text, what) {
  const said = h('span', { class: 'quiet', 'aria-live': 'polite' });
  const code = h('pre', { tabindex: 0, role: 'group', 'aria-label': what }, text);
  async function copy() {
    try {
      await navigator.clipboard.writeText(text);
      said.textContent = ' copied';
    } catch { // a file opened from disk may have no clipboard: mark it for Ctrl+C
      getSelection().selectAllChildren(code);
      said.textContent = ' marked; press Ctrl+C';
    }
  }
  return h('div', { class: 'copyable' }, code, h('button', { type: 'button', onclick: copy }, `Copy the ${what}`), said);
}

const status = { told: 'this log can show it', answered: 'answered by this drive', later: 'by another drive', never: 'not by driving' };

export function unseen(result) {
  const classes = list(result.classes), dark = list(result.not_excited), n = result.next;
  if (!classes.length && !dark.length && !n) return null;
  return section('unseen', 'Not seen', 'What this log cannot show, and the drive that would',
    classes.map((c) => h('p', {}, 'It cannot tell apart: ', h('strong', {}, list(c.members).join(', ')), c.separate_by && `. To separate them: ${c.separate_by}`, '.')),
    dark.length ? [h('p', {}, `${dark.length} effects would not show in it, even at three times the size that matters${n?.scenario_toml ? '' : '. The drive that would: traction next --all'}.`),
      more('not-excited', 'Which, and why', table('Not seen in this log', [{ head: 'effect' }, { head: 'why' }], dark.map((e) => [titled(e), e.why])))] : null,
    n && h('div', { id: 'next' }, h('h3', {}, n.scenario_toml ? `The next drive: ${n.title ?? ''}${isNumber(n.duration_s) && n.duration_s > 0 ? ` (${num(n.duration_s)} s)` : ''}` : 'No drive is proposed'),
      n.why_not && h('p', {}, `No numbers: ${n.why_not}.`),
      list(n.questions).length ? h('ul', {}, list(n.questions).map((q) => h('li', {}, `${list(q.members).join(' or ')}: ${status[q.status] ?? q.status}`, q.measure && `; ${q.measure}`))) : null,
      n.scenario_toml && more('scenario', 'The drive as a scenario', copyable(n.scenario_toml, 'scenario'))));
}

// Everything the ranking rests on, for those who ask.
export function statistics(result) {
  const all = list(result.candidates);
  if (!all.length) return null;
  const duration = result.log?.duration_s || Math.max(...all.flatMap((c) => list(c.evidence).map((w) => w.t1_s)), 1e-9);
  const strip = (c) => list(c.evidence).length
    ? [evidenceStrip(list(c.evidence), duration, `evidence for ${effectName(c)} over 0 to ${num(duration)} s`, zoom),
      list(c.evidence).slice().sort((a, b) => (b.share ?? 0) - (a.share ?? 0)).slice(0, 1).map((w) => seconds(w.t0_s, w.t1_s))] : '–';
  return more('candidates', 'Statistics of what was tried', h('p', { class: 'quiet' }, 'Gain: by how much the squares of the held-out error fall by a linear step, which only ranks. '
    + 'p: chance of such a gain by noise alone, corrected for the number tried. d′: the size over its standard error. The fall that a refit reaches stands on the ladder.'),
  table('Candidate effects, best first', [{ head: 'rank', number: true }, { head: 'effect' }, { head: 'gain [95 %]', number: true }, { head: 'size [95 %]' },
    { head: 'p', number: true }, { head: 'd′', number: true }, { head: 'verdict' }, { head: 'where the evidence sits' }],
  all.map((c) => [isNumber(c.rank) ? String(c.rank) : '–', titled(c, false), [percent(c.heldout_gain), isNumber(c.gain_low) && h('div', { class: 'quiet' }, `${percent(c.gain_low)} to ${percent(c.gain_high)}`)],
    parameters(c.parameters).map((p) => h('div', {}, p)), isNumber(c.p_value) ? (c.p_value < 1e-4 ? '< 0.0001' : num(c.p_value, 2)) : '–', isNumber(c.detectability) ? num(c.detectability, 2) : '–',
    candidateVerdict(c), strip(c)])));
}
