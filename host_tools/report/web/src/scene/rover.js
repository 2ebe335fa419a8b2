// rover.js - the rover as its description has it: two halves on a hinge across, wheels in their places; and the same as lines, the ghost.
import { BoxGeometry, BufferAttribute, Color, CylinderGeometry, EdgesGeometry, Group, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial } from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';

const SEGMENTS = 20;

// A wheel about the y axis; every other piece of it is light, so that one sees it turn.
function wheelGeometry({ radius_m, width_m }) {
  const made = new CylinderGeometry(radius_m, radius_m, width_m, SEGMENTS).toNonIndexed();
  const { position } = made.attributes, colours = new Float32Array(position.count * 3);
  for (let i = 0; i < position.count; i += 3) { // a triangle
    const middle = (k) => (position.getComponent(i, k) + position.getComponent(i + 1, k) + position.getComponent(i + 2, k)) / 3;
    const piece = Math.floor(((Math.atan2(middle(2), middle(0)) + Math.PI) / (2 * Math.PI)) * SEGMENTS) % SEGMENTS;
    const light = piece % 5 === 0 ? 0.75 : 0.16;
    colours.fill(light, 3 * i, 3 * i + 9);
  }
  made.setAttribute('color', new BufferAttribute(colours, 3));
  return made;
}

// The body stands on the ground at -centre; it is as high as the description says, and narrow enough for its wheels.
function bodyOf(drive) {
  const { wheel, length_m, width_m, height_m } = drive.rover, floor = 0.75 * drive.radius - drive.centre;
  const inside = wheel.length ? Math.min(...wheel.map((w) => (Math.abs(w.y_m) > w.width_m ? 2 * (Math.abs(w.y_m) - 0.65 * w.width_m) : width_m))) : width_m;
  const tall = Math.max(0.3 * height_m, height_m - 0.75 * drive.radius);
  return { long: 0.92 * length_m, wide: Math.min(width_m, inside), tall, middle: floor + tall / 2 };
}

function halves(drive, make) {
  const { long, wide, tall, middle } = bodyOf(drive), out = [];
  for (const side of drive.rover.halves ? [1, -1] : [0]) {
    const part = make(new BoxGeometry(long, side ? wide / 2 - 0.004 : wide, tall), 'body');
    part.position.set(0, (side * wide) / 4, middle);
    const half = new Group();
    half.add(part);
    out.push({ side, half });
  }
  return out;
}

export function roverOf(drive, palette) {
  const node = new Group(), paint = { body: new MeshLambertMaterial(), dark: new MeshLambertMaterial(), wheel: new MeshLambertMaterial({ vertexColors: true }) };
  const { long, wide, tall, middle } = bodyOf(drive);
  const sides = halves(drive, (geometry) => new Mesh(geometry, paint.body));
  sides.forEach(({ half }) => node.add(half));
  // the hinge across, and the box in front from which the radar looks ahead
  const dark = [new BoxGeometry(0.1 * long, 0.3 * wide, 0.22 * tall).translate(0.5 * long, drive.rover.halves ? wide / 8 : 0, middle + 0.2 * tall)];
  if (drive.rover.halves) dark.push(new CylinderGeometry(0.04 * long, 0.04 * long, 1.02 * wide, 12));
  sides[0].half.add(new Mesh(mergeGeometries(dark), paint.dark));
  const wheels = drive.rover.wheel.map((w) => {
    const one = new Mesh(wheelGeometry(w), paint.wheel);
    one.position.set(w.x_m, w.y_m, w.radius_m - drive.centre);
    (sides.find((s) => s.side === 0 || s.side > 0 === w.y_m > 0) ?? sides[0]).half.add(one);
    return one;
  });
  node.rotation.order = 'ZYX'; // yaw, then pitch, then roll
  return { node,
    put(pose, t) {
      node.position.set(pose.x, pose.y, pose.z);
      node.rotation.set(pose.roll, pose.pitch, pose.yaw);
      sides.forEach(({ side, half }) => { half.rotation.y = -0.5 * side * pose.joint; });
      wheels.forEach((one, i) => { const turned = drive.at(`wheel${i}.turn_rad`, t); one.rotation.y = Number.isNaN(turned) ? 0 : turned; });
    },
    recolour() {
      paint.body.color.copy(new Color(palette.residual).lerp(new Color(palette.soft), 0.25));
      paint.dark.color.copy(new Color('#30363d'));
    } };
}

// The rover as lines, without its joint: where the estimate has it.
export function ghostOf(drive, palette) {
  const { long, wide, tall, middle } = bodyOf(drive);
  const wheels = drive.rover.wheel.map((w) => new CylinderGeometry(w.radius_m, w.radius_m, w.width_m, SEGMENTS).translate(w.x_m, w.y_m, w.radius_m - drive.centre));
  const edges = [new BoxGeometry(long, wide, tall).translate(0, 0, middle), ...wheels].map((geometry) => new EdgesGeometry(geometry, 30));
  return new LineSegments(mergeGeometries(edges), new LineBasicMaterial({ color: palette.model }));
}
