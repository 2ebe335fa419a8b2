// rover.js - a rover's telemetry: how it drives, what its link is like, the logs that it keeps. It is watched and never commanded.
import { h } from '../dom.js';
import { isNumber, num } from '../words.js';
import { post } from './link.js';
import { livePlots, motion } from './live.js';
import { busy, fill, now, onChange, saying, size } from './shared.js';

// the columns of `drive --live -` after time, speed, slips and currents
const [BATTERY, MODE, FAULTS, BRIDGES, ASKED, HEARING, AGE, WIDTH] = [10, 11, 12, 13, 14, 15, 16, 17];
const plots = [...motion, { title: 'Battery, at its terminals', unit: 'V', from: BATTERY, count: 1, label: 'battery' }];
const heard = 0, silent = 2;
const hearing = { 0: 'The rover is heard.', 1: 'No rover answers yet.', 2: 'The rover is silent. What comes next goes into the same log.',
  3: 'What answers signs with another key than this one: nothing of it is believed.', 4: 'What answers has no key: start traction serve without --key to watch it.' };
const when = (s) => (s > 0 ? `${new Date(s * 1000).toISOString().slice(0, 16).replace('T', ' ')} UTC` : 'not known');

export function rover() {
  let words = { faults: [], modes: [], bridges: [] };
  const [wrong, tried] = saying();
  const value = Object.fromEntries(['link', 'speed', 'mode', 'battery', 'faults'].map((key) => [key, h('dd', { id: `rover-${key}` })]));
  const about = h('p', { class: 'quiet' }), status = h('p', { role: 'status', id: 'watching' }), place = h('div', { id: 'telemetry' });
  const button = (text, title, work, kind) => h('button', { type: 'button', class: kind, title, onclick: () => tried(work) }, text);
  const start = button('Watch', 'receive its telemetry into a new log', () => post('/api/run', { verb: 'watch' }), 'main');
  const stop = button('Stop', 'end the log; it lies in the folder then', () => post('/api/cancel', { id: busy('rover')?.id }));
  const ask = button('List its logs', 'what the rover has kept on board', () => post('/api/run', { verb: 'rover_logs' }));
  const which = h('select', { id: 'rover-log' });
  const fetchIt = button('Fetch', 'bring it into the folder and make a log of it', () => post('/api/run', { verb: 'rover_fetch', number: +which.value }));
  const fetching = h('p', { id: 'rover-logs' }, h('label', { for: 'rover-log' }, 'On-board log '), which, ' ', fetchIt), none = h('p', { class: 'quiet' }, 'The rover keeps no logs: its tractiond has no --log folder, or it is empty.');
  const box = h('details', { id: 'rover', class: 'tool', 'data-short': 'Rover', hidden: true, open: true }, h('summary', {}, 'A rover’s telemetry'), about,
    h('div', { class: 'controls' }, h('p', {}, start, ' ', stop, ' ', ask), fetching, none), status, wrong,
    h('dl', { class: 'telling' }, [['Link', 'link'], ['Speed', 'speed'], ['Mode', 'mode'], ['Battery', 'battery'], ['Faults', 'faults']].map(([name, key]) => h('div', {}, h('dt', {}, name), value[key]))), place);
  const live = livePlots(place, box, 'telemetry', plots, WIDTH, (row) => row[HEARING] === heard || row[HEARING] === silent);
  const set = (node, text) => { if (node.textContent !== text) node.textContent = text; };
  const faultsOf = (bits) => words.faults.filter((_, i) => Math.floor(bits / 2 ** i) % 2 === 1);

  onChange(() => {
    box.hidden = !now.rover;
    if (!now.rover) return;
    set(about, `${now.rover.host}. ${now.rover.keyed ? 'Only what is signed with its key is believed' : 'No key was given: what comes is believed unsigned'}. This page watches: it sends the rover no command.`);
    const running = busy('rover'), row = live.last(), state = running && row ? row[HEARING] : null;
    const entry = now.history.filter((e) => e.verb === 'watch').at(-1);
    set(status, running ? hearing[state] ?? 'Begins.' : entry?.state === 'failed' ? `It is not watched: ${entry.message}` : entry?.log ? `It is not watched. The log: ${entry.log}.` : 'It is not watched; nothing was received.');
    status.className = running && state === heard ? '' : 'hint';
    set(value.link, state === null ? '–' : state === heard || state === silent ? `last heard ${row[AGE].toFixed(1)} s ago` : `nothing for ${row[AGE].toFixed(1)} s`);
    value.link.className = state === heard ? '' : 'wrong';
    if (state === heard || !running) { // what was heard last stays, in silence too
      const at = state === heard ? row : null;
      set(value.speed, at ? `${num(at[1], 3)} m/s, asked for ${num(at[ASKED], 3)}` : '–');
      set(value.mode, at ? `${words.modes[at[MODE]] ?? at[MODE]}, bridges: ${words.bridges[at[BRIDGES]] ?? at[BRIDGES]}` : '–');
      set(value.battery, at ? `${num(at[BATTERY], 4)} V` : '–');
      const faults = at ? faultsOf(at[FAULTS]) : [];
      set(value.faults, at ? faults.join(', ') || 'none' : '–');
      value.faults.className = faults.length ? 'wrong' : '';
    }
    const asked = now.history.filter((e) => e.logs).at(-1), off = !now.connected || !!busy('lab');
    none.hidden = !asked || asked.logs.length > 0;
    fetching.hidden = !asked?.logs.length;
    fill(which, (asked?.logs ?? []).map((l) => [String(l.id), `${l.id}: ${size(l.bytes)}, ${when(l.time_s)}`]));
    start.disabled = !now.connected || !!running;
    stop.disabled = !now.connected || !running;
    ask.disabled = fetchIt.disabled = off;
  });
  const ages = (news) => { live.push(news); place.dataset.age = isNumber(live.last()?.[AGE]) ? live.last()[AGE] : ''; };
  return [box, ages, (told) => { words = told; }];
}
