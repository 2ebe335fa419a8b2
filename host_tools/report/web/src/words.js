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

// mark: readable without colour; the words are the lab's own (candidates[].words)
const marks = { named: '✔', class: '≈', nearest: '≈', wrong_sign: '✘', not_excited: '?' };
export function candidateVerdict(c) {
  return `${marks[c.verdict] ?? '·'} ${c.words || String(c.verdict ?? '–').replaceAll('_', ' ')}`;
}

const kinds = {
  named: 'What is missing was found',
  class: 'One of several is missing, and this log cannot tell which',
  partial: 'A part of what is missing was found',
  unknown: 'Something is missing that is in no catalogue',
  nothing: 'Nothing was found to be missing',
  wrong_model: 'The numbers of the model are wrong',
};
export const verdictKind = (v) => kinds[v.kind] ?? v.kind ?? 'Verdict';
