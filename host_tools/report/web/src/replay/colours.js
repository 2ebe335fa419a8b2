// colours.js - what the ground is coloured by, along each wheel's track.

// Blue below, grey in the middle, orange to red above; told apart by people who see no red or no green.
const SLIP = [[-1, [33, 102, 172]], [-0.5, [103, 169, 207]], [0, [150, 150, 150]], [0.5, [239, 138, 60]], [1, [178, 24, 43]]];
const RISING = [[0, [150, 150, 150]], [0.5, [239, 138, 60]], [1, [178, 24, 43]]];
const UNKNOWN = [110, 110, 110];

function along(stops, share) {
  if (Number.isNaN(share)) return UNKNOWN;
  const x = Math.min(stops.at(-1)[0], Math.max(stops[0][0], share));
  const i = Math.max(1, stops.findIndex(([at]) => at >= x)), [a, low] = stops[i - 1], [b, high] = stops[i];
  return low.map((v, k) => Math.round(v + ((x - a) / (b - a)) * (high[k] - v)));
}

const gradient = (stops) => `linear-gradient(to right, ${stops.map(([, c]) => `rgb(${c})`).join(', ')})`;

// The scales that this drive's log can fill: { key, name, low, high, css, of(wheel, row) -> [r, g, b] }.
export function scalesOf(drive) {
  const each = (name) => drive.rover.wheel.map((_, i) => drive.values(`wheel${i}.${name}`)), out = [];
  const slip = each('slip'), traction = each('traction_N'), normal = each('normal_N'), sinkage = each('sinkage_m');
  if (slip.some(Boolean))
    out.push({ key: 'slip', name: 'slip', low: '−0.6', high: '0.6', css: gradient(SLIP), of: (i, row) => along(SLIP, (slip[i]?.[row] ?? NaN) / 0.6) });
  if (traction.some(Boolean) && normal.some(Boolean)) {
    const grip = (i, row) => { const load = normal[i]?.[row]; return load > 0.05 ? Math.abs(traction[i]?.[row] ?? NaN) / load : NaN; };
    out.push({ key: 'grip', name: 'grip in use (traction over load)', low: '0', high: '0.8', css: gradient(RISING), of: (i, row) => along(RISING, grip(i, row) / 0.8) });
  }
  const deepest = sinkage.reduce((most, v) => (v ?? []).reduce((m, x) => (x > m ? x : m), most), 0);
  if (deepest > 1e-4)
    out.push({ key: 'sinkage', name: 'sinkage', low: '0 mm', high: `${(1000 * deepest).toPrecision(2)} mm`, css: gradient(RISING), of: (i, row) => along(RISING, (sinkage[i]?.[row] ?? NaN) / deepest) });
  if (!out.length) out.push({ key: 'none', name: 'nothing: the log has no slip', low: '', high: '', css: gradient([[0, UNKNOWN], [1, UNKNOWN]]), of: () => UNKNOWN });
  return out;
}
