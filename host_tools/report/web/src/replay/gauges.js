// gauges.js - what the rover's sensors say at the shown time: slip of each wheel, and the spectrum of the radar.
import { h } from '../dom.js';
import { css } from '../timeplots.js';
import { num } from '../words.js';
import { openRadar } from './data.js';

const signed = (x, digits) => (Number.isNaN(x) ? '–' : `${x < 0 ? '−' : ' '}${Math.abs(x).toFixed(digits)}`);

function canvasOf(label, tall) {
  const canvas = h('canvas', { role: 'img', 'aria-label': label, style: `height:${tall}px` });
  const fit = () => {
    const ratio = Math.min(2, devicePixelRatio), wide = Math.max(120, canvas.clientWidth);
    if (canvas.width !== Math.round(wide * ratio) || canvas.height !== Math.round(tall * ratio)) {
      canvas.width = Math.round(wide * ratio);
      canvas.height = Math.round(tall * ratio);
    }
    const ctx = canvas.getContext('2d', { willReadFrequently: true });
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    ctx.clearRect(0, 0, wide, tall);
    ctx.font = '12px sans-serif';
    ctx.textBaseline = 'middle';
    return [ctx, wide];
  };
  return [canvas, fit];
}

function slipGauge(drive) {
  const n = drive.rover.wheel.length, row = 19;
  const [canvas, fit] = canvasOf('Slip of each wheel now, from minus one to one', n * row + 18);
  const names = n === 4 ? ['rear left', 'rear right', 'front left', 'front right'] : drive.rover.wheel.map((w, i) => `wheel ${w.number ?? i}`);
  const draw = (t) => {
    const [ctx, wide] = fit(), left = 74, right = wide - 48, middle = (left + right) / 2, half = (right - left) / 2;
    ctx.fillStyle = css('--quiet');
    for (const [x, text] of [[-1, '−1'], [0, '0'], [1, '1']]) { ctx.textAlign = 'center'; ctx.fillText(text, middle + x * half, n * row + 9); }
    for (let i = 0; i < n; ++i) {
      const y = i * row + row / 2, slip = drive.at(`wheel${i}.slip`, t);
      ctx.fillStyle = css('--soft');
      ctx.fillRect(left, y - 6, right - left, 12);
      if (!Number.isNaN(slip)) {
        ctx.fillStyle = css(slip < 0 ? '--residual' : '--model');
        const to = middle + Math.max(-1, Math.min(1, slip)) * half;
        ctx.fillRect(Math.min(middle, to), y - 6, Math.max(1, Math.abs(to - middle)), 12);
      }
      ctx.fillStyle = css('--ink');
      ctx.fillRect(middle - 0.5, y - 7, 1, 14);
      ctx.textAlign = 'right';
      ctx.fillText(names[i], left - 6, y);
      ctx.fillText(signed(slip, 2), wide - 4, y);
    }
  };
  return { node: h('figure', {}, h('figcaption', {}, 'Slip of each wheel'), canvas), draw };
}

// Amplitude over frequency; the line where a ground of the estimate's speed would be heard.
function radarGauge(drive) {
  const radar = openRadar(drive.radar), tall = 112;
  if (!radar) return null;
  const [canvas, fit] = canvasOf('Spectrum of the radar now: amplitude over frequency', tall);
  let full = 4; // counts; grows with what was seen, so that the picture does not jump
  const draw = (t) => {
    const [ctx, wide] = fit(), left = 34, right = wide - 6, bottom = tall - 18, now = radar.spectrum(t), top = radar.rate / 2;
    const x = (f) => left + (f / top) * (right - left);
    ctx.fillStyle = css('--soft');
    ctx.fillRect(left, 0, right - left, bottom);
    ctx.fillStyle = css('--quiet');
    ctx.textAlign = 'center';
    for (const f of [0, 0.25, 0.5, 0.75]) ctx.fillText(`${Math.round(f * top)}`, x(f * top) + (f ? 0 : 4), tall - 8);
    ctx.textAlign = 'right';
    ctx.fillText('Hz', right, tall - 8);
    if (!now) return ctx.fillText('no radar now', right - 6, 14);
    full = Math.max(full, ...now.amplitude.subarray(1));
    ctx.fillText(num(full, 2), left - 4, 8);
    ctx.fillText('0', left - 4, bottom - 4);
    const speed = Math.abs(drive.at('estimate_m_s', t));
    if (radar.Hz_per_m_s && !Number.isNaN(speed)) {
      ctx.fillStyle = css('--model');
      ctx.fillRect(x(Math.min(top, speed * radar.Hz_per_m_s)) - 1, 0, 2, bottom);
    }
    ctx.strokeStyle = css('--residual');
    ctx.lineWidth = 1.5;
    ctx.beginPath();
    now.amplitude.forEach((a, k) => { if (k > 0) ctx.lineTo(x((k * radar.rate) / 256), bottom - Math.min(1, a / full) * (bottom - 4)); });
    ctx.stroke();
    return undefined;
  };
  return { node: h('figure', {}, h('figcaption', {}, 'Spectrum of the radar, counts', radar.Hz_per_m_s ? h('small', {}, ' (bar: where the estimated speed is heard)') : null), canvas), draw };
}

// One line of numbers; rewritten a few times a second, since the eye cannot read more.
function numbers(drive) {
  const node = h('output', { class: 'now', 'aria-live': 'off' });
  const speeds = [['speed_m_s', 'speed'], ['estimate_m_s', 'estimated'], ['radar_m_s', 'radar']].filter(([name]) => drive.has(name));
  return { node, draw: (t) => {
    const p = drive.pose(t), sunk = drive.rover.wheel.map((_, i) => drive.at(`wheel${i}.sinkage_m`, t)).filter((x) => !Number.isNaN(x));
    node.textContent = [`x ${signed(p.x, 2)} m, y ${signed(p.y, 2)} m`, `heading ${signed((p.yaw * 180) / Math.PI, 0)}°`,
      ...speeds.map(([name, word]) => `${word} ${signed(drive.at(name, t), 2)} m/s`), sunk.length && `deepest wheel ${signed(1000 * Math.max(...sunk), 1)} mm`].filter(Boolean).join(' · ');
  } };
}

export function gauges(drive) {
  const all = [slipGauge(drive), radarGauge(drive)].filter(Boolean), line = numbers(drive);
  return { nodes: all.map((g) => g.node), line: line.node, draw: (t, words) => { all.forEach((g) => g.draw(t)); if (words) line.draw(t); } };
}
