// drive.js - the page of a log: its drive played again, and its signals over the same time.
import { h } from './dom.js';
import { openDrive } from './replay/data.js';
import { driveSection } from './replay/section.js';
import { section } from './story.js';
import { linesPlot, onZoom, settleTimes, zoom, zoomOut } from './timeplots.js';
import { num, seconds } from './words.js';

const BODY = { speed_m_s: 'true speed', estimate_m_s: 'estimated speed', radar_m_s: 'radar' };

function about({ log, replay }) {
  const facts = [['log', log?.file], ['duration', log?.duration_s > 0 && `${num(log.duration_s, 4)} s`], ['rover', replay?.rover?.name]].filter(([, x]) => x);
  return facts.length ? h('dl', { class: 'facts' }, facts.map(([name, x]) => h('div', {}, h('dt', {}, name), h('dd', {}, x)))) : null;
}

export function driveLog(result) {
  const { replay } = result;
  if (!replay) return { parts: [about(result)] };
  const drive = openDrive(replay), t = Array.from({ length: drive.rows }, (_, i) => drive.t0 + i * drive.dt);
  const wheels = (name) => drive.rover.wheel.map((w, i) => ({ label: `wheel ${w.number ?? i}`, values: drive.values(`wheel${i}.${name}`) })).filter((a) => a.values);
  const groups = [['speed', 'm/s', Object.entries(BODY).map(([name, label]) => ({ label, values: drive.values(name) })).filter((a) => a.values)],
    ['slip', '1', wheels('slip')], ['current', 'A', wheels('current_A')], ['height', 'm', [{ label: 'height', values: drive.values('z_m') }].filter((a) => a.values)]].filter(([, , all]) => all.length);
  const plots = groups.map(([name, unit, all], i) => linesPlot(name, unit, t, all, i + 1 === groups.length));
  const shown = h('output', { 'aria-live': 'polite' }), reset = h('button', { type: 'button', onclick: zoomOut, disabled: true }, 'Whole log');
  const [look, start] = driveSection(replay, true);
  return { parts: [about(result), look, groups.length ? section('signals', 'Plots', 'Over time',
    h('div', { class: 'toolbar' }, 'Shown: ', shown, ' ', reset, h('span', { class: 'quiet' }, ' Point at a plot: the rover goes there. Drag across to zoom; double click: all.')), plots.map((p) => p.host)) : null],
  then: () => {
    settleTimes(t);
    plots.forEach((p) => p.draw());
    onZoom((a, b, all) => { shown.textContent = seconds(a, b); reset.disabled = all; });
    zoom(t[0], t.at(-1));
    start();
  } };
}
