// drive.js - the simulated rover: start a drive, watch speed, slip and currents grow, stop it. The log lies in the folder then.
import { h } from '../dom.js';
import { isNumber, num } from '../words.js';
import { post } from './link.js';
import { livePlots, motion } from './live.js';
import { busy, effectOptions, fill, now, of, onChange, saying } from './shared.js';

export function drive() {
  const scenario = h('select', { id: 'scenario' }), effect = h('select', { id: 'drive-effect' });
  const seed = h('input', { id: 'seed', type: 'number', min: 0, max: 2 ** 53, value: 1 }), seconds = h('input', { id: 'seconds', type: 'number', min: 1, max: 3600, value: 120 });
  const real = h('input', { id: 'realtime', type: 'checkbox' });
  const [wrong, tried] = saying();
  const start = h('button', { type: 'button', class: 'main', onclick: () => tried(() => post('/api/run', { verb: 'simulate', scenario: scenario.value, seed: +seed.value, seconds: +seconds.value,
    realtime: real.checked, ...(effect.value === '?' ? { hidden: true } : effect.value && { effect: effect.value }) })) }, 'Start the drive');
  const stop = h('button', { type: 'button', onclick: () => tried(() => post('/api/cancel', { id: busy('drive')?.id })) }, 'Stop');
  const status = h('p', { role: 'status', id: 'driving' }), place = h('div', { id: 'live' });
  const box = h('details', { id: 'simulated', class: 'tool', 'data-short': 'Simulated rover' }, h('summary', {}, 'A simulated rover'),
    h('p', { class: 'quiet' }, 'Drives a scenario with the rover’s own firmware. The log appears above when the drive ends.'),
    h('div', { class: 'controls form' }, h('p', {}, h('label', { for: 'scenario' }, 'Scenario '), scenario), h('p', {}, h('label', { for: 'drive-effect' }, 'Effect '), effect),
      h('p', {}, h('label', { for: 'seed' }, 'Seed '), seed), h('p', {}, h('label', { for: 'seconds' }, 'Seconds '), seconds), h('p', {}, h('label', {}, real, ' at the pace of the clock')),
      h('p', {}, start, ' ', stop)), status, wrong, place);

  const plots = livePlots(place, box, 'live', motion, 10);

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
    const entry = now.history.find((e) => e.id === plots.id()), t = plots.time();
    status.textContent = running ? `Driving: ${isNumber(t) ? `${num(t, 4)} s driven` : 'begins'}.`
      : entry?.state === 'failed' ? `The drive failed: ${entry.message}` : entry && isNumber(t) ? `The drive ended after ${num(t, 4)} s. Its log: ${entry.log ?? 'none'}.` : '';
  });
  return [box, plots.push];
}
