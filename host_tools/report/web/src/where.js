// where.js - where the model fails: the worst regime in a sentence, and maps of the error over slip, speed, time.
import { h } from './dom.js';
import { section } from './story.js';
import { even, isNumber, list, num } from './words.js';

const LEAST = 20; // rows that a cell needs for its number to say much; as the lab's sentence has it (compare.h)

const enough = (r, y, x) => !isNumber(r.count?.[y]?.[x]) || r.count[y][x] >= LEAST;
const peak = (r) => Math.max(1e-300, ...list(r.value).flatMap((row, y) => list(row).filter((v, x) => isNumber(v) && enough(r, y, x))));

// The ground behind a number is at most half of the heat's colour, so that the page's own ink reads on every cell.
function cell(v, n, most) {
  if (!isNumber(v)) return h('td', { class: 'none' }, h('span', { class: 'hidden' }, 'no samples'));
  const part = Math.round(50 * Math.min(1, Math.max(0, (v - 1) / Math.max(most - 1, 1e-9))));
  return h('td', { class: isNumber(n) && n < LEAST ? 'few' : part > 28 ? 'heat high' : 'heat', style: `--part:${part}%`, title: isNumber(n) ? `${n} samples` : null }, even(v, v < 9.95 ? 1 : 0));
}

function map(r) {
  const edges = list(r.x_edges), most = peak(r);
  const columns = edges.slice(1).map((e, i) => h('th', { scope: 'col' }, h('span', {}, `${num(edges[i], 2)} to ${num(e, 2)}`)));
  return h('div', { class: 'scroll' }, h('table', { class: 'heatmap' }, h('caption', {}, r.title),
    h('thead', {}, h('tr', {}, h('th', { scope: 'col' }, r.x_label || 'from, to'), columns)),
    h('tbody', {}, list(r.y_labels).map((label, y) => h('tr', {}, h('th', { scope: 'row' }, label),
      edges.slice(1).map((_, x) => cell(r.value?.[y]?.[x], r.count?.[y]?.[x], most)))))));
}

// The map with the largest error stands open; the others are folded.
export function where(result) {
  const all = list(result.regimes).filter((r) => list(r.y_labels).length && list(r.x_edges).length > 1).sort((a, b) => peak(b) - peak(a));
  if (!all.length) return null;
  return section('regimes', 'Where it fails', 'Where the model fails', h('p', { class: 'lead' }, result.story?.where || 'It is about as good everywhere.'),
    h('p', { class: 'quiet' }, 'Each number is the error there, as a multiple of the sensor noise: 1 is noise alone. An empty cell has no samples; a number in italics rests on fewer than 20.'),
    map(all[0]), all.slice(1).map((r) => h('details', {}, h('summary', {}, r.title), map(r))));
}
