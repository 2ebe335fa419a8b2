// signals.js - measured and model, before and after, of one signal at a time; every signal's error in a table that chooses it.
import { h, s } from './dom.js';
import { section } from './story.js';
import { balancePlots, gapWords, onZoom, rowsLeftOut, settle, shownCsv, zoom, zoomOut } from './timeplots.js';
import { even, isNumber, list, num, seconds, unit } from './words.js';

// The error over the log as a small picture; where there are no rows it is empty.
export function spark(values, most) {
  const all = list(values), wide = 6, tall = 22;
  if (!all.length) return '–';
  return s('svg', { class: 'spark', viewBox: `0 0 ${all.length * wide} ${tall}`, width: all.length * 4, height: tall, 'aria-hidden': 'true' },
    all.map((v, i) => isNumber(v) && s('rect', { x: i * wide, width: wide - 1, y: tall - Math.max(1, (tall * v) / most), height: Math.max(1, (tall * v) / most) })));
}

const fall = (b) => (isNumber(b.nrmse_after) ? `${even(b.nrmse, 1)} → ${even(b.nrmse_after, 1)}` : even(b.nrmse, 1));

// save the stretch that is shown as a CSV file
function save(balance) {
  const address = URL.createObjectURL(new Blob([shownCsv(balance)], { type: 'text/csv' }));
  h('a', { href: address, download: `${balance.name}.csv` }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}

export function signals(result) {
  const all = list(result.balances);
  if (!all.length) return [null];
  const order = all.map((b, i) => i).sort((a, b) => (all[b].nrmse ?? 0) - (all[a].nrmse ?? 0));
  const fell = (b) => (isNumber(b.nrmse_after) ? b.nrmse - b.nrmse_after : 0);
  const views = all.map(balancePlots), after = all.some((b) => list(b.after).length);
  const shown = h('output', { 'aria-live': 'polite' }), place = h('div', {}), about = h('p', { class: 'quiet' });
  const choice = h('select', { id: 'signal', onchange: () => show(+choice.value) },
    order.map((i) => h('option', { value: i }, all[i].title || all[i].name)));
  const reset = h('button', { type: 'button', onclick: zoomOut, disabled: true }, 'Whole log');
  let now = -1;
  function show(i) {
    if (now >= 0) views[now].remove();
    choice.value = String(now = i);
    place.replaceChildren(views[i].host);
    views[i].draw();
    about.textContent = [views[i].band, gapWords(all[i])].filter(Boolean).join(' ');
  }
  onZoom((a, b, isWhole) => { shown.textContent = seconds(a, b); reset.disabled = isWhole; });
  const worst = (b, i) => list(b.worst).slice(0, 1).map((w) => h('button', { type: 'button', class: 'window', title: `show this stretch of ${b.name}`,
    onclick: () => { show(i); zoom(w.t0_s, w.t1_s); choice.scrollIntoView({ block: 'center' }); } }, seconds(w.t0_s, w.t1_s)));
  const most = Math.max(1e-300, ...all.flatMap((b) => list(b.strip).filter(isNumber)));
  const row = (i) => { const b = all[i]; return h('tr', {}, h('th', { scope: 'row' }, h('button', { type: 'button', class: 'plain', onclick: () => { show(i); choice.scrollIntoView({ block: 'center' }); } }, b.title || b.name)),
    h('td', { class: 'number' }, `${num(b.rmse, 2)}${unit(b.unit)}`), h('td', { class: 'number' }, fall(b)), h('td', {}, spark(b.strip, most)), h('td', {}, worst(b, i)), h('td', { class: 'number' }, String(rowsLeftOut(b) || '–'))); };
  const heads = [['signal'], ['off by', 1], ['times its noise', 1], ['over the log'], ['worst 5 s'], ['rows left out', 1]];
  const node = section('balances', 'Plots', after ? 'Measured and model, before and after' : 'Measured and model',
    h('div', { class: 'toolbar' }, h('label', { for: 'signal' }, 'Signal '), choice, ' Shown: ', shown, ' ', reset, ' ',
      h('button', { type: 'button', onclick: () => save(all[now]) }, 'Save what is shown (CSV)'),
      h('span', { class: 'quiet' }, ' Drag across a plot to zoom; double click: all. Keys: + − ← → Home.')),
    place, about, h('details', {}, h('summary', {}, 'Every signal, the worst first'),
      h('div', { class: 'scroll' }, h('table', { class: 'stack' }, h('caption', {}, 'How far off each signal is'),
        h('thead', {}, h('tr', {}, heads.map(([head, number]) => h('th', { scope: 'col', class: number && 'number' }, head)))),
        h('tbody', {}, order.map(row))))));
  // first the signal whose error fell most, where one did by a tenth; else the worst
  const best = order.reduce((a, b) => (fell(all[b]) > fell(all[a]) ? b : a));
  return [node, () => { settle(all); show(fell(all[best]) > 0.1 * all[best].nrmse ? best : order[0]); }];
}
