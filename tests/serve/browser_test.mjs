// browser_test.mjs CHROMIUM TRACTION FOLDER SHOTS_DIR - the whole story of `traction serve`, clicked in a real browser: a simulated rover
// drives, its log is checked and diagnosed, what was named is added, the error falls; two browsers, a reload, a server that goes and comes
// back; a sealed game; three widths, light and dark, by keyboard alone, with axe-core.
import assert from 'node:assert/strict';
import { appendFileSync, copyFileSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { anew, begin, click, launch, nothingIsAmiss, open as openPage, pictures, ready, serve, tryAll, until } from './page.mjs';

const [executablePath, traction, folder, shots] = process.argv.slice(2);
const browser = await begin(executablePath, folder, shots, ['--disable-gpu']);
let server = await serve(traction, folder);
const trouble = [];
const open = (settings) => openPage(browser, () => server.address, trouble, settings);
const picture = pictures(shots);
const title = (page, begin) => until(page, (words) => document.querySelector('#result h1')?.textContent.startsWith(words), begin);
const newest = (page) => page.$eval('#history tbody tr', (e) => e.textContent);
const chosen = (page, list) => page.$eval(`#${list} input:checked`, (e) => e.value);

const claims = [];
const claim = (name, check) => claims.push([name, check]);
const { page } = await open();
const { page: other } = await open();

claim('an empty folder: the page says where to begin, and the rover is open', async () => {
  assert.match(await page.textContent('#logs'), /none yet/);
  assert.match(await page.textContent('#history'), /Nothing was run yet/);
  assert.ok(await page.isVisible('#drive-effect'));
  assert.ok(await page.isDisabled('#bench button:text-is("Diagnose")'));
});

claim('a drive at the pace of the clock grows before the eyes of both, and is stopped by the other browser', async () => {
  await page.fill('#seconds', '60');
  await page.check('#realtime');
  await click(page, '#simulated', 'Start the drive');
  for (const p of [page, other]) await until(p, () => +document.querySelector('#live').dataset.rows > 15);
  const rows = await page.$eval('#live', (e) => +e.dataset.rows);
  await until(page, (n) => +document.querySelector('#live').dataset.rows > n + 8, rows);
  assert.equal((await page.$$('#live canvas')).length, 3); // speed, slip, current
  assert.match(await page.textContent('#driving'), /Driving: [\d.]+ s driven/);
  await picture(page, 'driving');
  await click(other, '#simulated', 'Stop');
  await until(page, () => /The drive ended after/.test(document.querySelector('#driving').textContent));
  assert.match(await newest(page), /simulated drive.*cancelled/);
  await page.waitForSelector('#logs input[value="identification_1.csv"]');
});

claim('a drive with an effect: its log is chosen when it ends', async () => {
  await page.uncheck('#realtime');
  await page.fill('#seconds', '40');
  await page.selectOption('#scenario', 'shipped/demo_sand.toml');
  await page.selectOption('#drive-effect', 'slip_sinkage');
  await click(page, '#simulated', 'Start the drive');
  for (const p of [page, other]) await until(p, () => document.querySelector('#logs input:checked')?.value === 'demo_sand_1.csv');
  assert.equal(await chosen(page, 'models'), 'shipped/rover_sand.toml');
});

claim('check, compare, diagnose, add: the error falls, in both browsers', async () => {
  await click(page, '#bench', 'Check');
  await title(page, 'check');
  assert.match(await newest(page), /fit to learn from/);
  await click(page, '#bench', 'Compare');
  await title(page, 'compare');
  await click(page, '#bench', 'Diagnose');
  await page.waitForSelector('#running:not([hidden])');
  await until(other, () => /diagnose: \d+/.test(document.querySelector('#running').textContent)); // the verb's own progress, there too
  await title(page, 'diagnose');
  await title(other, 'diagnose');
  assert.match(await page.textContent('#verdict'), /slip_sinkage explains it/);
  assert.match(await page.textContent('#hint'), /The diagnosis names slip_sinkage/);
  await picture(page, 'diagnosed', { fullPage: true });
  await page.$$eval('details.tool', (all) => all.forEach((e) => { e.open = false; })); // the picture of docs/serve.md
  const where = await page.$eval('#folder', (e) => { const text = e.textContent; e.textContent = 'drives'; return text; });
  await picture(page, 'serve', { fullPage: true, clip: { x: 90, y: 0, width: 1220, height: 1560 } });
  await page.$eval('#folder', (e, text) => { e.textContent = text; }, where);
  await page.$eval('#simulated', (e) => { e.open = true; });
  await click(page, '#hint', 'Add slip_sinkage');
  await title(page, 'add');
  await title(other, 'add');
  const [before, after] = (await newest(page)).match(/([\d.]+) → ([\d.]+)/).slice(1).map(Number);
  assert.ok(after < before / 1.5, `${before} to ${after}`);
  for (const p of [page, other]) await until(p, () => document.querySelector('#models input:checked')?.value === 'rover_sand_slip_sinkage.toml');
  assert.ok(await page.isHidden('#hint')); // it is in the model now
  assert.doesNotMatch(await page.textContent('#ladder'), /as given/); // `add` compares the model that it made
  assert.equal(await page.textContent('#history tbody'), await other.textContent('#history tbody'));
  await picture(page, 'added', { fullPage: true });
});

claim('the effect that is about to be added is drawn: where it acts, and the curve that it adds', async () => {
  for (const name of ['slip_sinkage', 'camera_delay']) {
    await page.selectOption('#effect', name);
    assert.equal(await page.$eval('#drawn', (e) => e.dataset.effect), name);
    assert.ok((await page.getAttribute('#drawn svg', 'aria-label')).startsWith(`${name} acts: `));
    assert.equal((await page.$$('#drawn svg .curve')).length, name === 'slip_sinkage' ? 1 : 0);
  }
});

claim('drop: a model without it, compared at once', async () => {
  await click(page, '#bench', 'Drop');
  await until(page, () => /drop slip_sinkage.*[\d.]+ → [\d.]+/.test(document.querySelector('#history tbody tr').textContent));
  assert.ok(readdirSync(folder).includes('rover_sand_slip_sinkage_without_slip_sinkage.toml'));
  assert.ok(readdirSync(folder).includes('rover_sand_slip_sinkage.toml'));
});

// x and y of the camera in a log, nearest to a time
function cameraAt(file, t) {
  const lines = readFileSync(file, 'utf8').split('\n').filter((l) => l && !l.startsWith('#')), names = lines[0].split(',');
  const [at, x, y] = ['t_s', 'camera.x_m', 'camera.y_m'].map((n) => names.indexOf(n));
  const rows = lines.slice(1).map((l) => l.split(',')).filter((c) => c[x] !== '' && c[x] !== undefined).map((c) => [+c[at], +c[x], +c[y]]);
  return rows.reduce((a, b) => (Math.abs(b[0] - t) < Math.abs(a[0] - t) ? b : a)).slice(1);
}

for (const [what, more, view] of [['in three dimensions, by the processor', ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'], '3d'], ['as a map, without WebGL', ['--disable-gpu', '--disable-3d-apis'], '2d']])
  claim(`look: the drive is played again ${what}; another result takes its place`, async () => {
    const own = await launch(executablePath, more);
    try {
      const { page: p } = await openPage(own, () => server.address, trouble);
      await p.check('#logs input[value="demo_sand_1.csv"]');
      await click(p, '#bench', 'Look');
      await title(p, 'drive: demo_sand_1.csv');
      await p.waitForSelector(`.stage[data-view="${view}"]`);
      const scrub = (t) => p.evaluate((to) => { const s = document.querySelector('.player input[type=range]'); s.value = to; s.dispatchEvent(new Event('input')); }, t);
      for (const t of [5, 20, 35]) {
        await scrub(t);
        const [x, y] = await p.$eval('.stage', (e) => e.dataset.pose.split(' ').map(Number)), [cx, cy] = cameraAt(`${folder}/demo_sand_1.csv`, t);
        assert.ok(Math.hypot(x - cx, y - cy) < 0.1, `${t} s: ${x} ${y}, the camera ${cx} ${cy}`); // half of its 1/7 s at 0.5 m/s, and its noise
      }
      await scrub(10);
      await click(p, '#result', 'Play');
      await until(p, () => +document.querySelector('.stage').dataset.time > 10.5 && +document.querySelector('.stage').dataset.frames > 5);
      await picture(p, `look_${view}`, { fullPage: true });
      await click(p, '#bench', 'Check');
      await title(p, 'check');
      assert.equal(await p.$('#result .stage'), null);
      await p.click('#history tbody tr:has(th:has-text("look")) button:text-is("Show")');
      await p.waitForSelector(`.stage[data-view="${view}"]`); // once more, with the code that is there
    } finally { await own.close(); }
  });

claim('next drive: a scenario of this folder that the rover can drive', async () => {
  await page.check('#models input[value="shipped/rover_sand.toml"]');
  await click(page, '#bench', 'Next drive');
  await title(page, 'next');
  if (readdirSync(folder).some((f) => f.startsWith('next_'))) await page.waitForSelector('#scenario option[value="next_demo_sand_1.toml"]', { state: 'attached' });
  assert.equal(await page.$('#history tbody tr:first-child .wrong'), null);
});

claim('a reload keeps what was run, what is chosen and what is shown', async () => {
  assert.equal(await page.$eval('#scenario', (e) => e.value), 'shipped/demo_sand.toml'); // a new scenario in the list changes no choice
  await page.click('#history tbody tr:has(th:has-text("diagnose")) button:text-is("Show")');
  await title(page, 'diagnose');
  await page.check('#logs input[value="identification_1.csv"]');
  const runs = await page.textContent('#history tbody');
  await page.reload();
  await ready(page);
  await title(page, 'diagnose');
  assert.equal(await page.textContent('#history tbody'), runs);
  assert.equal(await chosen(page, 'logs'), 'identification_1.csv');
  await page.$eval('#simulated', (e) => { e.open = true; }); // it is closed where there are logs
  await until(page, () => +document.querySelector('#live').dataset.rows > 100); // the last drive's rows come again
});

claim('a new file and a growing one appear without a reload', async () => {
  copyFileSync(`${folder}/demo_sand_1.csv`, `${folder}/from_afar.csv`);
  await page.waitForSelector('#logs label:has-text("from_afar.csv")');
  await page.waitForTimeout(1500);
  let row = 1000;
  const grow = setInterval(() => appendFileSync(`${folder}/from_afar.csv`, `${row++},\n`), 300); // it is said until the next look
  try {
    await page.waitForSelector('#logs label:has-text("from_afar.csv"):has-text("growing")');
  } finally { clearInterval(grow); }
  writeFileSync(`${folder}/foreign.csv`, 'a,b\n1,2\n');
  await page.waitForSelector('#logs label:has-text("foreign.csv"):has-text("needs a map")');
  await page.check('#logs input[value="foreign.csv"]');
  assert.ok(await page.isVisible('#map'));
  await click(page, '#bench', 'Compare');
  await until(page, () => /foreign\.csv/.test(document.querySelector('#history tbody tr .wrong')?.textContent ?? '')); // its own message
});

claim('the server goes: both are told so; it comes back: both go on by themselves', async () => {
  assert.equal(await server.end('SIGINT'), 0);
  for (const p of [page, other]) await until(p, () => /has not answered since/.test(document.querySelector('#link').textContent));
  assert.ok(await page.isDisabled('#bench button:text-is("Diagnose")'));
  await picture(page, 'gone');
  const runs = await page.textContent('#history tbody');
  server = await serve(traction, folder, { port: server.port });
  for (const p of [page, other]) await until(p, () => document.querySelector('#link').textContent === 'Connected');
  assert.equal(await page.textContent('#history tbody'), runs);
  await page.check('#logs input[value="demo_sand_1.csv"]');
  await click(page, '#bench', 'Check');
  await until(page, () => document.querySelector('#history tbody tr').textContent.startsWith('check') && !/runs/.test(document.querySelector('#history tbody tr').textContent));
});

claim('a sealed game: look, try, keep, open', async () => {
  await page.click('#game summary');
  await click(page, '#game', 'New game');
  await page.waitForSelector('#playing:not([hidden])', { timeout: 240000 });
  await until(page, () => !document.querySelector('#game button:disabled'));
  const hidden = JSON.parse(readFileSync(`${folder}/game/sealed.json`, 'utf8')).effects[0];
  assert.doesNotMatch(await page.evaluate(async () => JSON.stringify(await (await fetch('/api/result/' + document.querySelector('#history tbody tr .quiet').textContent.match(/\d+/)[0] + location.search)).json())), /"hidden"|"parameters"/);
  const before = await newest(page);
  await click(page, '#game', 'Look');
  await until(page, (was) => document.querySelector('#history tbody tr').textContent !== was, before); // the page may show a comparison already
  await title(page, 'compare');
  await until(page, () => !document.querySelector('#game button:disabled'));
  await page.selectOption('#guess', hidden.name);
  if (hidden.wheel !== undefined) await page.selectOption('#guess-wheel', String(hidden.wheel));
  await click(page, '#game', 'Keep it');
  await until(page, () => /kept/.test(document.querySelector('#game-state').textContent));
  await until(page, () => !document.querySelector('#game button:disabled'));
  await click(page, '#game', 'Open the seal');
  await page.waitForSelector('#opened', { timeout: 240000 });
  assert.ok((await page.textContent('#opened')).includes(hidden.name));
  await picture(page.locator('#game'), 'game');
});

claim('a drive that hides an effect: the seal is opened on the page', async () => {
  await page.click('#simulated summary');
  if (!(await page.isVisible('#drive-effect'))) await page.click('#simulated summary');
  await page.selectOption('#drive-effect', '?');
  await page.fill('#seconds', '10');
  await click(page, '#simulated', 'Start the drive');
  await page.waitForSelector('#history tbody tr:first-child button:text-is("Open the seal")', { timeout: 60000 });
  assert.doesNotMatch(await newest(page), /Hidden:/);
  await page.click('#history tbody tr:first-child button:text-is("Open the seal")');
  await until(page, () => /Hidden: \w+/.test(document.querySelector('#history tbody tr').textContent));
});

claim('keyboard alone: a log is chosen by arrows and checked', async () => {
  await page.focus('#logs input:checked');
  const before = await chosen(page, 'logs');
  await page.keyboard.press('ArrowDown');
  await until(page, (old) => document.querySelector('#logs input:checked').value !== old, before);
  let stops = 0;
  const on = () => page.evaluate(() => document.activeElement?.textContent);
  while ((await on()) !== 'Check' && stops < 12) { await page.keyboard.press('Tab'); stops += 1; }
  assert.equal(await on(), 'Check', `after ${stops} presses of Tab`);
  const number = (await newest(page)).match(/number (\d+)/)[1];
  await page.keyboard.press('Enter');
  await until(page, (n) => document.querySelector('#history tbody tr').textContent.match(/number (\d+)/)[1] !== n, number);
  await until(page, () => document.querySelector('#running').hidden);
});

let looked = null; // with bypassCSP, for axe alone
for (const [width, colorScheme] of [[420, 'light'], [1400, 'light'], [1920, 'dark']])
  claim(`${width} px, ${colorScheme}: axe finds nothing, nothing is cut`, async () => {
    const { page: p } = looked ??= await open({ bypassCSP: true });
    await anew(p, width, colorScheme);
    await p.waitForSelector('#result[data-run]');
    await nothingIsAmiss(p);
    await picture(p, `live_${width}_${colorScheme}`, { fullPage: true });
  });

claim('nothing went wrong in any page, and none asked anything of anybody else', async () => assert.deepEqual(trouble, []));

claim('Ctrl-C ends it at once, with pages open', async () => {
  const asked = Date.now();
  assert.equal(await server.end('SIGINT'), 0);
  assert.ok(Date.now() - asked < 5000, `${Date.now() - asked} ms`);
});

const failed = await tryAll(claims, page, `${shots}/failed`);
server.child.kill('SIGTERM');
await browser.close();
process.exit(failed ? 1 : 0);
