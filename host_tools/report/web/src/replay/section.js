// section.js - the drive played again: a picture of the rover in three dimensions (or a map), gauges, and one time that it shares with the
// plots' cursor. The code that draws three dimensions stands in the page as text; it is run when the drive is first opened.
import { h } from '../dom.js';
import { section } from '../story.js';
import { css, cursorTo, onPoint } from '../timeplots.js';
import { num, seconds } from '../words.js';
import { scalesOf } from './colours.js';
import { foot, openDrive, toWorld, trackRows } from './data.js';
import { gauges } from './gauges.js';
import { mapView } from './map.js';

const VIEWS = [['behind', 'from behind'], ['side', 'from the side'], ['above', 'from above'], ['whole', 'the whole drive'], ['map', 'as a map (2-D)']];
const palette = () => Object.fromEntries(['paper', 'soft', 'ink', 'quiet', 'grid', 'rule', 'model', 'residual', 'good', 'p3'].map((name) => [name, css(`--${name}`)]));

// The scene's code, once; null where this page has none or the browser cannot draw it.
function scene(drive, host, still) {
  const code = document.getElementById('scene');
  if (!globalThis.tractionScene && code?.textContent) {
    const run = h('script', { nonce: code.nonce || undefined });
    run.textContent = code.textContent;
    document.head.append(run);
  }
  try {
    return globalThis.tractionScene?.open({ drive, host, palette: palette(), foot, toWorld, trackRows, still }) ?? null;
  } catch {
    return null; // no WebGL here
  }
}

function select(label, choices, onchange) {
  const node = h('select', { onchange: () => onchange(node.value) }, choices.map(([value, text]) => h('option', { value }, text)));
  return [h('label', {}, `${label} `, node), node];
}

