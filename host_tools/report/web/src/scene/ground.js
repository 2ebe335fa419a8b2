// ground.js - the ground. Level where the log has no height: then the picture's background is it, and a patch under the rover hides what has
// sunk in (a plane over the whole picture would cost a third of the time where the processor draws). Else as the wheels found it. Between and beside their tracks it is the mean of
// the heights near by, weighted by 1/distance^4 (Shepard 1968): a guess that passes through what is known.
import { BufferAttribute, BufferGeometry, Color, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, PlaneGeometry } from 'three';

const MOST = 160; // cells along a side
const STEPS = [0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500];

// Heights of the free surface under the wheels, one mean for each cell that a wheel touched.
function heardOf({ drive, foot }, cell) {
  const cells = new Map();
  for (let k = 0; k < drive.rows; ++k) {
    const t = drive.t0 + k * drive.dt, pose = drive.pose(t);
    drive.rover.wheel.forEach((_, i) => {
      const [x, y, z] = foot(i, pose), sunk = drive.at(`wheel${i}.sinkage_m`, t), key = `${Math.round(x / cell)} ${Math.round(y / cell)}`;
      const sum = cells.get(key) ?? [0, 0, 0, 0];
      cells.set(key, [sum[0] + x, sum[1] + y, sum[2] + z + (Number.isNaN(sunk) ? 0 : sunk), sum[3] + 1]);
    });
  }
  const all = [...cells.values()].map(([x, y, z, n]) => [x / n, y / n, z / n]), every = Math.ceil(all.length / 2500);
  return all.filter((_, i) => i % every === 0);
}

function boxOf({ drive, foot }) {
  let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
  for (let k = 0; k < drive.rows; k += 3) {
    const pose = drive.pose(drive.t0 + k * drive.dt), [x, y] = drive.rover.wheel.length ? foot(0, pose) : [0, 0];
    [x0, x1, y0, y1] = [Math.min(x0, x), Math.max(x1, x), Math.min(y0, y), Math.max(y1, y)];
  }
  return { x: (x0 + x1) / 2, y: (y0 + y1) / 2, long: Math.max(x1 - x0, y1 - y0), x0, x1, y0, y1 };
}

export function ground(shared) {
  const { drive, palette } = shared, node = new Group(), box = boxOf(shared), size = drive.rover.length_m;
  const room = drive.level ? Math.max(12 * size, 0.6 * box.long) : 2.2 * size;
  const [x0, x1, y0, y1] = [box.x0 - room, box.x1 + room, box.y0 - room, box.y1 + room];
  const cell = drive.level ? Infinity : Math.max((x1 - x0) / MOST, (y1 - y0) / MOST, 0.02);
  const nx = drive.level ? 1 : Math.ceil((x1 - x0) / cell), ny = drive.level ? 1 : Math.ceil((y1 - y0) / cell);
  const known = drive.level ? [] : heardOf(shared, cell);
  const height = (x, y) => {
    if (!known.length) return 0;
    let sum = 0, weights = 0;
    for (const [a, b, z] of known) {
      const w = 1 / ((a - x) ** 2 + (b - y) ** 2 + 1e-5) ** 2;
      sum += w * z;
      weights += w;
    }
    return sum / weights;
  };
  const points = new Float32Array((nx + 1) * (ny + 1) * 3), index = [], place = (i, j) => j * (nx + 1) + i;
  for (let j = 0; j <= ny; ++j)
    for (let i = 0; i <= nx; ++i) {
      const x = x0 + (i / nx) * (x1 - x0), y = y0 + (j / ny) * (y1 - y0);
      points.set([x, y, height(x, y)], 3 * place(i, j));
      if (i && j) index.push(place(i - 1, j - 1), place(i, j - 1), place(i, j), place(i - 1, j - 1), place(i, j), place(i - 1, j));
    }
  const geometry = drive.level ? new PlaneGeometry(3 * size, 3 * size) : new BufferGeometry();
  if (!drive.level) {
    geometry.setAttribute('position', new BufferAttribute(points, 3));
    geometry.setIndex(index);
  }
  geometry.computeVertexNormals();
  geometry.setAttribute('color', new BufferAttribute(new Float32Array(geometry.attributes.position.array.length), 3));
  const paint = new MeshBasicMaterial({ vertexColors: true, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 8 });
  const land = new Mesh(geometry, paint);
  node.add(land);

  // lines at whole lengths, on the ground
  const step = STEPS.find((s) => Math.max(x1 - x0, y1 - y0) / s <= 60) ?? 1000, lines = [];
  const along = (from, to, point) => {
    const n = drive.level ? 1 : Math.max(1, Math.ceil((to - from) / (2 * cell)));
    for (let k = 0; k < n; ++k) for (const s of [k, k + 1]) { const [x, y] = point(from + (s / n) * (to - from)); lines.push(x, y, height(x, y) + 0.001); }
  };
  for (let x = Math.ceil(x0 / step) * step; x <= x1; x += step) along(y0, y1, (y) => [x, y]);
  for (let y = Math.ceil(y0 / step) * step; y <= y1; y += step) along(x0, x1, (x) => [x, y]);
  const grid = new BufferGeometry();
  grid.setAttribute('position', new BufferAttribute(new Float32Array(lines), 3));
  const ink = new LineBasicMaterial();
  node.add(new LineSegments(grid, ink));

  return { node, box,
    under(x, y) { if (drive.level) land.position.set(x, y, 0); },
    recolour() {
      const base = new Color(palette.soft), { normal, color } = geometry.attributes;
      for (let i = 0; i < normal.count; ++i) { // the sun baked in: a slope is told from level ground
        const lit = Math.min(1.15, Math.max(0.35, 1 + 1.6 * (0.25 * -normal.getX(i) + 0.2 * -normal.getY(i) + (normal.getZ(i) - 1))));
        color.setXYZ(i, base.r * lit, base.g * lit, base.b * lit);
      }
      color.needsUpdate = true;
      ink.color.set(palette.rule);
    } };
}
