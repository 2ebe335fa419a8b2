// lab.js - the sections of a result of the lab, in the order in which a reader asks.
import { h, table } from './dom.js';
import { correlation, evidenceStrip, shape } from './charts.js';
import { balancePlots, onZoom, settle, zoom, zoomOut } from './timeplots.js';
import {
  candidateVerdict, effectName, even, isNumber, list, num, parameters, percent, scoreLine, seconds, sized, unit, variant, verdictKind,
} from './words.js';

const SHOWN = 8; // candidates that a reader sees without asking for more

function section(id, short, title, ...content) {
  return h('section', { id, 'data-short': short }, h('h2', {}, title), ...content);
}

const windowButton = (w, words) => h('button', { type: 'button', class: 'window', title: 'show this stretch in every plot',
  onclick: () => { zoom(w.t0_s, w.t1_s); document.getElementById('balances')?.scrollIntoView(); } }, words);

function verdict(result) {
  const { score, verdict: v, log, model } = result;
  const facts = [['log', log?.file], ['duration', isNumber(log?.duration_s) && `${num(log.duration_s, 4)} s`], ['model', model?.name || model?.file],
    ['effects in the model', model && (list(model.effects).map(effectName).join(', ') || 'none')],
    ['error', score && isNumber(score.error) && `${num(score.error)} σ`], ['noise floor', score && isNumber(score.floor) && `${num(score.floor)} σ`]];
  const line = v?.text || scoreLine(score);
  if (!line && !facts.some(([, x]) => x)) return null;
  return h('section', { id: 'verdict', 'data-short': 'Verdict' }, h('h2', {}, 'Verdict'),
    v && h('p', { class: 'kind' }, verdictKind(v)), line && h('p', { class: 'verdict' }, line),
    v?.text && score && h('p', {}, scoreLine(score)),
    h('dl', { class: 'facts' }, facts.filter(([, x]) => x).map(([name, x]) => h('div', {}, h('dt', {}, name), h('dd', {}, x)))));
}

function found(result) {
  const all = list(result.accepted);
  return all.length ? section('found', 'Found', 'What was found and added',
    table('Effects that held up, refitted together', [{ head: 'effect' }, { head: 'size [95 %]' }, { head: 'held-out fall', number: true }],
      all.map((c) => [[effectName(c), variant(c.variant) && h('div', { class: 'quiet' }, variant(c.variant))], parameters(c.parameters).map((p) => h('div', {}, p)), percent(c.heldout_gain)]))) : null;
}

function messages(result) {
  const said = list(result.messages);
  return said.length ? section('messages', 'Messages', 'What the lab says about the data', h('ul', {}, said.map((m) => h('li', {}, m)))) : null;
}

function ladder(result) {
  const steps = list(result.ladder);
  if (!steps.length) return null;
  const most = Math.max(1e-300, ...steps.flatMap((r) => [r.train, r.heldout, r.floor]).filter(isNumber));
  const bar = (x, kind) => isNumber(x) && h('div', { class: `bar ${kind}`, style: `width:${((x / most) * 100).toFixed(2)}%` });
  return section('ladder', 'Error ladder', 'Error ladder', h('p', {}, 'Error in units of the noise σ, on the part of the log that was fitted ',
    h('span', { class: 'key bar train' }), ' and on the part held out ', h('span', { class: 'key bar heldout' }), '; the line ',
    h('span', { class: 'key floor' }), ' is the noise floor.'),
  table('Error after each step', [{ head: 'model' }, { head: 'error' }, { head: 'training', number: true }, { head: 'held out', number: true },
    { head: 'floor', number: true }, { head: 'held out / floor', number: true }],
  steps.map((r) => [r.label, h('div', { class: 'bars', 'aria-hidden': 'true' }, bar(r.train, 'train'), bar(r.heldout, 'heldout'),
    isNumber(r.floor) && h('div', { class: 'floor', style: `left:${((r.floor / most) * 100).toFixed(2)}%` })),
  even(r.train, 3), even(r.heldout, 3), even(r.floor, 3), isNumber(r.heldout) && r.floor > 0 ? even(r.heldout / r.floor, 3) : '–'])));
}