// The picture with its controls; `start` once it is shown.
function player(replay) {
  const drive = openDrive(replay), scales = scalesOf(drive), dials = gauges(drive);
  const still = matchMedia('(prefers-reduced-motion: reduce)');
  const wait = h('div', { class: 'picture' });
  const stage = h('div', { class: 'stage', tabindex: 0, role: 'group', onkeydown: keys,
    'aria-label': 'The drive. Keys: space plays and stops, left and right arrow a second (with shift a tenth), Home and End, plus and minus come nearer and go away, up and down tilt, comma and full stop turn.' }, wait);
  let view = null, time = drive.t0, playing = false, speed = 1, before = 0, told = 0, frames = 0, since = 0, counted = 0, wished = 'behind', fromPlots = false;

  const button = h('button', { type: 'button', onclick: () => play(!playing) }, 'Play');
  const slider = h('input', { type: 'range', min: drive.t0, max: drive.t1, step: drive.dt, value: drive.t0, 'aria-label': 'Time', oninput: () => go(+slider.value) });
  const clock = h('output', { class: 'clock', 'aria-live': 'off' });
  const [fastLabel, fast] = select('Speed', [0.25, 0.5, 1, 2, 4, 8].map((x) => [x, `× ${x}`]), (x) => { speed = +x; });
  fast.value = '1';
  const [viewLabel, views] = select('View', VIEWS, look);
  const [scaleLabel, scaleBox] = select('Ground shows', scales.map((s) => [s.key, s.name]), () => { show({ scale: scale() }); legend(); });
  const forces = h('input', { type: 'checkbox', checked: true, onchange: () => show({ forces: forces.checked }) });
  const ghost = h('input', { type: 'checkbox', checked: true, onchange: () => show({ ghost: ghost.checked }) });
  const fill = h('button', { type: 'button', 'aria-pressed': 'false', onclick: () => large(!node.classList.contains('large')) }, 'Fill the window');
  const keyLine = h('p', { class: 'quiet legend-line' });
  const scale = () => scales.find((s) => s.key === scaleBox.value) ?? scales[0];
  const hasForce = ['traction_N', 'normal_N', 'lateral_N'].map((q) => drive.rover.wheel.some((_, i) => drive.has(`wheel${i}.${q}`)));

  function legend() {
    const s = scale();
    const patch = (colour, words) => [h('span', { class: 'key', style: `background:var(${colour})` }), ` ${words}  `];
    keyLine.replaceChildren(...[`Ground: ${s.name} `, s.low, h('span', { class: 'ramp', style: `background:${s.css}` }), s.high, ' (dark grey: not known). ',
      ...(hasForce[0] ? patch('--good', 'traction') : []), ...(hasForce[1] ? patch('--residual', 'load') : []), ...(hasForce[2] ? patch('--p3', 'side force') : []),
      ...(hasForce.some(Boolean) ? [`(a wheel's part of the weight, ${num((drive.rover.mass_kg * 9.81) / drive.rover.wheel.length, 2)} N, is as long as two wheels) `] : []),
      ...(drive.has('ghost.x_m') ? patch('--model', 'ghost: by the estimate') : [])].filter((x) => x !== ''));
  }
  function show(change) { view?.set(change); render(); }
  function look(wanted) {
    wished = wanted;
    const need = wanted === 'map' ? '2d' : '3d';
    if (!view || (need !== view.kind && !(need === '3d' && view.lost))) {
      view?.dispose();
      view = need === '3d' ? scene(drive, wait, still.matches) : null;
      if (!view) {
        view = mapView(drive, wait);
        if (need === '3d') { view.lost = true; views.value = 'map'; views.querySelectorAll('option').forEach((o) => { o.disabled = !['map', 'whole'].includes(o.value); });
          stage.dataset.why = 'no WebGL'; notes.prepend(h('li', {}, 'This browser has no WebGL: the drive is drawn as a map.')); }
      }
      stage.dataset.view = view.kind;
      view.onLost = () => { view.dispose(); view = null; look('map'); views.value = 'map'; };
    }
    view.set({ view: wanted, scale: scale(), forces: forces.checked, ghost: ghost.checked });
    render();
  }

  // Draws the time that it is; says in the element where the picture has the rover.
  function render(now = performance.now()) {
    if (!view) return;
    const seen = view.draw(time, now);
    stage.dataset.time = time.toFixed(4);
    stage.dataset.pose = [seen.x, seen.y, seen.yaw].map((v) => v.toFixed(4)).join(' ');
    stage.dataset.frames = frames += 1;
    const words = !playing || now - told > 150;
    if (words) {
      told = now;
      slider.value = time;
      clock.textContent = `${time.toFixed(2)} s of ${drive.t1.toFixed(1)} s`;
      slider.setAttribute('aria-valuetext', seconds(time, time).replace(/–.*/, ' s'));
      if (!fromPlots) cursorTo(time);
    }
    dials.draw(time, words);
  }
  function go(t, pointed = false) {
    time = Math.min(drive.t1, Math.max(drive.t0, t));
    fromPlots = pointed;
    if (!playing) render();
    fromPlots = false;
  }
  function play(on) {
    playing = on;
    if (on && time >= drive.t1 - 1e-9) time = drive.t0;
    button.textContent = on ? 'Pause' : 'Play';
    before = performance.now();
    frames = 0;
    since = before;
    counted = 0;
    if (on) return void requestAnimationFrame(tick);
    view.pace?.(null);
    return render();
  }
  function tick(now) {
    if (!playing) return;
    if (!node.isConnected) { playing = false; return; }
    const pause = still.matches ? 1000 : 0; // who wants no motion gets a picture each second
    if (now - before >= pause) {
      time = Math.min(drive.t1, time + (Math.max(0, now - before) / 1000) * speed);
      before = Math.max(now, before);
      render(now);
      counted += 1;
      if (now - since >= 1000) { // pictures a second, once a second
        stage.dataset.perSecond = ((1000 * counted) / (now - since)).toFixed(1);
        if (!still.matches) view.pace?.((1000 * counted) / (now - since));
        [since, counted] = [now, 0];
      }
    }
    if (time >= drive.t1) play(false);
    else requestAnimationFrame(tick);
  }
  function keys(event) {
    const step = event.shiftKey ? 0.1 : 1, near = (by) => () => { view.zoom(by); render(); }, turn = (a, b) => () => { view.turn(a, b); render(); };
    const moves = { ' ': () => play(!playing), ArrowLeft: () => go(time - step), ArrowRight: () => go(time + step), Home: () => go(drive.t0), End: () => go(drive.t1),
      '+': near(1.25), '=': near(1.25), '-': near(0.8), ArrowUp: turn(0, 0.1), ArrowDown: turn(0, -0.1), ',': turn(-0.15, 0), '.': turn(0.15, 0), Escape: () => large(false) };
    if (event.target !== stage || !(event.key in moves) || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key !== 'Escape') event.preventDefault();
    moves[event.key]();
  }
  function large(on) {
    node.classList.toggle('large', on);
    fill.setAttribute('aria-pressed', String(on));
    render();
  }
  // drag turns the picture; the wheel comes nearer only with ctrl, so that the page scrolls
  stage.addEventListener('pointerdown', (down) => {
    if (down.button !== 0) return;
    let { clientX: x, clientY: y } = down;
    stage.setPointerCapture(down.pointerId);
    const move = (event) => { view?.turn((x - event.clientX) * 0.008, (event.clientY - y) * 0.008); [x, y] = [event.clientX, event.clientY]; if (!playing) render(); };
    const up = () => { stage.removeEventListener('pointermove', move); };
    stage.addEventListener('pointermove', move);
    stage.addEventListener('pointerup', up, { once: true });
    stage.addEventListener('pointercancel', up, { once: true });
  });
  stage.addEventListener('wheel', (event) => { if (event.ctrlKey) { event.preventDefault(); view?.zoom(event.deltaY < 0 ? 1.15 : 0.87); if (!playing) render(); } }, { passive: false });

  const notes = h('ul', { class: 'quiet notes' }, drive.notes.map((words) => h('li', {}, words)));
  const node = h('div', { class: 'player' }, stage,
    h('div', { class: 'toolbar' }, button, ' ', slider, ' ', clock, ' ', fastLabel, ' ', viewLabel, ' ', scaleLabel, ' ',
      hasForce.some(Boolean) ? h('label', {}, forces, ' forces ') : null, drive.has('ghost.x_m') ? h('label', {}, ghost, ' ghost ') : null, fill),
    h('div', { class: 'gauges' }, dials.nodes), h('p', {}, dials.line), keyLine, notes);
  const start = () => {
    shown = () => { playing = false; view?.dispose(); view = null; };
    legend();
    look(wished);
    onPoint((t) => go(t, true));
    new ResizeObserver(() => render()).observe(stage);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { view?.recolour(palette()); render(); });
  };
  return { node, start };
}

// Lets the picture of the drive that is shown go, with what it holds of the graphics: another result takes its place.
let shown = null;
export function closeDrive() {
  shown?.();
  shown = null;
}

// The section of a result's drive, folded unless `open`; and what to do once it stands in the page.
export function driveSection(replay, open) {
  if (!replay?.rows) return [null];
  const { node, start } = player(replay);
  if (open) return [section('drive', 'Drive', 'The drive, played again', node), start];
  let begun = false;
  const fold = h('details', { ontoggle: () => { if (fold.open && !begun) { begun = true; start(); } } }, h('summary', {}, 'Watch the rover drive: slip, forces, radar'), node);
  return [section('drive', 'Drive', 'The drive, played again', fold)];
}
