// bench.js - the folder's logs and models, the buttons of the lab, and how far what runs is.
import { h } from '../dom.js';
import { drawing } from '../effects.js';
import { post } from './link.js';
import { busy, choose, chosen, clock, effectOptions, fill, now, of, onChange, onWheel, saying, size, wheels } from './shared.js';

// A list of radio buttons: arrows move in it, and it is built anew only where it changed.
function choice(id, title, about, rowsOf, pick) {
  const list = h('div', { class: 'choice', role: 'radiogroup', 'aria-label': title });
  const node = h('div', { id }, h('h3', {}, title), h('p', { class: 'quiet' }, about), list);
  return [node, () => {
    const rows = rowsOf(), text = JSON.stringify(rows);
    if (list.dataset.rows !== text) {
      const focused = list.contains(document.activeElement) ? document.activeElement.value : null;
      list.dataset.rows = text;
      list.replaceChildren(...(rows.length ? rows.map((r) => h('label', { class: r.bad && 'bad' },
        h('input', { type: 'radio', name: id, value: r.key, disabled: !!r.bad, onchange: () => pick(r.key) }),
        h('span', {}, r.name, r.badge && [' ', h('span', { class: 'badge' }, r.badge)], h('span', { class: 'quiet' }, r.quiet))))
        : [h('p', { class: 'quiet' }, 'none yet')]));
      if (focused !== null) [...list.querySelectorAll('input')].find((i) => i.value === focused)?.focus();
    }
    return list;
  }];
}

function mark(list, value) {
  const inputs = [...list.querySelectorAll('input')], chosenOne = inputs.find((i) => i.value === value);
  inputs.forEach((i) => { i.checked = i === chosenOne; });
  if (list.dataset.seen === value || !chosenOne) return;
  list.dataset.seen = value;
  list.scrollTop = Math.max(0, chosenOne.closest('label').offsetTop - list.offsetTop - 60);
}

function logs() {
  const all = of('log', 'foreign').sort((a, b) => b.changed_ms - a.changed_ms);
  return all.map((f) => ({ key: f.name, name: f.name, badge: f.growing ? 'growing' : f.kind === 'foreign' ? 'needs a map' : '', quiet: `${size(f.bytes)}, ${clock(f.changed_ms)}` }));
}

const effectsOf = (f) => (f?.about?.effects ?? []).map((e) => e.name + onWheel(e));
function models() {
  const all = of('model').sort((a, b) => a.name.startsWith('shipped/') - b.name.startsWith('shipped/') || b.changed_ms - a.changed_ms);
  return all.map((f) => ({ key: f.name, name: f.name.replace('shipped/', ''), badge: f.name.startsWith('shipped/') ? 'shipped' : '', bad: f.about?.trouble,
    quiet: f.about?.trouble ?? `${f.about?.title ?? ''}${effectsOf(f).length ? `, with ${effectsOf(f).join(', ')}` : ''}` }));
}

// What was chosen may be gone; what was never chosen is the newest log and, as long as there is none of one's own, the rover on sand.
function settle() {
  if (!now.files.length) return; // the folder was not heard of yet: what a reload kept stays
  const log = of('log', 'foreign').some((f) => f.name === chosen.log) ? chosen.log : logs()[0]?.key ?? null;
  const good = of('model').filter((f) => !f.about?.trouble), has = (name) => good.some((f) => f.name === name);
  const model = has(chosen.model) ? chosen.model : ['shipped/rover_sand.toml', good[0]?.name].find(has) ?? null;
  if (log !== chosen.log || model !== chosen.model) choose({ log, model });
}

