// scene.js - the drive in three dimensions (three.js): rover, ghost, coloured tracks, forces, ground. Built into page/scene.js, which the page
// runs when the drive is first opened. World as in the log: z up, metres; the first pose is the origin, since float32 is short.
import { AmbientLight, Color, ColorManagement, DirectionalLight, Group, LinearSRGBColorSpace, PerspectiveCamera, Scene, Vector2, Vector3, WebGLRenderer } from 'three';
import { arrows } from './arrows.js';
import { ground } from './ground.js';
import { ghostOf, roverOf } from './rover.js';
import { tracks } from './tracks.js';

const FAR = { behind: 4.2, side: 3.6, above: 4.6 }; // distances in lengths of the rover

// Whether a picture is made by the processor: then no smooth edges, and no more points than the element has.
function bySoftware() {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) throw new Error('no WebGL 2');
  const told = gl.getExtension('WEBGL_debug_renderer_info'), name = told ? gl.getParameter(told.UNMASKED_RENDERER_WEBGL) : '';
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

// drive: openDrive; host: the element to fill; foot, toWorld, trackRows: of replay/data.js; still: no camera that swings. Throws without WebGL.
export function open({ drive, host, palette, foot, toWorld, trackRows, still }) {
  const software = bySoftware();
  ColorManagement.enabled = false; // colours are what the page says; without a power law for each point of the picture
  const renderer = new WebGLRenderer({ antialias: !software });
  const finest = software ? 1 : Math.min(2, devicePixelRatio);
  let ratio = finest;
  renderer.setPixelRatio(ratio);
  renderer.outputColorSpace = LinearSRGBColorSpace;
  const canvas = renderer.domElement;
  canvas.setAttribute('role', 'img');
  canvas.setAttribute('aria-label', 'The rover on its ground in three dimensions, its wheels\' tracks coloured, forces as arrows');
  host.replaceChildren(canvas);

  const world = new Scene(), camera = new PerspectiveCamera(40, 1, 0.02, 400);
  camera.up.set(0, 0, 1);
  const sun = new DirectionalLight(0xffffff, 1.6);
  sun.position.set(-2, -3, 5);
  world.add(new AmbientLight(0xffffff, 1.9), sun);
  const origin = drive.pose(drive.t0), at = (p) => ({ ...p, x: p.x - origin.x, y: p.y - origin.y });
  const shared = { drive, foot: (i, pose) => foot(drive, i, at(pose)), toWorld: (pose, point) => toWorld(at(pose), drive.rover.halves, point), trackRows: (i) => trackRows(drive, i), palette };
  const land = ground(shared), trail = tracks(shared), push = arrows(shared), rover = roverOf(drive, palette), ghost = ghostOf(drive, palette), place = new Group();
  place.add(rover.node);
  world.add(land.node, trail.node, push.node, place, ghost);

  const state = { view: 'behind', around: 0, tilt: 0, near: 1, forces: true, ghost: true };
  let heading = null, drawnAt = 0, shownAt = 0;
  const target = new Vector3(), angle = (a) => Math.atan2(Math.sin(a), Math.cos(a));

  function look(pose, t, now) {
    const size = drive.rover.length_m, { box } = land;
    if (heading === null || still || Math.abs(t - shownAt) > 0.5) heading = still ? origin.yaw : pose.yaw;
    else heading += angle(pose.yaw - heading) * (1 - Math.exp(-Math.min(1, Math.max(0, now - drawnAt) / 1000) / 0.7)); // follows within 0.7 s
    [drawnAt, shownAt] = [now, t];
    const whole = state.view === 'whole', behind = state.view === 'behind';
    const base = behind ? heading + Math.PI + 0.35 : whole ? -Math.PI / 2 : state.view === 'side' ? -Math.PI / 2 + heading : -Math.PI / 2;
    const rise = { behind: 0.42, side: 0.2, above: 1.45, whole: 0.8 }[state.view];
    const far = (whole ? 1.15 * Math.max(box.long, 6 * size) / Math.min(1.4, Math.max(0.5, camera.aspect)) : FAR[state.view] * size * Math.max(1, 1.1 / camera.aspect)) / state.near;
    const around = base + state.around, tilt = Math.min(1.54, Math.max(0.03, rise + state.tilt));
    if (whole) target.set(box.x, box.y, 0);
    else target.set(pose.x - origin.x, pose.y - origin.y, pose.z);
    camera.position.set(target.x + far * Math.cos(tilt) * Math.cos(around), target.y + far * Math.cos(tilt) * Math.sin(around), target.z + far * Math.sin(tilt));
    camera.near = Math.max(0.005, far / 50);
    camera.far = far * 12 + 2 * box.long;
    camera.updateProjectionMatrix();
    camera.lookAt(target);
  }

  function fit() {
    const width = Math.max(1, host.clientWidth), height = Math.max(1, host.clientHeight), now = renderer.getSize(new Vector2());
    if (now.x === width && now.y === height) return;
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
  }

  // The picture at time t. Answers where it has the rover, out of its own matrices.
  function draw(t, now) {
    fit();
    const pose = drive.pose(t);
    rover.put(at(pose), t);
    land.under(pose.x - origin.x, pose.y - origin.y);
    const shade = state.ghost && drive.ghost(t);
    ghost.visible = Boolean(shade);
    if (shade) ghostPut(pose, shade);
    trail.until(t);
    push.put(pose, t, state.forces);
    look(pose, t, now);
    renderer.render(world, camera);
    const e = rover.node.matrixWorld.elements;
    return { x: e[12] + origin.x, y: e[13] + origin.y, z: e[14], yaw: pose.yaw + angle(Math.atan2(e[1], e[0]) - pose.yaw) };
  }
  function ghostPut(pose, shade) {
    ghost.position.set(shade.x - origin.x, shade.y - origin.y, pose.z);
    ghost.rotation.set(pose.roll, pose.pitch, shade.yaw, 'ZYX');
  }
  function recolour(colours) {
    Object.assign(palette, colours);
    world.background = new Color(drive.level ? palette.soft : palette.paper);
    for (const part of [land, push, rover]) part.recolour?.();
    ghost.material.color.set(palette.model);
  }
  recolour(palette);

  const view = { kind: '3d', software, draw, recolour,
    set(change) {
      if (change.view && change.view !== state.view) Object.assign(state, { around: 0, tilt: 0, near: 1 }), heading = null;
      if (change.scale && change.scale !== state.scale) trail.colour(change.scale);
      Object.assign(state, change);
    },
    // While it plays and pictures come slower than 33 a second, they get coarser, down to 0.7 of the points along a side; at rest, fine again.
    pace(perSecond) {
      const wanted = perSecond === null ? finest : perSecond < 33 ? Math.max(0.7 * finest, 0.85 * ratio) : perSecond > 50 ? Math.min(finest, ratio / 0.9) : ratio;
      if (Math.abs(wanted - ratio) < 1e-3) return;
      ratio = wanted;
      renderer.setPixelRatio(ratio);
    },
    turn(around, tilt) { state.around += around; state.tilt = Math.min(1.5, Math.max(-1.5, state.tilt + tilt)); },
    zoom(by) { state.near = Math.min(8, Math.max(0.15, state.near * by)); },
    dispose() { renderer.dispose(); renderer.forceContextLoss(); canvas.remove(); },
  };
  canvas.addEventListener('webglcontextlost', (event) => { event.preventDefault(); if (canvas.isConnected) view.onLost?.(); });
  return view;
}
