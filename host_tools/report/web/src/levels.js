// levels.js - which rows of a long series are drawn at a zoom: at most a few for each bin of the screen, the extremes always among them.
// Pure functions, tested by themselves (tests/e2e/report/levels_test.mjs): no point is drawn that is not in the data, no extreme is lost.

// Indices of rows to draw between the times `from` and `to`: all of them where they are few, else for each of `bins` equal parts of the
// time the first, the last, and the lowest and highest of each column. The row before and the row after stand at the ends, so that lines
// leave the picture. `t` rises; a null in a column is passed over.
export function thin(t, columns, from, to, bins) {
  let first = lowerBound(t, from), last = lowerBound(t, to);
  while (last < t.length && t[last] <= to) ++last;
  first = Math.max(0, first - 1);
  last = Math.min(t.length, last + 1);
  if (last - first <= 2 * bins) return range(first, last);
  const kept = [first];
  let begin = first + 1;
  const width = (to - from) / bins;
  for (let bin = 0; bin < bins && begin < last - 1; ++bin) {
    const edge = bin + 1 === bins ? Infinity : from + (bin + 1) * width;
    let end = begin;
    while (end < last - 1 && t[end] < edge) ++end;
    if (end === begin) continue;
    const here = new Set([begin, end - 1]);
    for (const column of columns) {
      let low = -1, high = -1;
      for (let i = begin; i < end; ++i) {
        if (column[i] == null) continue;
        if (low < 0 || column[i] < column[low]) low = i;
        if (high < 0 || column[i] > column[high]) high = i;
      }
      if (low >= 0) here.add(low).add(high);
    }
    kept.push(...[...here].sort((a, b) => a - b));
    begin = end;
  }
  kept.push(last - 1);
  return [...new Set(kept)];
}

// The rows of `indices` as columns for a plot, with an empty row wherever a gap lies between two of them: lines end there. `breaks` holds,
// rising, the index of the first row after each gap.
export function drawn(t, columns, indices, breaks) {
  const out = [[], ...columns.map(() => [])];
  let next = 0;
  indices.forEach((i, k) => {
    if (k > 0) {
      while (next < breaks.length && breaks[next] <= indices[k - 1]) ++next;
      if (next < breaks.length && breaks[next] <= i) {
        out[0].push((t[breaks[next] - 1] + t[breaks[next]]) / 2);
        columns.forEach((_, c) => out[c + 1].push(null));
      }
    }
    out[0].push(t[i]);
    columns.forEach((column, c) => out[c + 1].push(column[i]));
  });
  return out;
}

// Index of the first row after each gap of { t0_s, t1_s }.
export function breaksOf(t, gaps) {
  return gaps.map((g) => lowerBound(t, (g.t0_s + g.t1_s) / 2)).filter((i) => i > 0 && i < t.length);
}

// Rows that stand alone between two gaps: a line cannot show them, so they get a dot.
export function alone(column) {
  const out = [];
  for (let i = 0; i < column.length; ++i)
    if (column[i] != null && column[i - 1] == null && column[i + 1] == null) out.push(i);
  return out;
}

function range(from, to) {
  return Array.from({ length: Math.max(0, to - from) }, (_, i) => from + i);
}

// first index with t[index] >= value
function lowerBound(t, value) {
  let low = 0, high = t.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (t[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}
