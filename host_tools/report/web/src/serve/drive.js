// drive.js - the simulated rover: start a drive, watch speed, slip and currents grow, stop it. The log lies in the folder then.
import uPlot from 'uplot';
import { h } from '../dom.js';
import { axis, css } from '../timeplots.js';
import { isNumber, num } from '../words.js';
import { post } from './link.js';
import { busy, effectOptions, fill, now, of, onChange, saying } from './shared.js';

const strokes = ['--residual', '--model', '--good', '--p3'], dashes = [[], [6, 3], [2, 3], [10, 3, 2, 3]];
const wheelNames = ['rear left', 'rear right', 'front left', 'front right'];
// the columns of `simulate --live -`: time, speed, four slips, four currents
const plots = [{ title: 'Ground speed, as the firmware knows it', unit: 'm/s', from: 1, count: 1 }, { title: 'Slip of each wheel', unit: '1', from: 2, count: 4 },
  { title: 'Current of each motor', unit: 'A', from: 6, count: 4 }];

export function drive() {
  let columns = Array.from({ length: 10 }, () => []), id = 0, made = [], due = false;
  const scenario = h('select', { id: 'scenario' }), effect = h('select', { id: 'drive-effect' });
  const seed = h('input', { id: 'seed', type: 'number', min: 0, max: 2 ** 53, value: 1 }), seconds = h('input', { id: 'seconds', type: 'number', min: 1, max: 3600, value: 120 });
  const real = h('input', { id: 'realtime', type: 'checkbox' });
  const [wrong, tried] = saying();
  const start = h('button', { type: 'button', class: 'main', onclick: () => tried(() => post('/api/run', { verb: 'simulate', scenario: scenario.value, seed: +seed.value, seconds: +seconds.value,
    realtime: real.checked, ...(effect.value === '?' ? { hidden: true } : effect.value && { effect: effect.value }) })) }, 'Start the drive');
  const stop = h('button', { type: 'button', onclick: () => tried(() => post('/api/cancel', { id: busy('drive')?.id })) }, 'Stop');
  const status = h('p', { role: 'status', id: 'driving' }), place = h('div', { id: 'live' });
  const box = h('details', { id: 'drive', class: 'tool', 'data-short': 'Simulated rover' }, h('summary', {}, 'A simulated rover'),
    h('p', { class: 'quiet' }, 'Drives a scenario with the rover’s own firmware. The log appears above when the drive ends.'),
    h('div', { class: 'controls form' }, h('p', {}, h('label', { for: 'scenario' }, 'Scenario '), scenario), h('p', {}, h('label', { for: 'drive-effect' }, 'Effect '), effect),
      h('p', {}, h('label', { for: 'seed' }, 'Seed '), seed), h('p', {}, h('label', { for: 'seconds' }, 'Seconds '), seconds), h('p', {}, h('label', {}, real, ' at the pace of the clock')),
      h('p', {}, start, ' ', stop)), status, wrong, place);

  function draw() {
    due = false;
    if (!box.open || !columns[0].length) return;
    if (!made.length) {
      place.replaceChildren();
      for (const p of plots) {
        const host = h('div', {}), last = p === plots.at(-1);
        place.append(h('figure', { 'aria-label': p.title }, h('figcaption', {}, `${p.title} [${p.unit}]`), host));
        made.push(new uPlot({ width: Math.max(260, place.clientWidth), height: last ? 170 : 140, pxAlign: 0, scales: { x: { time: false } }, cursor: { sync: { key: 'live' }, drag: { x: false, y: false } },
          legend: { live: true }, axes: [axis(last ? 'time [s]' : undefined, 26, 50), axis(undefined, 50, 26)],
          series: [{ label: 'time [s]', value: (_, v) => num(v, 4) }, ...Array.from({ length: p.count }, (_, i) => ({ label: p.count === 1 ? 'speed' : wheelNames[i], stroke: () => css(strokes[i]), dash: dashes[i],
            width: 1.3, points: { show: false }, value: (_u, v) => num(v, 3) }))] }, [columns[0], ...columns.slice(p.from, p.from + p.count)], host));
      }
    } else made.forEach((u, i) => u.setData([columns[0], ...columns.slice(plots[i].from, plots[i].from + plots[i].count)]));
    place.dataset.rows = columns[0].length;
  }
  const soon = () => { if (!due) { due = true; requestAnimationFrame(draw); } };
  new ResizeObserver(() => made.forEach((u) => u.setSize({ width: Math.max(260, place.clientWidth), height: u.height }))).observe(place);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => made.forEach((u) => u.redraw(false)));
  box.addEventListener('toggle', soon);

  onChange(() => {
    fill(scenario, of('scenario').map((f) => [f.name, f.name.replace('shipped/', '').replace('.toml', ''), f.name.startsWith('shipped/') ? 'shipped' : 'of this folder']));
    if (!scenario.dataset.begun && scenario.options.length) {
      scenario.dataset.begun = 'yes';
      scenario.value = 'shipped/identification.toml';
      if (scenario.selectedIndex < 0) scenario.selectedIndex = 0;
    }
    fill(effect, [['', 'none: as the model says'], ['?', 'one that is hidden from you (sealed)'], ...effectOptions()]);
    const running = busy('drive');
    if (!box.dataset.begun && now.connected && now.files.length) { // open where there is nothing to learn from yet, or something moves
      box.dataset.begun = 'yes';
      box.open = !!running || !of('log', 'foreign').length;
    }
    start.disabled = !now.connected || !!running || !scenario.value;
    stop.disabled = !now.connected || !running;
    const entry = now.history.find((e) => e.id === id), t = columns[0].at(-1);
    status.textContent = running ? `Driving: ${isNumber(t) ? `${num(t, 4)} s driven` : 'begins'}.`
      : entry?.state === 'failed' ? `The drive failed: ${entry.message}` : entry && isNumber(t) ? `The drive ended after ${num(t, 4)} s. Its log: ${entry.log ?? 'none'}.` : '';
  });
  const rows = (news) => {
    if (news.id !== id || news.from === 0) { id = news.id; columns = columns.map(() => []); }
    if (news.from > columns[0].length) return; // never: what is missing comes again from its beginning
    for (const row of news.rows.slice(columns[0].length - news.from)) columns.forEach((c, i) => c.push(isNumber(row[i]) ? row[i] : null));
    soon();
  };
  return [box, rows];
}
