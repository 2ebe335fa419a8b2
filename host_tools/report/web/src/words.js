// words.js - numbers, intervals and verdicts as people read them.

export const isNumber = (x) => typeof x === 'number' && Number.isFinite(x);
export const list = (x) => (Array.isArray(x) ? x : []);

export function num(x, digits = 3) {
  if (!isNumber(x)) return '–';
  if (x === 0) return '0';
  const size = Math.abs(x);
  if (size >= 1e6 || size < 1e-4) return x.toExponential(Math.max(0, digits - 1)).replace('-', '−').replace('e+', 'e');
  return fixed(x, digits - 1 - Math.floor(Math.log10(size)));
}

// with so many decimals at most; 2.50 reads 2.5
function fixed(x, decimals) {
  const text = x.toFixed(Math.min(12, Math.max(0, decimals)));
  const short = text.includes('.') ? text.replace(/\.?0+$/, '') : text;
  return (short === '-0' ? '0' : short).replace('-', '−');
}

// for a column: the same decimals in every row
export const even = (x, decimals) => (isNumber(x) && Math.abs(x) < 1e5 ? x.toFixed(decimals).replace('-', '−') : num(x));

export const percent = (x) => (isNumber(x) ? `${Math.abs(x) < 5e-4 ? '0' : num(100 * x, 2)}\u00a0%` : '–');
export const unitText = (u) => String(u ?? '').replace(/\^2/g, '²').replace(/\^3/g, '³').replaceAll(' ', '\u00a0');
export const unit = (u) => (u && u !== '1' ? `\u00a0${unitText(u)}` : '');

// times to a fiftieth of the stretch they bound
export function seconds(a, b) {
  const decimals = b > a ? 1 - Math.floor(Math.log10((b - a) / 2)) : 3;
  return isNumber(a) && isNumber(b) ? `${fixed(a, decimals)}–${fixed(b, decimals)} s` : '–';
}

// 0.15 [0.13 to 0.17] N m
export function sized(p) {
  if (!p) return '–';
  if (!isNumber(p.low) || !isNumber(p.high) || !(p.high > p.low)) return `${num(p.value)}${unit(p.unit)}`;
  // two digits of the interval's half width are worth reading
  const decimals = 1 - Math.floor(Math.log10((p.high - p.low) / 2));
  const write = (x) => (decimals > 7 || !isNumber(x) || Math.abs(x) >= 1e6 ? num(x) : fixed(x, decimals));
  return `${write(p.value)} [${write(p.low)} to ${write(p.high)}]${unit(p.unit)}`;
}

export const parameters = (ps) => Object.entries(ps ?? {}).map(([name, p]) => `${name} = ${sized(p)}`);

export function variant(v) {
  return Object.entries(v ?? {}).map(([name, value]) => `${name} = ${isNumber(value) ? num(value) : value}`).join(', ');
}

export function effectName(c) {
  return (c.effect ?? c.name ?? '') + (isNumber(c.wheel) && c.wheel >= 0 ? ` (wheel ${c.wheel})` : '');
}

// mark: readable without colour
const verdicts = {
  named: ['✔', 'named'],
  class: ['≈', 'cannot be told apart'],
  not_significant: ['·', 'not significant'],
  too_small: ['·', 'too small to matter'],
  beyond_range: ['·', 'only beyond its range'],
  wrong_sign: ['✘', 'unphysical sign'],
  not_excited: ['?', 'this log cannot show it'],
};
export function candidateVerdict(c) {
  const [mark, words] = verdicts[c.verdict] ?? ['', String(c.verdict ?? '–').replaceAll('_', ' ')];
  return `${mark} ${words}${c.verdict === 'class' && isNumber(c.class) ? ` (class ${c.class})` : ''}`;
}

const kinds = {
  named: 'An effect is named',
  class: 'One of several, which this log cannot tell apart',
  partial: 'An effect is named, but explains only a part',
  unknown: 'None of the known effects',
  nothing: 'Nothing to find',
};
export const verdictKind = (v) => kinds[v.kind] ?? v.kind;

// "error 3.1 × noise floor: there is something to find"; 1.1: half of what the noise of two runs can move the ratio by, *assumed*
export function scoreLine(score) {
  if (!score) return '';
  const ratio = isNumber(score.ratio) ? score.ratio : score.error / score.floor;
  if (!isNumber(ratio)) return score.verdict ?? `error ${num(score.error)}, noise floor unknown`;
  const words = score.verdict || (ratio > 1.1 ? 'there is something to find' : 'nothing to find');
  return words.includes('noise floor') ? words : `error ${num(ratio)} × noise floor: ${words}`;
}