function candidates(result) {
  const all = list(result.candidates);
  if (!all.length) return null;
  const duration = result.log?.duration_s
    || Math.max(...all.flatMap((c) => list(c.evidence).map((w) => w.t1_s)), ...list(result.balances).map((b) => list(b.t_s).at(-1) ?? 0), 1e-9);
  const strip = (c) => list(c.evidence).length
    ? [evidenceStrip(list(c.evidence), duration, `evidence for ${effectName(c)} over 0 to ${num(duration)} s`, zoom),
      list(c.evidence).slice().sort((a, b) => (b.share ?? 0) - (a.share ?? 0)).slice(0, 1).map((w) => windowButton(w, seconds(w.t0_s, w.t1_s)))]
    : '–';
  const rows = all.map((c) => [isNumber(c.rank) ? String(c.rank) : '–',
    [h('strong', {}, effectName(c)), variant(c.variant) && h('div', { class: 'quiet' }, variant(c.variant)), c.explains && h('div', { class: 'quiet' }, c.explains)],
    [percent(c.heldout_gain), isNumber(c.gain_low) && h('div', { class: 'quiet' }, `${percent(c.gain_low)} to ${percent(c.gain_high)}`)],
    parameters(c.parameters).map((p) => h('div', {}, p)),
    isNumber(c.p_value) ? (c.p_value < 1e-4 ? '< 0.0001' : num(c.p_value, 2)) : '–',
    isNumber(c.detectability) ? num(c.detectability, 2) : '–',
    h('span', { class: `badge ${c.verdict === 'named' ? 'good' : c.verdict === 'class' ? 'odd' : ''}` }, candidateVerdict(c)), strip(c)]);
  const part = (caption, from, to) => table(caption, [{ head: 'rank', number: true }, { head: 'effect' },
      { head: 'held-out fall', number: true, title: 'by how much the error on held-out data falls, with its 95 % interval' },
      { head: 'size [95 %]' }, { head: 'p', number: true, title: 'corrected for the number of candidates' },
      { head: "d′", number: true, title: 'detectability in this log' }, { head: 'verdict' }, { head: 'where the evidence sits' }], rows.slice(from, to));
  return section('candidates', 'Ranking', 'What could be missing', part('Candidate effects, best first', 0, SHOWN),
    rows.length > SHOWN ? h('details', {}, h('summary', {}, `${rows.length - SHOWN} more candidates`), part('Further candidates', SHOWN)) : null);
}

function classes(result) {
  const all = list(result.classes);
  return all.length ? section('classes', 'Look-alikes', 'Effects this log cannot tell apart',
    h('ul', {}, all.map((c) => h('li', {}, h('strong', {}, list(c.members).join(' ≈ ')),
      c.separate_by && `; to separate them: ${c.separate_by}`)))) : null;
}

function notExcited(result) {
  const all = list(result.not_excited);
  return all.length ? section('not-excited', 'Not shown', 'Effects this log cannot show',
    table('Not excited', [{ head: 'effect' }, { head: 'why' }], all.map((n) => [n.effect, n.why]))) : null;
}

function unknown(result) {
  const u = result.unknown;
  if (!u) return null;
  return section('unknown', 'Unexplained', `Unexplained: depends on ${u.variable}`,
    h('p', {}, `No known effect has this shape: ${u.balance ?? 'what is left'}, over ${u.variable}`,
      isNumber(u.gain) ? `; a free shape would lower the held-out error by ${percent(u.gain)}.` : '.'),
    list(u.x).length ? shape(u) : null,
    u.expression && [h('p', {}, 'As an expression for an effect of your own:'), copyable(u.expression, 'expression')]);
}

