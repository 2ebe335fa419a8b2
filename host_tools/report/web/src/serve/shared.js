// shared.js - what the parts of the live page know together: the server's state, what is chosen here, and how to tell each other.
import { h } from '../dom.js';
import { isNumber, num } from '../words.js';

export const now = { rover: null, files: [], history: [], game: null, work: [], connected: false, effects: [] };

// What is chosen survives a reload of this page.
const kept = JSON.parse(sessionStorage.getItem('traction') ?? '{}');
export const chosen = { log: null, model: null, map: '', shown: null, follow: true, ...kept };
export function choose(some) {
  Object.assign(chosen, some);
  sessionStorage.setItem('traction', JSON.stringify(chosen));
  tell();
}

const parts = [];
export const onChange = (part) => parts.push(part);
export function tell() { parts.forEach((part) => part()); }

export const of = (...kinds) => now.files.filter((f) => kinds.includes(f.kind));
const places = { simulate: 'drive', watch: 'rover' };
export const busy = (where) => now.work.find((w) => (places[w.verb] ?? 'lab') === where);

export const size = (bytes) => (bytes < 1e3 ? `${bytes} B` : bytes < 1e6 ? `${num(bytes / 1e3, 2)} kB` : `${num(bytes / 1e6, 3)} MB`);
export const clock = (ms) => (isNumber(ms) ? new Date(ms).toLocaleTimeString([], { hour12: false }) : '');
export const onWheel = (e) => (isNumber(e.wheel) && e.wheel >= 0 ? ` on wheel ${e.wheel}` : '');

// Options are made anew only where they are other ones, so that an open list stays open and the choice stays chosen.
export function fill(select, options, value) {
  const text = JSON.stringify(options), before = select.value;
  if (select.dataset.options !== text) {
    select.dataset.options = text;
    const groups = new Map();
    for (const [key, words, group] of options) {
      if (!groups.has(group ?? '')) groups.set(group ?? '', []);
      groups.get(group ?? '').push(h('option', { value: key }, words));
    }
    select.replaceChildren(...[...groups].flatMap(([name, all]) => (name ? [h('optgroup', { label: name }, all)] : all)));
    if (options.some(([key]) => key === before)) select.value = before;
  }
  if (value !== undefined && value !== null) select.value = value;
}

// What went wrong with a request is said beside its button.
export function saying() {
  const place = h('p', { class: 'wrong', role: 'alert' });
  const tried = async (work) => {
    place.textContent = '';
    try { await work(); } catch (error) { place.textContent = error.message; }
  };
  return [place, tried];
}

export const effectOptions = () => now.effects.map((e) => [e.name, `${e.name}: ${e.title}`, e.acts_on]);
export const wheels = [['-1', 'all wheels'], ['0', 'wheel 0, rear left'], ['1', 'wheel 1, rear right'], ['2', 'wheel 2, front left'], ['3', 'wheel 3, front right']];
