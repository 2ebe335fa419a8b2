// main.js - the live page of `traction serve`: the folder, the buttons of the lab, the simulated rover, one that is watched, the game, what was run, its story.
import 'uplot/dist/uPlot.min.css';
import '../page.css';
import './serve.css';
import { h, markScrollers } from '../dom.js';
import { setDrawings } from '../effects.js';
import { bench } from './bench.js';
import { drive } from './drive.js';
import { game } from './game.js';
import { history } from './history.js';
import { get, listen } from './link.js';
import { result } from './result.js';
import { rover } from './rover.js';
import { choose, now, tell } from './shared.js';

const page = document.getElementById('page');
const folder = h('span', { id: 'folder' }), link = h('p', { id: 'link', role: 'status' }, 'Connecting'), trouble = h('p', { class: 'wrong', role: 'alert', id: 'trouble' });
const [driving, rows] = drive(), [watching, telemetry, learn] = rover();
const sections = [bench(), driving, watching, game(), history()];
page.replaceChildren(h('header', {}, h('a', { class: 'skip', href: '#result' }, 'To the result'), h('h1', {}, 'Traction ', h('small', {}, folder)), link, trouble,
  h('nav', { 'aria-label': 'Contents' }, h('ul', {}, [...sections.map((s) => [s.id, s.dataset.short]), ['result', 'Result']].map(([id, words]) => h('li', {}, h('a', { href: `#${id}` }, words)))))),
...sections, result());
new ResizeObserver(() => markScrollers(page)).observe(page);
page.addEventListener('toggle', () => markScrollers(page), true);

// What a run made, another browser's too, is chosen: its log, or its model.
let seen = null;
function follow(runs) {
  const done = runs.filter((e) => e.state !== 'running'), fresh = seen && done.filter((e) => !seen.has(e.id));
  seen = new Set(done.map((e) => e.id));
  for (const e of fresh ?? []) {
    if ((e.verb === 'simulate' || e.verb === 'rover_fetch') && e.log) choose({ log: e.log });
    if ((e.verb === 'add' || e.verb === 'drop') && e.made && e.state === 'done') choose({ model: e.made });
  }
}

async function effects() {
  try {
    now.effects = await get('/api/effects');
    setDrawings(Object.fromEntries(now.effects.map((e) => [e.name, e.drawing])));
    learn(await get('/api/rover'));
    tell();
  } catch { setTimeout(effects, 2000); }
}

effects();
listen({
  state(state) {
    Object.assign(now, { rover: state.rover, files: state.files, history: state.history, game: state.game });
    folder.textContent = state.folder;
    page.querySelector('nav a[href="#rover"]').parentElement.hidden = !state.rover;
    trouble.textContent = state.trouble;
    document.title = `Traction: ${state.folder.split('/').at(-1)}`;
    follow(now.history);
    tell();
    markScrollers(page);
    document.documentElement.dataset.ready = 'yes';
  },
  work(work) { now.work = work; tell(); },
  rows(news) { rows(news); tell(); },
  telemetry(news) { telemetry(news); tell(); },
  link(connected, words) {
    now.connected = connected;
    link.textContent = words;
    link.className = connected ? 'connected' : 'gone';
    tell();
  },
});