function copyable(text, what) {
  const said = h('span', { class: 'quiet', 'aria-live': 'polite' });
  const code = h('pre', { tabindex: 0, 'aria-label': what }, text);
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

function next(result) {
  const n = result.next;
  if (!n) return null;
  return section('next', 'Next manoeuvre', `Next manoeuvre: ${n.title ?? ''}`,
    list(n.separates).length ? h('p', {}, `It separates ${list(n.separates).join(', ')}.`) : null,
    n.scenario_toml && copyable(n.scenario_toml, 'scenario'));
}

function balances(result) {
  const all = list(result.balances);
  if (!all.length) return [null];
  const views = all.map(balancePlots);
  const shown = h('output', { 'aria-live': 'polite' });
  const reset = h('button', { type: 'button', onclick: zoomOut, disabled: true }, 'Whole log');
  const bar = h('div', { class: 'toolbar' }, 'Shown: ', shown, ' ', reset,
    h('span', { class: 'quiet' }, ' Drag across a plot to zoom all of them; double click to go back. With a plot focused: + − ← → Home.'));
  onZoom((a, b, isWhole) => { shown.textContent = seconds(a, b); reset.disabled = isWhole; });
  const worst = (b) => list(b.worst).slice(0, 3).map((w) => [windowButton(w, `${seconds(w.t0_s, w.t1_s)} (${num(w.rmse, 2)})`), ' ']);
  const summary = table('How well the model predicts each balance', [{ head: 'balance' }, { head: 'noise σ', number: true, title: 'where it comes from: hover over the number' }, { head: 'RMSE', number: true },
    { head: 'NRMSE', number: true, title: 'RMSE over the noise σ' }, { head: 'bias', number: true }, { head: 'R²', number: true },
    { head: 'outside the band', number: true, title: 'part of the shown samples; 1 % is what noise alone gives' },
    { head: 'worst 5 s (RMSE)' }],
  all.map((b, i) => [h('a', { href: `#balance-${i}` }, b.title || b.name), h('span', { title: b.sigma_source }, `${num(b.sigma)}${unit(b.unit)}`), `${num(b.rmse)}${unit(b.unit)}`, even(b.nrmse, 2), `${num(b.bias)}${unit(b.unit)}`,
    even(b.r2, 3), percent(views[i].outside), worst(b)]));
  const bodies = all.map((b, i) => h('article', { id: `balance-${i}`, class: 'balance' },
    h('h3', {}, b.title || b.name, b.title && b.title !== b.name ? h('small', {}, ` ${b.name}`) : null), views[i].host));
  const node = section('balances', 'Balances', 'Measured and model', summary, bar, bodies);
  return [node, () => { views.forEach((v) => v.draw()); settle(all); }];
}

function regimes(result) {
  const all = list(result.regimes);
  if (!all.length) return null;
  return section('regimes', 'Regimes', 'Where the model is worst',
    h('p', {}, 'RMS of the residual over the noise σ: 1 is noise alone. Empty: no samples there.'),
    h('div', { class: 'grid' }, all.map((r) => {
      const edges = list(r.x_edges), most = Math.max(1e-300, ...list(r.value).flat().filter(isNumber));
      const cell = (v, n) => {
        if (!isNumber(v)) return h('td', {}, '');
        const part = Math.round(100 * Math.min(1, Math.max(0, (v - 1) / Math.max(most - 1, 1e-9))));
        return h('td', { class: part > 55 ? 'heat dark' : 'heat', style: `--part:${part}%`, title: isNumber(n) ? `${n} samples` : null }, even(v, 1));
      };
      const columns = edges.slice(1).map((e, i) => h('th', { scope: 'col' }, `${num(edges[i], 2)} to ${num(e, 2)}`));
      return h('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': r.title }, h('table', { class: 'heatmap' },
        h('caption', {}, r.title), h('thead', {}, h('tr', {}, h('th', { scope: 'col' }, r.x_label ?? ''), columns)),
        h('tbody', {}, list(r.y_labels).map((label, y) => h('tr', {}, h('th', { scope: 'row' }, label),
          edges.slice(1).map((_, x) => cell(r.value?.[y]?.[x], r.count?.[y]?.[x])))))));
    })));
}

function whiteness(result) {
  const all = list(result.balances).filter((b) => b.acf || list(b.ccf).length);
  if (!all.length) return null;
  const outside = (c) => `${list(c.value).filter((v, i) => isNumber(v) && Math.abs(v) > c.band && !(v === 1 && c.lag_s?.[i] === 0)).length} of ${list(c.value).length} lags outside the 99 % band`;
  const one = (c, title) => h('figure', {}, correlation(c, `${title}: ${outside(c)}`), h('figcaption', {}, title, h('div', { class: 'quiet' }, outside(c))));
  return section('whiteness', 'Correlations', 'Is the residual noise?',
    h('p', {}, 'A residual that is noise alone stays inside the shaded 99 % bands. A slow decay means a missing dynamic part; a cross-correlation names the signal it follows.'),
    all.map((b, i) => h('details', { open: i < 2 }, h('summary', {}, b.title || b.name),
      h('div', { class: 'grid' }, b.acf && one(b.acf, 'autocorrelation'), list(b.ccf).map((c) => one(c, `cross-correlation with ${c.with}`))))));
}

function lineage(result) {
  const effects = list(result.model?.effects), history = list(result.lineage ?? result.model?.lineage);
  const fitted = Object.entries(result.fitted ?? {});
  if (!effects.length && !history.length && !fitted.length) return null;
  const keys = [...new Set(history.flatMap((entry) => Object.keys(entry ?? {})))];
  const text = (x) => (x == null ? '–' : isNumber(x) ? num(x, 4) : typeof x === 'object' ? JSON.stringify(x) : String(x));
  return section('lineage', 'Model', 'The model and where it comes from',
    effects.length ? table(`Effects in ${result.model.name || result.model.file || 'the model'}`, [{ head: 'effect' }, { head: 'size [95 %]' }],
      effects.map((e) => [effectName(e), Object.entries(e.parameters ?? {}).map(([n, p]) => h('div', {}, `${n} = ${sized(p)}`))])) : null,
    fitted.length ? table('Fitted parameters', [{ head: 'parameter' }, { head: 'value [95 %]' }], fitted.map(([name, p]) => [name, sized(p)])) : null,
    history.length ? table('Lineage, oldest first', keys.map((k) => ({ head: k.replaceAll('_', ' ') })), history.map((entry) => keys.map((k) => text(entry?.[k])))) : null);
}

export function lab(result) {
  const [plots, draw] = balances(result);
  return { parts: [verdict(result), found(result), messages(result), ladder(result), candidates(result), classes(result), unknown(result), next(result),
    plots, regimes(result), whiteness(result), notExcited(result), lineage(result)], then: draw };
}
