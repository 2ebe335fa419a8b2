// tracks.js - a band on the ground behind each wheel, coloured by what its slip (or grip, or sinkage) was there. Wheels that run in one
// track share its width, the first one outside.
import { BufferAttribute, BufferGeometry, DoubleSide, Group, Line, LineBasicMaterial, Mesh, MeshBasicMaterial } from 'three';

// The part of its wheel's width that a band takes: { from, to } along y, from the middle of the wheel.
export function shares(wheels) {
  return wheels.map((w, i) => {
    const same = wheels.map((o, k) => (Math.abs(o.y_m - w.y_m) < 0.5 * w.width_m ? k : -1)).filter((k) => k >= 0);
    const part = w.width_m / same.length, place = same.length - 1 - same.indexOf(i), out = Math.sign(w.y_m) || 1;
    return [-0.5 * w.width_m + place * part, -0.5 * w.width_m + (place + 0.94) * part].map((y) => out * y);
  });
}

export function tracks({ drive, toWorld, trackRows, palette }) {
  const node = new Group(), paint = new MeshBasicMaterial({ vertexColors: true, side: DoubleSide }), { rows, dt, t0 } = drive, parts = shares(drive.rover.wheel);
  // All bands in one geometry, their pieces in the order of time: what is drawn grows, and one call draws it.
  const kept = drive.rover.wheel.map((_, i) => trackRows(i)), total = kept.reduce((sum, rows_) => sum + rows_.length, 0);
  const points = new Float32Array(total * 6), pieces = [], whose = []; // whose: { wheel, row } of each pair of points
  kept.forEach((mine, i) => mine.forEach((k, n) => {
    const w = drive.rover.wheel[i], t = t0 + k * dt, pose = drive.pose(t), sunk = drive.at(`wheel${i}.sinkage_m`, t), pair = whose.length;
    parts[i].forEach((aside, s) => {
      const [x, y, z] = toWorld(pose, [w.x_m, w.y_m + aside, -drive.centre]), late = 0.004 * (k / rows);
      points.set([x, y, z + (Number.isNaN(sunk) ? 0 : sunk) + 0.003 + late], 6 * pair + 3 * s); // just above the free surface; a later track over an earlier one
    });
    whose.push({ wheel: i, row: k });
    if (n) pieces.push({ row: k, pair });
  }));
  pieces.sort((a, b) => a.row - b.row);
  const index = new Uint32Array(pieces.length * 6);
  pieces.forEach(({ pair }, n) => index.set([2 * pair - 2, 2 * pair - 1, 2 * pair, 2 * pair, 2 * pair - 1, 2 * pair + 1], 6 * n));
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(points, 3));
  geometry.setAttribute('color', new BufferAttribute(new Uint8Array(total * 6), 3, true));
  geometry.setIndex(new BufferAttribute(index, 1));
  const bands = new Mesh(geometry, paint);
  bands.frustumCulled = false;
  node.add(bands);
  const way = kept[0] ?? [], path = new Float32Array(way.length * 3); // of the rover's middle, to the end
  way.forEach((k, n) => {
    const [x, y, z] = toWorld(drive.pose(t0 + k * dt), [0, 0, -drive.centre]);
    path.set([x, y, z + 0.004], 3 * n);
  });
  const whole = new BufferGeometry();
  whole.setAttribute('position', new BufferAttribute(path, 3));
  const line = new Line(whole, new LineBasicMaterial({ color: palette.quiet }));
  line.frustumCulled = false;
  node.add(line);
  return { node,
    until(t) {
      const now = (t - t0) / dt;
      let low = 0, high = pieces.length; // first piece after now
      while (low < high) {
        const middle = (low + high) >> 1;
        if (pieces[middle].row <= now) low = middle + 1;
        else high = middle;
      }
      geometry.setDrawRange(0, 6 * low);
    },
    colour(scale) {
      const { array } = geometry.attributes.color;
      whose.forEach(({ wheel, row }, pair) => { const rgb = scale.of(wheel, row); array.set(rgb, 6 * pair); array.set(rgb, 6 * pair + 3); });
      geometry.attributes.color.needsUpdate = true;
    } };
}