export function bench() {
  const [logNode, drawLogs] = choice('logs', 'Log', 'CSV files of the folder; new ones appear by themselves.', logs, (log) => choose({ log }));
  const [modelNode, drawModels] = choice('models', 'Model', 'Nothing of yours is written over: a better model is a new file.', models, (model) => choose({ model }));
  const map = h('select', { id: 'map', onchange: () => choose({ map: map.value }) });
  const mapRow = h('p', {}, h('label', { for: 'map' }, 'Map for a foreign CSV '), map);
  logNode.append(mapRow);
  const [wrong, tried] = saying();
  const add = h('select', { id: 'effect' }), addWheel = h('select', { id: 'wheel' }), drop = h('select', { id: 'drop' });
  fill(addWheel, wheels, '-1');
  const run = (verb, more = {}) => tried(async () => {
    choose({ follow: true });
    await post('/api/run', { verb, log: chosen.log, ...(chosen.model && { model: chosen.model }), ...(chosen.map && { map: chosen.map }), ...more });
  });
  const button = (words, title, work, kind) => h('button', { type: 'button', class: kind, title, onclick: work }, words);
  const buttons = [button('Check', 'is this log fit to learn from?', () => run('check')), button('Look', 'the drive, played again: where the rover went, how it slipped', () => run('look')), button('Compare', 'how far is the model from the log, and where?', () => run('compare')),
    button('Diagnose', 'which physics does the model lack?', () => run('diagnose'), 'main'), button('Next drive', 'the drive that answers what this log left open', () => run('next'))];
  const addButton = button('Add', 'a new model with this effect, fitted', () => run('add', { effect: add.value, wheel: +addWheel.value }));
  const dropButton = button('Drop', 'a new model without this effect', () => { const [effect, wheel] = drop.value.split(' on wheel '); return run('drop', { effect, ...(wheel !== undefined && { wheel: +wheel }) }); });
  const drawn = h('p', { id: 'drawn', class: 'quiet' });
  const draw = () => {
    const e = now.effects.find((one) => one.name === add.value);
    if (drawn.dataset.effect === (e?.name ?? '')) return;
    drawn.dataset.effect = e?.name ?? '';
    drawn.replaceChildren(...(e ? [drawing(e.name), `${e.title}. ${e.signature}`].filter(Boolean) : []));
  };
  add.addEventListener('change', draw);
  const hint = h('p', { class: 'hint', id: 'hint', hidden: true }), bar = h('progress', { max: 1, 'aria-label': 'how far it is' }), words = h('span', { role: 'status' });
  const stop = button('Cancel', 'end it; nothing half-written stays', () => tried(() => post('/api/cancel', { id: busy('lab')?.id })));
  const progress = h('p', { class: 'running', id: 'running', hidden: true }, bar, ' ', words, ' ', stop);
  const node = h('section', { id: 'bench', 'data-short': 'Run the lab' }, h('h2', {}, 'Log and model'), h('div', { class: 'bench' }, logNode, modelNode),
    h('div', { class: 'controls' }, h('p', {}, buttons.flatMap((b) => [b, ' '])),
      h('p', {}, h('label', { for: 'effect' }, 'Effect '), add, ' ', h('label', { for: 'wheel', class: 'hidden' }, 'on which wheel'), addWheel, ' ', addButton), drawn,
      h('p', { id: 'dropping' }, h('label', { for: 'drop' }, 'In the model '), drop, ' ', dropButton)),
    hint, progress, wrong);

  onChange(() => {
    settle();
    mark(drawLogs(), chosen.log);
    mark(drawModels(), chosen.model);
    const maps = of('map');
    fill(map, [['', 'none'], ...maps.map((f) => [f.name, f.name.replace('shipped/', '')])], maps.some((f) => f.name === chosen.map) ? chosen.map : '');
    mapRow.hidden = !of('foreign').some((f) => f.name === chosen.log);
    fill(add, effectOptions());
    draw();
    const inside = effectsOf(of('model').find((f) => f.name === chosen.model));
    fill(drop, inside.map((name) => [name, name]));
    drop.closest('p').hidden = !inside.length;
    const running = busy('lab'), off = !now.connected || !!running;
    for (const b of [...buttons, addButton, dropButton]) b.disabled = off || !chosen.log;
    buttons.slice(2).concat(addButton).forEach((b) => { b.disabled ||= !chosen.model; });
    progress.hidden = !running;
    if (running) {
      const known = running.total > 0 && running.done <= running.total;
      if (known) bar.value = running.done / running.total; else bar.removeAttribute('value');
      words.textContent = running.words || running.verb;
      stop.disabled = !now.connected;
    }
    // what the last diagnosis of this pair named and the model has not yet
    const last = now.history.filter((e) => e.verb === 'diagnose' && e.log === chosen.log && e.model === chosen.model && e.state === 'done').at(-1);
    const named = (last?.named ?? []).find((n) => !inside.includes(n.effect + onWheel(n)));
    const key = named ? named.effect + onWheel(named) : '';
    if (hint.dataset.key !== key) {
      hint.dataset.key = key;
      hint.replaceChildren(...(named ? [`The diagnosis names ${key}. `, button(`Add ${key}`, 'a new model with it, fitted', () => run('add', { effect: named.effect, wheel: named.wheel ?? -1 }), 'main')] : []));
    }
    hint.hidden = !named;
    hint.querySelectorAll('button').forEach((b) => { b.disabled = off; });
  });
  return node;
}
