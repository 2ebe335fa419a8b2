// arrows.js - the forces on each wheel as arrows: traction along it, load upwards, side force across. The weight that a wheel carries on
// average is as long as two diameters. Two calls draw them all: a call costs more than its points where the processor draws.
import { Color, ConeGeometry, CylinderGeometry, Group, InstancedMesh, Matrix4, MeshBasicMaterial, Quaternion, Vector3 } from 'three';

const UP = new Vector3(0, 1, 0); // three.js builds cylinders along y
const KINDS = { traction_N: { way: [1, 0, 0], colour: 'good' }, normal_N: { way: [0, 0, 1], colour: 'residual' }, lateral_N: { way: [0, 1, 0], colour: 'p3' } };

export function arrows({ drive, toWorld, palette }) {
  const { wheel, mass_kg } = drive.rover, node = new Group(), weight = (mass_kg * 9.81) / Math.max(1, wheel.length), thick = 0.09 * drive.radius;
  const all = wheel.flatMap((w, i) => Object.keys(KINDS).filter((name) => drive.has(`wheel${i}.${name}`)).map((name) => ({ w, i, name })));
  if (!all.length) return { node, put: () => {} };
  const shafts = new InstancedMesh(new CylinderGeometry(thick, thick, 1, 8).translate(0, 0.5, 0), new MeshBasicMaterial(), all.length);
  const heads = new InstancedMesh(new ConeGeometry(2.4 * thick, 5 * thick, 10).translate(0, -2.5 * thick, 0), new MeshBasicMaterial(), all.length);
  for (const one of [shafts, heads]) { one.frustumCulled = false; node.add(one); }
  const at = new Matrix4(), turn = new Quaternion(), way = new Vector3(), from = new Vector3(), tip = new Vector3(), size = new Vector3(), colours = {};
  return { node,
    put(pose, t, shown) {
      node.visible = shown;
      if (!shown) return;
      let count = 0;
      for (const { i, w, name } of all) {
        const force = drive.at(`wheel${i}.${name}`, t), length = (4 * w.radius_m * Math.abs(force)) / weight;
        if (!(length > 0.15 * w.radius_m)) continue; // shorter than that it is a dot
        const out = w.y_m + (Math.sign(w.y_m) || 1) * (0.5 * w.width_m + 2 * thick); // outside the wheel, where it is seen
        const start = [w.x_m, out, (name === 'normal_N' ? 0 : 2 * thick) - drive.centre];
        from.set(...toWorld(pose, start));
        way.set(...toWorld(pose, start.map((x, k) => x + KINDS[name].way[k] * Math.sign(force)))).sub(from).normalize();
        turn.setFromUnitVectors(UP, way);
        shafts.setMatrixAt(count, at.compose(from, turn, size.set(1, Math.max(1e-3, length - 4 * thick), 1)));
        heads.setMatrixAt(count, at.compose(tip.copy(from).addScaledVector(way, length), turn, size.setScalar(Math.min(1, length / (6 * thick)))));
        for (const one of [shafts, heads]) one.setColorAt(count, colours[name]);
        count += 1;
      }
      for (const one of [shafts, heads]) {
        one.count = count;
        one.instanceMatrix.needsUpdate = true;
        if (one.instanceColor) one.instanceColor.needsUpdate = true;
      }
    },
    recolour() { for (const [name, { colour }] of Object.entries(KINDS)) colours[name] = new Color(palette[colour]); } };
}
