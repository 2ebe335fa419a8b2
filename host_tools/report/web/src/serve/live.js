// live.js - plots that grow while a rover drives, a simulated one or one that is watched: columns of rows as they come.
import uPlot from 'uplot';
import { h } from '../dom.js';
import { axis, css } from '../timeplots.js';
import { isNumber, num } from '../words.js';

const strokes = ['--residual', '--model', '--good', '--p3'], dashes = [[], [6, 3], [2, 3], [10, 3, 2, 3]];
const wheelNames = ['rear left', 'rear right', 'front left', 'front right'];
// the first columns of `simulate --live -` and `drive --live -`: time, speed, four slips, four currents
export const motion = [{ title: 'Ground speed, as the firmware knows it', unit: 'm/s', from: 1, count: 1, label: 'speed' }, { title: 'Slip of each wheel', unit: '1', from: 2, count: 4 },
  { title: 'Current of each motor', unit: 'A', from: 6, count: 4 }];

// `plots` as `motion`, over rows of `width` cells, in `place`; drawn only while `box` is open. `drawn`: rows that `keep` refuses are in no plot.
export function livePlots(place, box, key, plots, width, keep = () => true) {
  let columns = Array.from({ length: width }, () => []), id = 0, got = 0, made = [], due = false, last = null;
  const data = (p) => [columns[0], ...columns.slice(p.from, p.from + p.count)];
  const broad = () => Math.max(260, place.clientWidth);

  function draw() {
    due = false;
    if (!box.open || !columns[0].length) return;
    if (made.length) made.forEach((u, i) => u.setData(data(plots[i])));
    else {
      place.replaceChildren();
      made = plots.map((p) => {
        const host = h('div', {}), final = p === plots.at(-1);
        place.append(h('figure', { 'aria-label': p.title }, h('figcaption', {}, `${p.title} [${p.unit}]`), host));
        return new uPlot({ width: broad(), height: final ? 170 : 140, pxAlign: 0, scales: { x: { time: false } }, cursor: { sync: { key }, drag: { x: false, y: false } },
          legend: { live: true }, axes: [axis(final ? 'time [s]' : undefined, 26, 50), axis(undefined, 50, 26)],
          series: [{ label: 'time [s]', value: (_, v) => num(v, 4) }, ...Array.from({ length: p.count }, (_, i) => ({ label: p.label ?? wheelNames[i], stroke: () => css(strokes[i]), dash: dashes[i],
            width: 1.3, points: { show: false }, value: (_u, v) => num(v, 3) }))] }, data(p), host);
      });
    }
    place.dataset.rows = columns[0].length;
  }
  const soon = () => { if (!due) { due = true; requestAnimationFrame(draw); } };
  new ResizeObserver(() => made.forEach((u) => u.setSize({ width: broad(), height: u.height }))).observe(place);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => made.forEach((u) => u.redraw(false)));
  box.addEventListener('toggle', soon);
  return {
    id: () => id,
    time: () => columns[0].at(-1),
    last: () => last,
    push(news) {
      if (news.id !== id || news.from === 0) { id = news.id; got = 0; last = null; columns = columns.map(() => []); }
      if (news.from > got) return; // never: what is missing comes again from its beginning
      for (const row of news.rows.slice(got - news.from)) {
        got += 1;
        last = row;
        if (keep(row)) columns.forEach((c, i) => c.push(isNumber(row[i]) ? row[i] : null));
      }
      soon();
    },
  };
}
