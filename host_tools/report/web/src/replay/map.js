// map.js - the drive from above on a plain canvas: for browsers without WebGL, and for whoever likes a map better.
import { h } from '../dom.js';
import { css } from '../timeplots.js';
import { foot, toWorld, trackRows } from './data.js';

export function mapView(drive, host) {
  const canvas = h('canvas', { role: 'img', 'aria-label': 'The drive from above: the rover, its wheels\' tracks coloured, forces as arrows' });
  host.replaceChildren(canvas);
  const xs = drive.values('x_m').filter((v) => !Number.isNaN(v)), ys = drive.values('y_m').filter((v) => !Number.isNaN(v));
  const range = (v) => v.reduce(([a, b], x) => [Math.min(a, x), Math.max(b, x)], [Infinity, -Infinity]);
  const [x0, x1] = range(xs), [y0, y1] = range(ys), { length_m: long, width_m: wide } = drive.rover;
  const state = { scale: null, zoom: 1, view: 'behind', forces: true, ghost: true };
  let ctx, place;

  const polygon = (points) => { ctx.beginPath(); points.forEach((p) => ctx.lineTo(...place(p))); ctx.closePath(); };
  const box = (pose, x, y, half, aside) => [[1, 1], [1, -1], [-1, -1], [-1, 1]].map(([a, b]) => toWorld({ ...pose, pitch: 0, roll: 0, joint: 0 }, false, [x + a * half, y + b * aside, 0]));

  function grid(width, height, perMetre) {
    const step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100].find((s) => s * perMetre > 45) ?? 200;
    const [left, top] = place.back(0, 0), [right, bottom] = place.back(width, height);
    ctx.strokeStyle = css('--grid');
    ctx.lineWidth = 1;
    ctx.beginPath();
    for (let x = Math.ceil(left / step) * step; x < right; x += step) { ctx.moveTo(place([x, 0])[0], 0); ctx.lineTo(place([x, 0])[0], height); }
    for (let y = Math.ceil(bottom / step) * step; y < top; y += step) { ctx.moveTo(0, place([0, y])[1]); ctx.lineTo(width, place([0, y])[1]); }
    ctx.stroke();
    ctx.fillStyle = css('--quiet');
    ctx.fillRect(12, height - 14, step * perMetre, 3);
    ctx.fillText(`${step} m`, 14, height - 20);
  }

  // each wheel's track once, as runs of one colour; 24 shades are told apart on a track
  const rows = drive.rover.wheel.map((_, i) => trackRows(drive, i)), feet = rows.map((mine, i) => mine.map((k) => foot(drive, i, drive.pose(drive.t0 + k * drive.dt))));
  const shade = (rgb) => `rgb(${rgb.map((v) => Math.round(v / 11) * 11)})`;
  let colours = [];
  function tracks(row, perMetre) {
    drive.rover.wheel.forEach(({ width_m }, i) => {
      ctx.lineWidth = Math.max(1.5, 0.6 * width_m * perMetre);
      let colour = '';
      for (let n = 0; n < rows[i].length && rows[i][n] <= row; ++n) {
        const point = place(feet[i][n]);
        if (n) ctx.lineTo(...point);
        if (n && colours[i][n] === colour) continue;
        if (n) ctx.stroke();
        ctx.strokeStyle = colour = colours[i][n];
        ctx.beginPath();
        ctx.moveTo(...point);
      }
      ctx.stroke();
    });
  }

  function arrow(from, to, colour) {
    const [a, b] = place(from), [c, d] = place(to), far = Math.hypot(c - a, d - b), way = Math.atan2(d - b, c - a), head = Math.min(8, far / 2);
    if (far < 7) return;
    ctx.strokeStyle = ctx.fillStyle = colour;
    ctx.lineWidth = 2.5;
    ctx.beginPath(); ctx.moveTo(a, b); ctx.lineTo(c, d); ctx.stroke();
    ctx.beginPath(); ctx.moveTo(c, d); ctx.lineTo(c - head * Math.cos(way - 0.5), d - head * Math.sin(way - 0.5));
    ctx.lineTo(c - head * Math.cos(way + 0.5), d - head * Math.sin(way + 0.5)); ctx.fill();
  }

  function rover(pose, t) {
    const { wheel, halves } = drive.rover, weight = (drive.rover.mass_kg * 9.81) / Math.max(1, wheel.length);
    ctx.fillStyle = css('--soft');
    ctx.strokeStyle = css('--ink');
    ctx.lineWidth = 1.5;
    polygon(box(pose, 0, 0, 0.42 * long, 0.33 * wide)); ctx.fill(); ctx.stroke();
    polygon([[0.42 * long, 0], [0.3 * long, 0.1 * wide], [0.3 * long, -0.1 * wide]].map((p) => toWorld({ ...pose, pitch: 0, roll: 0, joint: 0 }, false, [...p, 0])));
    ctx.fillStyle = css('--ink'); ctx.fill();
    if (halves) { ctx.beginPath(); ctx.moveTo(...place(box(pose, 0, 0, 0.42 * long, 0)[0])); ctx.lineTo(...place(box(pose, 0, 0, 0.42 * long, 0)[2])); ctx.stroke(); }
    wheel.forEach((w, i) => {
      polygon(box(pose, w.x_m, w.y_m, w.radius_m, w.width_m / 2));
      ctx.fillStyle = css('--quiet'); ctx.fill(); ctx.stroke();
      const { traction_N: along, lateral_N: across } = drive.wheel(i, t), at = (dx, dy) => toWorld({ ...pose, pitch: 0, roll: 0, joint: 0 }, false, [w.x_m + dx, w.y_m + dy, 0]);
      const length = (force) => (2 * w.radius_m * 2 * force) / weight;
      if (state.forces && !Number.isNaN(along)) arrow(at(0, 0), at(length(along), 0), css('--good'));
      if (state.forces && !Number.isNaN(across)) arrow(at(0, 0), at(0, length(across)), css('--p3'));
    });
  }

  function draw(t) {
    const ratio = Math.min(2, devicePixelRatio), width = host.clientWidth, height = host.clientHeight, pose = drive.pose(t);
    if (width === 0 || height === 0) return { x: pose.x, y: pose.y, yaw: pose.yaw }; // a page that is being laid out: no scale, nothing to draw
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio);
    }
    ctx = canvas.getContext('2d', { willReadFrequently: true });
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    ctx.clearRect(0, 0, width, height);
    ctx.font = '12px sans-serif';
    ctx.lineJoin = 'round';
    const room = 0.9 * long + 0.15 * (x1 - x0), whole = Math.min(width / (x1 - x0 + 2 * room), height / (y1 - y0 + 2 * room));
    const follow = state.view !== 'whole', perMetre = (follow ? Math.max(whole, Math.min(width, height) / (7 * long)) : whole) * state.zoom;
    const [mx, my] = follow ? [pose.x, pose.y] : [(x0 + x1) / 2, (y0 + y1) / 2];
    place = ([x, y]) => [width / 2 + (x - mx) * perMetre, height / 2 - (y - my) * perMetre];
    place.back = (a, b) => [mx + (a - width / 2) / perMetre, my - (b - height / 2) / perMetre];
    grid(width, height, perMetre);
    tracks(Math.min(drive.rows - 1, Math.max(0, Math.floor((t - drive.t0) / drive.dt))), perMetre);
    const ghost = state.ghost && drive.ghost(t);
    if (ghost) {
      ctx.strokeStyle = css('--model'); ctx.lineWidth = 2; ctx.setLineDash([6, 4]);
      polygon(box({ ...pose, ...ghost }, 0, 0, 0.5 * long, 0.5 * wide)); ctx.stroke(); ctx.setLineDash([]);
    }
    rover(pose, t);
    const [sx, sy] = place([pose.x, pose.y]), [rx, ry] = place.back(sx, sy); // where the picture has it
    return { x: rx, y: ry, yaw: pose.yaw };
  }
  return { kind: '2d', draw, set: (change) => { if (change.scale && change.scale !== state.scale) colours = rows.map((mine, i) => mine.map((k) => shade(change.scale.of(i, k)))); Object.assign(state, change); }, recolour: () => {}, turn: () => {}, zoom: (by) => { state.zoom = Math.min(8, Math.max(0.2, state.zoom * by)); },
    dispose: () => canvas.remove(), software: false };
}
