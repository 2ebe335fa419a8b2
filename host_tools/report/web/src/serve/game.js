// game.js - the sealed game: a log with one hidden effect, guesses, and the seal at the end. The answer is not in the page before.
import { h, table } from '../dom.js';
import { even, list } from '../words.js';
import { post } from './link.js';
import { busy, choose, effectOptions, fill, now, onChange, saying, wheels } from './shared.js';

export function game() {
  const soil = h('select', { id: 'soil' }), hard = h('input', { type: 'checkbox', id: 'hard' }), guess = h('select', { id: 'guess' }), wheel = h('select', { id: 'guess-wheel' });
  fill(soil, ['sand', 'gravel', 'concrete'].map((s) => [s, s]));
  fill(wheel, wheels, '-1');
  const [wrong, tried] = saying();
  const button = (words, verb, more, kind) => h('button', { type: 'button', class: kind, onclick: () => tried(async () => { choose({ follow: true }); await post('/api/run', { verb, ...more?.() }); }) }, words);
  const fresh = button('New game', 'game_new', () => ({ soil: soil.value, hard: hard.checked })), what = () => ({ effect: guess.value, wheel: +wheel.value });
  const look = button('Look', 'game_look'), try_ = button('Try it', 'game_guess', what), keep = button('Keep it', 'game_add', what, 'main'), open = button('Open the seal', 'game_open');
  const state = h('div', { id: 'game-state' }), said = h('pre', { tabindex: 0, role: 'group', 'aria-label': 'what the game says', hidden: true });
  const playing = h('div', { class: 'controls', id: 'playing', hidden: true }, h('p', {}, h('label', { for: 'guess' }, 'Your guess '), guess, ' ', h('label', { for: 'guess-wheel', class: 'hidden' }, 'on which wheel'), wheel),
    h('p', {}, [look, try_, keep, open].flatMap((b) => [b, ' '])));
  const box = h('details', { id: 'game', class: 'tool', 'data-short': 'Game' }, h('summary', {}, 'A game: find the hidden effect'),
    h('p', { class: 'quiet' }, 'A rover drove for two minutes. One thing about it is not in the model. Look, guess, watch the error, open the seal.'),
    h('div', { class: 'controls' }, h('p', {}, h('label', { for: 'soil' }, 'Ground '), soil, ' ', h('label', {}, hard, ' any effect of the catalogue '), fresh)), playing, wrong, state, said);
  onChange(() => {
    const g = now.game, off = !now.connected || !!busy('lab');
    for (const b of [fresh, look, try_, keep, open]) b.disabled = off;
    fill(guess, effectOptions());
    playing.hidden = !g || g.opened;
    const key = JSON.stringify(g);
    if (state.dataset.key !== key) {
      state.dataset.key = key;
      state.replaceChildren(...(g ? [
        g.opened ? h('p', { class: 'verdict', id: 'opened' }, `The seal is open: ${g.hidden}. ${g.points} of 100 points.`) : h('p', {}, `A game is on, on ${g.soil}: the seal is closed.`),
        table('Ladder: held-out error as a multiple of the sensor noise', [{ head: 'model' }, { head: 'error', number: true }], list(g.ladder).map((s) => [s.label, even(s.heldout, 2)])),
        list(g.guesses).length ? table('Guesses', [{ head: 'effect' }, { head: 'before', number: true }, { head: 'after', number: true }, { head: 'in the model' }],
          list(g.guesses).map((s) => [s.label, even(s.before, 2), even(s.after, 2), s.added ? 'kept' : 'only tried'])) : ''] : []));
    }
    const last = now.history.filter((e) => e.verb.startsWith('game') && e.text && e.verb !== 'game_look').at(-1);
    said.hidden = !last || !g;
    said.textContent = last?.text.replace(/the truth is sealed in .*sealed\.json/, 'the truth is sealed').replace(/\nNext: traction game[^\n]*/, '') ?? '';
  });
  return box;
}
