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

const tone = (verdict) => (/^(agrees|ok|pass|yes)/i.test(verdict ?? '') ? 'good' : verdict ? 'odd' : '');

export function figures(result) {
  const all = list(result.figures);
  const judged = all.filter((f) => f.paper || f.ours || f.verdict); // a figure without a word on a source is a figure alone
  const summary = judged.length && h('section', { id: 'summary', 'data-short': 'Summary' }, h('h2', {}, 'Summary'),
    table('Paper and ours', [{ head: 'figure' }, { head: 'paper' }, { head: 'ours' }, { head: 'verdict' }],
      judged.map((f) => [h('a', { href: `#figure-${f.id}` }, f.title || f.id), f.paper ?? '–', f.ours ?? '–',
        h('span', { class: `badge ${tone(f.verdict)}` }, f.verdict ?? '–')])));
  const bodies = all.map((f) => h('section', { id: `figure-${f.id}`, class: 'figure' }, h('h2', {}, f.title || f.id),
    h('figure', {}, f.svg ? drawing(f.svg, f.title || f.id) : null,
      h('figcaption', {},
        judged.includes(f) ? h('dl', { class: 'pair' }, h('dt', {}, 'paper'), h('dd', {}, f.paper || '–'), h('dt', {}, 'ours'), h('dd', {}, f.ours || '–'),
          h('dt', {}, 'verdict'), h('dd', {}, h('span', { class: `badge ${tone(f.verdict)}` }, f.verdict || '–'))) : null,
        f.notes && h('p', {}, f.notes)))));
  const tables = list(result.tables).map((t, i) => h('section', { id: `table-${i + 1}`, 'data-short': t.title }, h('h2', {}, t.title),
    table(t.title, list(t.columns).map((head, c) => ({ head, number: list(t.rows).some((row) => isNumber(row[c])) })),
      list(t.rows).map((row) => row.map((cell) => (isNumber(cell) ? num(cell, 4) : cell ?? '–')))),
    t.notes && h('p', {}, t.notes)));
  return { parts: [result.intro && h('section', { id: 'intro' }, ...result.intro.split(/\n\n+/).map((text) => h('p', {}, text))),
    summary, ...tables, ...bodies] };
}
