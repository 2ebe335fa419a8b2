// result.js - the result of a run: the same story as the report page.
import { check } from '../check.js';
import { h, markScrollers } from '../dom.js';
import { driveLog } from '../drive.js';
import { lab } from '../lab.js';
import { closeDrive } from '../replay/section.js';
import { forget } from '../timeplots.js';
import { bringScene, get } from './link.js';
import { showable } from './history.js';
import { choose, chosen, now, onChange } from './shared.js';

export function result() {
  let drawn = 0, wanted = 0;
  const place = h('div', { id: 'result', tabindex: -1, 'aria-live': 'off' });
  async function show(id) {
    wanted = id;
    let answer;
    try {
      answer = await get(`/api/result/${id}`);
      if (answer.replay) await bringScene();
    } catch (error) {
      if (wanted === id) { wanted = 0; place.replaceChildren(h('p', { class: 'wrong' }, `Number ${id} cannot be shown: ${error.message}`)); }
      return;
    }
    if (wanted !== id) return; // another one was asked for meanwhile
    forget();
    closeDrive();
    const { parts, then } = ({ 'traction.check/1': check, 'traction.look/1': driveLog }[answer.schema] ?? lab)(answer);
    const sections = parts.filter(Boolean);
    place.replaceChildren(h('h1', {}, answer.title ?? `check: ${answer.log}`), h('nav', { 'aria-label': 'Contents of the result' }, h('ul', {}, sections.filter((p) => p.id && p.dataset.short).map((p) => h('li', {}, h('a', { href: `#${p.id}` }, p.dataset.short))))),
      ...sections, h('p', {}, h('button', { type: 'button', onclick: () => save(answer, id) }, 'Save the data (JSON)')));
    then?.();
    markScrollers(place);
    drawn = id;
    place.dataset.run = id;
  }
  onChange(() => {
    const last = now.history.filter((e) => showable(e) && e.state === 'done').at(-1);
    if (chosen.follow && last && chosen.shown !== last.id) return choose({ shown: last.id });
    if (chosen.shown && chosen.shown !== drawn && chosen.shown !== wanted && now.history.some((e) => e.id === chosen.shown)) show(chosen.shown);
    return undefined;
  });
  return place;
}

function save(answer, id) {
  const address = URL.createObjectURL(new Blob([JSON.stringify(answer, null, 1)], { type: 'application/json' }));
  h('a', { href: address, download: `result_${id}.json` }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}
