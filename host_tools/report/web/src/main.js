// main.js - the page: reads the result that stands in the document and shows it by its schema.
import 'uplot/dist/uPlot.min.css';
import './page.css'; // after uPlot's own, which it mends
import { check } from './check.js';
import { h, markScrollers } from './dom.js';
import { driveLog } from './drive.js';
import { setDrawings } from './effects.js';
import { figures } from './figures.js';
import { lab } from './lab.js';
import { models } from './models.js';
import { driveSection } from './replay/section.js';

const result = JSON.parse(document.getElementById('result').textContent);
setDrawings(result.drawings);
const page = document.getElementById('page');
document.title = result.title || (result.log && typeof result.log === 'string' ? `check: ${result.log}` : 'Traction report');

const { parts, then } = ({ 'traction.figures/1': figures, 'traction.check/1': check, 'traction.compared/1': models, 'traction.look/1': driveLog }[result.schema] ?? lab)(result);
const sections = parts.filter(Boolean);
if (result.replay && result.schema !== 'traction.look/1') { // beside the plots, whose cursor it shares; else at the end
  const [drive] = driveSection(result.replay, false), plots = sections.findIndex((p) => p.id === 'balances');
  if (drive) sections.splice(plots < 0 ? sections.length : plots + 1, 0, drive);
}

page.replaceChildren(
  h('header', {}, sections.some((p) => p.id === 'balances') && h('a', { class: 'skip', href: '#signal' }, 'To the plots'), h('h1', {}, document.title),
    h('nav', { 'aria-label': 'Contents' }, h('ul', {}, sections.filter((p) => p.id && p.dataset.short).map((p) =>
      h('li', {}, h('a', { href: `#${p.id}` }, p.dataset.short)))))),
  ...sections,
  h('footer', {}, h('button', { type: 'button', onclick: save }, 'Save the data (JSON)'),
    ' The whole result stands inside this file; nothing is loaded from anywhere.'));
then?.();
markScrollers(page);
new ResizeObserver(() => markScrollers(page)).observe(page);
page.addEventListener('toggle', () => markScrollers(page), true); // a folded table has no width
document.documentElement.dataset.ready = 'yes';

// what the lab put out; the replay is the log's, the drawings are the catalogue's
function save() {
  const address = URL.createObjectURL(new Blob([JSON.stringify({ ...result, replay: undefined, drawings: undefined }, null, 1)], { type: 'application/json' }));
  h('a', { href: address, download: 'result.json' }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}
