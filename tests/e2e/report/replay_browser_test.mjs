// replay_browser_test.mjs CHROMIUM PAGES_DIR SHOTS_DIR - the drive played again, looked at in headless chromium with a WebGL that the processor
// draws (SwiftShader), and with none. The truth that poses are held against is the CSV log, read here.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const [executablePath, pages, shots] = process.argv.slice(2);
mkdirSync(shots, { recursive: true });
const always = ['--headless', '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'];
const withGl = await chromium.launch({ executablePath, args: [...always, '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });
const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const claims = [];
const claim = (name, check) => claims.push([name, check]);

async function open(name, settings = {}, browser = withGl) {
  const context = await browser.newContext({ viewport: { width: 1200, height: 900 }, ...settings });
  const page = await context.newPage(), trouble = [], address = pathToFileURL(`${pages}/${name}.html`).href;
  page.on('console', (m) => { if (['error', 'warning'].includes(m.type()) && !/GPU stall|software rendering|WebGL/i.test(m.text())) trouble.push(m.text()); });
  page.on('pageerror', (e) => trouble.push(e.message));
  page.on('request', (r) => { if (!/^(data|blob):/.test(r.url()) && r.url() !== address) trouble.push(`request: ${r.url()}`); });
  await page.goto(address);
  await page.waitForSelector('html[data-ready=yes]', { timeout: 20000 });
  return { page, trouble, close: () => context.close() };
}

// x, y, heading of a log at a time: a straight line between its rows
function poseOf(file, object) {
  const lines = readFileSync(file, 'utf8').split('\n').filter((l) => l && !l.startsWith('#')), names = lines[0].split(',');
  const columns = ['t_s', `${object}.x_m`, `${object}.y_m`, `${object}.yaw_rad`].map((n) => names.indexOf(n));
  const rows = lines.slice(1).map((l) => l.split(',')).map((cells) => columns.map((c) => cells[c])).filter((r) => r.every((x) => x !== '' && x !== undefined)).map((r) => r.map(Number));
  return (t) => {
    const i = Math.max(1, rows.findIndex((r) => r[0] >= t)), [a, b] = [rows[i - 1], rows[i]], share = (t - a[0]) / (b[0] - a[0]);
    return [1, 2, 3].map((k) => a[k] + share * (b[k] - a[k]));
  };
}
const state = (page) => page.$eval('.stage', (e) => ({ ...e.dataset, at: +e.dataset.time, where: e.dataset.pose.split(' ').map(Number) }));
const scrub = (page, t) => page.evaluate((to) => { const s = document.querySelector('.player input[type=range]'); s.value = to; s.dispatchEvent(new Event('input')); }, t);

// Rows lie 40 ms apart and a line joins them: of a motion of 0.9 m/s and 3 m/s^2 at most that is a t^2/8 = 0.6 mm; 16 bits over 10 m add
// 0.08 mm, the text of the element 0.05 mm. A turn of 2 rad/s^2: 0.4 mrad.
async function poseIsTheLogs(page, truth, times) {
  for (const t of times) {
    await scrub(page, t);
    const { at, where } = await state(page), [x, y, yaw] = truth(at);
    assert.ok(Math.abs(at - t) <= 0.04, `${at} for ${t}`);
    assert.ok(Math.hypot(where[0] - x, where[1] - y) < 1e-3, `${where} for ${[x, y]}`);
    assert.ok(Math.abs(where[2] - yaw) < 2e-3, `${where[2]} for ${yaw}`);
  }
}

for (const name of ['drive_demo', 'drive_rough', 'drive_step'])
  claim(`${name}: the scene has the rover where the log says, at three times`, async () => {
    const { page, trouble, close } = await open(name);
    assert.equal((await state(page)).view, '3d');
    await poseIsTheLogs(page, poseOf(`${pages}/${name}.truth.csv`, 'truth'), name === 'drive_demo' ? [5, 30.02, 51] : [4, 7.3, 11]);
    await page.screenshot({ path: `${shots}/${name}.png`, fullPage: true });
    assert.deepEqual(trouble, []);
    await close();
  });

claim('without a truth the rover stands where the camera saw it, and the page says so', async () => {
  const { page, close } = await open('drive_camera');
  const seen = poseOf(`${pages}/drive_demo.csv`, 'camera');
  for (const t of [5, 30.02, 51]) { // 7 pictures a second: a corner of the path, between two of our rows, is cut by v dt/2 = 18 mm at most
    await scrub(page, t);
    const { at, where } = await state(page), [x, y] = seen(at);
    assert.ok(Math.hypot(where[0] - x, where[1] - y) < 0.018, `${where} for ${[x, y]}`);
  }
  assert.match(await page.textContent('.notes'), /Pose: the camera's/);
  await close();
});

claim('the slider moves the plots\' cursor, and pointing at a plot moves the rover', async () => {
  const { page, close } = await open('drive_demo');
  await scrub(page, 20);
  const cursors = await page.$$eval('.uplot', (all) => all.map((e) => +e.dataset.cursor));
  assert.ok(cursors.length >= 3 && cursors.every((t) => Math.abs(t - 20) <= 0.04), String(cursors));
  const line = await page.$eval('.uplot', (u) => { const o = u.querySelector('.u-over').getBoundingClientRect(), c = u.querySelector('.u-cursor-x').getBoundingClientRect(); return (c.left - o.left) / o.width; });
  assert.ok(Math.abs(line - 20 / 61) < 0.01, String(line)); // the cursor's line stands there too
  const plot = page.locator('.u-over').nth(1);
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.boundingBox();
  await page.mouse.move(box.x + box.width * 0.75, box.y + 40);
  await page.waitForFunction(() => Math.abs(+document.querySelector('.stage').dataset.time - 0.75 * 61) < 0.3); // a pixel is 0.06 s
  await page.waitForFunction(() => Math.abs(+document.querySelector('.player input[type=range]').value - 0.75 * 61) < 0.3);
  await close();
});

claim('keys alone: play, stop, a second on, a tenth back, home, end; drawn only while it plays', async () => {
  const { page, close } = await open('drive_demo');
  await page.focus('.stage');
  await page.keyboard.press('ArrowRight');
  const at = async () => (await state(page)).at, first = await at();
  await page.keyboard.press('Shift+ArrowLeft');
  assert.ok(Math.abs((await at()) - (first - 0.1)) < 1e-3);
  await page.keyboard.press('End');
  assert.ok(Math.abs((await at()) - 61) < 0.1);
  await page.keyboard.press('Home');
  await page.keyboard.press(' ');
  await page.waitForFunction(() => +document.querySelector('.stage').dataset.time > 1);
  assert.equal(await page.textContent('.player button'), 'Pause');
  await page.keyboard.press(' ');
  const { frames } = await state(page);
  await page.waitForTimeout(300);
  assert.equal((await state(page)).frames, frames);
  await close();
});

claim('who wants no motion gets a picture a second, and none before asking', async () => {
  const { page, close } = await open('drive_demo', { reducedMotion: 'reduce' });
  await page.focus('.stage');
  const { frames } = await state(page);
  await page.waitForTimeout(300);
  assert.equal((await state(page)).frames, frames);
  await page.keyboard.press(' ');
  await page.waitForTimeout(2500);
  const seen = +(await state(page)).frames;
  assert.ok(seen >= 1 && seen <= 3, `${seen} pictures in 2.5 s`);
  await close();
});

claim('views, ground, forces and ghost can be chosen; the window can be filled and left', async () => {
  const { page, trouble, close } = await open('drive_rough');
  const [, view, ground] = await page.$$('.player select');
  for (const value of ['side', 'above', 'whole', 'behind']) await view.selectOption(value);
  const scales = await ground.$$eval('option', (all) => all.map((e) => e.value));
  assert.deepEqual(scales, ['slip', 'grip']); // gravel: nothing sinks
  await ground.selectOption('grip');
  assert.match(await page.textContent('.legend-line'), /traction over load/);
  for (const box of await page.$$('.player input[type=checkbox]')) await box.click();
  await page.click('text=Fill the window');
  assert.deepEqual(await page.$eval('.picture', (e) => [e.clientWidth, e.clientHeight]), [1200, 900]);
  await view.selectOption('map');
  assert.equal((await state(page)).view, '2d');
  await page.focus('.stage');
  await page.keyboard.press('Escape');
  assert.ok((await page.$eval('.picture', (e) => e.clientHeight)) < 700);
  assert.deepEqual(trouble, []);
  await close();
});

claim('a result of the lab: the drive is folded, nothing of it runs until it is opened, and its plots share the time', async () => {
  const { page, trouble, close } = await open('lab');
  assert.equal(await page.evaluate(() => typeof globalThis.tractionScene), 'undefined');
  assert.equal(await page.$('.picture canvas'), null);
  await page.click('#drive summary');
  await page.waitForSelector('.stage[data-view="3d"]');
  await scrub(page, 10);
  assert.ok(Math.abs((await page.$eval('.uplot', (e) => +e.dataset.cursor)) - 10) <= 0.04);
  assert.deepEqual(trouble, []);
  await close();
});

claim('a log without a pose has no drive in its page', async () => {
  const { page, trouble, close } = await open('lab_blind');
  assert.equal(await page.$('#drive'), null);
  assert.equal(await page.$eval('#scene', (e) => e.textContent.length), 0);
  assert.ok((await page.$$('#balances canvas')).length > 0);
  assert.deepEqual(trouble, []);
  await close();
});

for (const [width, colorScheme] of [[420, 'light'], [1400, 'dark']])
  claim(`${width} px, ${colorScheme}: axe finds nothing, nothing is cut`, async () => {
    const { page, close } = await open('drive_step', { viewport: { width, height: 900 }, colorScheme });
    await scrub(page, 4);
    await page.addScriptTag({ content: axe });
    const found = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ['violations'] }));
    assert.deepEqual(found.violations.map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.target.join(' ')).join('; ')}`), []);
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth)) <= 0);
    await page.screenshot({ path: `${shots}/step_${width}_${colorScheme}.png`, fullPage: true });
    await close();
  });

claim('without WebGL the drive is a map, with the same slider and the rover where the log says', async () => {
  const without = await chromium.launch({ executablePath, args: [...always, '--disable-3d-apis'] });
  const { page, trouble, close } = await open('drive_demo', {}, without);
  assert.equal((await state(page)).view, '2d');
  await poseIsTheLogs(page, poseOf(`${pages}/drive_demo.truth.csv`, 'truth'), [5, 30.02, 51]);
  assert.match(await page.textContent('.notes'), /no WebGL/);
  // the picture is not empty: the rover's outline has the ink's colour somewhere near the middle
  const dark = await page.$eval('.picture canvas', (c) => { const { data } = c.getContext('2d').getImageData(c.width / 2 - 40, c.height / 2 - 40, 80, 80); let n = 0; for (let i = 0; i < data.length; i += 4) n += data[i + 3] > 200 && data[i] < 60 ? 1 : 0; return n; });
  assert.ok(dark > 20, `${dark} dark points`);
  await page.screenshot({ path: `${shots}/map.png` });
  assert.deepEqual(trouble, []);
  await close();
  await without.close();
});

claim('the picture of docs/: demo_sand in a sharp turn', async () => {
  const { page, close } = await open('drive_demo', { viewport: { width: 1100, height: 760 } });
  await scrub(page, 46);
  await page.$eval('#drive', (e) => e.scrollIntoView());
  await page.locator('.player').screenshot({ path: `${shots}/replay.png` });
  await close();
});

let failed = 0;
for (const [name, check] of claims) {
  try {
    await check();
    console.log(`ok    ${name}`);
  } catch (error) {
    failed += 1;
    console.log(`FAIL  ${name}\n      ${String(error.stack ?? error).replaceAll('\n', '\n      ')}`);
  }
}
await withGl.close();
console.log(`${claims.length - failed} of ${claims.length} claims hold; pictures in ${shots}`);
process.exit(failed ? 1 : 0);
