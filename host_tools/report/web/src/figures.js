// figures.js - a set of figures: what the source says beside what was measured, each with its drawing.
import { h, table } from './dom.js';
import { isNumber, list, num } from './words.js';

// The drawing as an image element of the page; scripts and handlers in it are left out.
function drawing(text, title) {
  const root = new DOMParser().parseFromString(text, 'image/svg+xml').documentElement;
  if (root.nodeName !== 'svg') return h('p', { class: 'quiet' }, 'The drawing cannot be read.');
  for (const element of [root, ...root.querySelectorAll('*')]) {
    if (/^(script|foreignObject|iframe)$/i.test(element.nodeName)) element.remove();
    for (const { name } of [...element.attributes]) if (/^on/i.test(name) || (/href$/i.test(name) && !element.getAttribute(name).startsWith('#'))) element.removeAttribute(name);
  }
  root.setAttribute('aria-label', title);
  root.removeAttribute('width');
  root.removeAttribute('height');
  return document.importNode(root, true);
}

const LONG = 15; // rows of a table that a reader sees without asking for more
const tone = (verdict) => (/^(agrees|reproduced|ok|pass|yes)/i.test(verdict ?? '') ? 'good' : verdict ? 'odd' : '');

export function figures(result) {
  const all = list(result.figures);
  const judged = all.filter((f) => f.paper || f.ours || f.verdict); // a figure without a word on a source is a figure alone
  const method = judged.some((f) => f.paper_here), HERE = "the paper's method here"; // then the verdict is of that method, not of ours
  const summary = judged.length && h('section', { id: 'summary', 'data-short': 'Summary' }, h('h2', {}, 'Summary'),
    table('Paper and ours', [{ head: 'figure' }, { head: 'paper' }, ...(method ? [{ head: HERE }, { head: 'verdict on it' }] : []), { head: 'ours' }, ...(method ? [] : [{ head: 'verdict' }])],
      judged.map((f) => {
        const badge = h('span', { class: `badge ${tone(f.verdict)}` }, f.verdict || '–');
        return [h('a', { href: `#figure-${f.id}` }, f.title || f.id), f.paper || '–', ...(method ? [f.paper_here || '–', badge, f.ours || '–'] : [f.ours || '–', badge])];
      })));
  const bodies = all.map((f) => h('section', { id: `figure-${f.id}`, class: 'figure' }, h('h2', {}, f.title || f.id),
    h('figure', {}, f.svg ? drawing(f.svg, f.title || f.id) : null,
      h('figcaption', {},
        judged.includes(f) ? h('dl', { class: 'pair' }, h('dt', {}, 'paper'), h('dd', {}, f.paper || '–'), f.paper_here && [h('dt', {}, HERE), h('dd', {}, f.paper_here)],
          h('dt', {}, method ? 'verdict on it' : 'verdict'), h('dd', {}, h('span', { class: `badge ${tone(f.verdict)}` }, f.verdict || '–')), h('dt', {}, 'ours'), h('dd', {}, f.ours || '–')) : null,
        f.notes && h('p', {}, f.notes)))));
  const rows = (t) => [table(t.title, list(t.columns).map((head, c) => ({ head, number: list(t.rows).some((row) => isNumber(row[c])) })),
    list(t.rows).map((row) => row.map((cell) => (isNumber(cell) ? num(cell, 4) : cell ?? '–')))), t.notes && h('p', {}, t.notes)];
  const tables = list(result.tables).map((t, i) => h('section', { id: `table-${i + 1}`, 'data-short': t.title }, h('h2', {}, t.title),
    list(t.rows).length > LONG ? h('details', {}, h('summary', {}, `All ${t.rows.length} rows`), rows(t)) : rows(t)));
  return { parts: [result.intro && h('section', { id: 'intro' }, ...result.intro.split(/\n\n+/).map((text) => h('p', {}, text))),
    summary, ...bodies, ...tables] };
}
