// replay_browser_test.mjs CHROMIUM PAGES_DIR SHOTS_DIR - the drive played again, looked at in headless chromium with a WebGL that the processor
// draws (SwiftShader), and with none. The truth that poses are held against is the CSV log, read here. With TRACTION_PICTURES in the
// environment it leaves pictures in SHOTS_DIR.
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

// Pages are opened one after the other in one tab of a browser: a tab of its own costs several times as much work as a page does. The
// window is small, because the processor draws every point of it.
const size = { width: 800, height: 500 };
async function tabOf(browser) {
  const tab = await (await browser.newContext()).newPage(), now = { address: '', trouble: [] };
  tab.on('console', (m) => { if (['error', 'warning'].includes(m.type()) && !/GPU stall|software rendering|WebGL/i.test(m.text())) now.trouble.push(m.text()); });
  tab.on('pageerror', (e) => now.trouble.push(e.message));
  tab.on('request', (r) => { if (!/^(data|blob):/.test(r.url()) && r.url() !== now.address) now.trouble.push(`request: ${r.url()}`); });
  return { tab, now };
}
const first = await tabOf(withGl);

// Opens a page as a reader finds it who has just come; whatever goes wrong or reaches out is collected.
async function open(name, { viewport = size, colorScheme = 'light', reducedMotion = 'no-preference' } = {}, { tab, now } = first) {
  await tab.goto('about:blank');
  [now.address, now.trouble] = [pathToFileURL(`${pages}/${name}.html`).href, []];
  await tab.setViewportSize(viewport);
  await tab.emulateMedia({ colorScheme, reducedMotion });
  await tab.mouse.move(0, 0);
  await tab.goto(now.address);
  await tab.waitForSelector('html[data-ready=yes]', { timeout: 20000 });
  return { page: tab, trouble: now.trouble };
}
const picture = (name, settings = {}) => process.env.TRACTION_PICTURES && first.tab.screenshot({ path: `${shots}/${name}.png`, ...settings });

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
    const { page, trouble } = await open(name);
    assert.equal((await state(page)).view, '3d');
    await poseIsTheLogs(page, poseOf(`${pages}/${name}.truth.csv`, 'truth'), name === 'drive_demo' ? [5, 30.02, 51] : [4, 7.3, 11]);
    await picture(name, { fullPage: true });
    assert.deepEqual(trouble, []);
  });

claim('without a truth the rover stands where the camera saw it, and the page says so', async () => {
  const { page } = await open('drive_camera');
  const seen = poseOf(`${pages}/drive_demo.csv`, 'camera');
  for (const t of [5, 30.02, 51]) { // 7 pictures a second: a corner of the path, between two of our rows, is cut by v dt/2 = 18 mm at most
    await scrub(page, t);
    const { at, where } = await state(page), [x, y] = seen(at);
    assert.ok(Math.hypot(where[0] - x, where[1] - y) < 0.018, `${where} for ${[x, y]}`);
  }
  assert.match(await page.textContent('.notes'), /Pose: the camera's/);
});

claim('the slider moves the plots\' cursor, and pointing at a plot moves the rover', async () => {
  const { page } = await open('drive_demo');
  await scrub(page, 20);
  const cursors = await page.$$eval('.uplot', (all) => all.map((e) => +e.dataset.cursor));
  assert.ok(cursors.length >= 3 && cursors.every((t) => Math.abs(t - 20) <= 0.04), String(cursors));
  const line = await page.$eval('.uplot', (u) => { const o = u.querySelector('.u-over').getBoundingClientRect(), c = u.querySelector('.u-cursor-x').getBoundingClientRect(); return (c.left - o.left) / o.width; });
  assert.ok(Math.abs(line - 20 / 61) < 0.01, String(line)); // the cursor's line stands there too
  const plot = page.locator('.u-over').nth(1);
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.boundingBox();
  await page.mouse.move(box.x + box.width * 0.75, box.y + 40);
  await page.waitForFunction(() => Math.abs(+document.querySelector('.stage').dataset.time - 0.75 * 61) < 0.3); // a pixel is 0.1 s
  await page.waitForFunction(() => Math.abs(+document.querySelector('.player input[type=range]').value - 0.75 * 61) < 0.3);
});

claim('keys alone: play, stop, a second on, a tenth back, home, end; drawn only while it plays', async () => {
  const { page } = await open('drive_demo');
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
});

claim('who wants no motion gets a picture a second, and none before asking', async () => {
  const { page } = await open('drive_demo', { reducedMotion: 'reduce' });
  await page.focus('.stage');
  const { frames } = await state(page);
  await page.waitForTimeout(300);
  assert.equal((await state(page)).frames, frames);
  await page.keyboard.press(' ');
  await page.waitForTimeout(2500);
  const seen = +(await state(page)).frames;
  assert.ok(seen >= 1 && seen <= 3, `${seen} pictures in 2.5 s`);
});

claim('views, ground, forces and ghost can be chosen; the window can be filled and left', async () => {
  const { page, trouble } = await open('drive_rough');
  const [, view, ground] = await page.$$('.player select');
  for (const value of ['side', 'above', 'whole', 'behind']) await view.selectOption(value);
  const scales = await ground.$$eval('option', (all) => all.map((e) => e.value));
  assert.deepEqual(scales, ['slip', 'grip']); // gravel: nothing sinks
  await ground.selectOption('grip');
  assert.match(await page.textContent('.legend-line'), /traction over load/);
  for (const box of await page.$$('.player input[type=checkbox]')) await box.click();
  await page.click('text=Fill the window');
  assert.deepEqual(await page.$eval('.picture', (e) => [e.clientWidth, e.clientHeight]), [size.width, size.height]);
  await view.selectOption('map');
  assert.equal((await state(page)).view, '2d');
  await page.focus('.stage');
  await page.keyboard.press('Escape');
  assert.ok((await page.$eval('.picture', (e) => e.clientHeight)) < 0.78 * size.height);
  assert.deepEqual(trouble, []);
});

claim('a result of the lab: the drive is folded, nothing of it runs until it is opened, and its plots share the time', async () => {
  const { page, trouble } = await open('lab');
  assert.equal(await page.evaluate(() => typeof globalThis.tractionScene), 'undefined');
  assert.equal(await page.$('.picture canvas'), null);
  await page.click('#drive summary');
  await page.waitForSelector('.stage[data-view="3d"]');
  await scrub(page, 10);
  assert.ok(Math.abs((await page.$eval('.uplot', (e) => +e.dataset.cursor)) - 10) <= 0.04);
  assert.deepEqual(trouble, []);
});

claim('a log without a pose has no drive in its page', async () => {
  const { page, trouble } = await open('lab_blind');
  assert.equal(await page.$('#drive'), null);
  assert.equal(await page.$eval('#scene', (e) => e.textContent.length), 0);
  assert.ok((await page.$$('#balances canvas')).length > 0);
  assert.deepEqual(trouble, []);
});

for (const [width, colorScheme] of [[420, 'light'], [1400, 'dark']])
  claim(`${width} px, ${colorScheme}: axe finds nothing, nothing is cut`, async () => {
    const { page } = await open('drive_step', { viewport: { width, height: 900 }, colorScheme });
    await scrub(page, 4);
    await page.addScriptTag({ content: axe });
    const found = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ['violations'] }));
    assert.deepEqual(found.violations.map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.target.join(' ')).join('; ')}`), []);
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth)) <= 0);
    await picture(`step_${width}_${colorScheme}`, { fullPage: true });
  });

const without = await chromium.launch({ executablePath, args: [...always, '--disable-3d-apis'] });
const flat = await tabOf(without);
claim('without WebGL the drive is a map, with the same slider and the rover where the log says', async () => {
  const { page, trouble } = await open('drive_demo', {}, flat);
  assert.equal((await state(page)).view, '2d');
  await poseIsTheLogs(page, poseOf(`${pages}/drive_demo.truth.csv`, 'truth'), [5, 30.02, 51]);
  assert.match(await page.textContent('.notes'), /no WebGL/);
  // the picture is not empty: the rover's outline has the ink's colour somewhere near the middle
  assert.ok((await dark(page)) > 20, `${await dark(page)} dark points`);
  if (process.env.TRACTION_PICTURES) await page.screenshot({ path: `${shots}/map.png` });
  assert.deepEqual(trouble, []);
});
const dark = (page) => page.$eval('.picture canvas', (c) => { const { data } = c.getContext('2d').getImageData(c.width / 2 - 40, c.height / 2 - 40, 80, 80); let n = 0; for (let i = 0; i < data.length; i += 4) n += data[i + 3] > 200 && data[i] < 60 ? 1 : 0; return n; });

// As it is for a moment while a window changes its size; a page that hangs answers nothing, so it is asked for ten seconds.
for (const side of ['width', 'height'])
  claim(`a map without ${side} does not hang the page, and is drawn again when it has some`, async () => {
    const { page, trouble } = await open('drive_demo', {}, flat);
    const asked = (async () => {
      await page.addStyleTag({ content: `.picture.none { ${side}: 0; min-${side}: 0; }` });
      await page.$eval('.picture', (e) => e.classList.add('none'));
      await scrub(page, 20);
      assert.ok(Math.abs((await state(page)).at - 20) <= 0.04);
      await page.$eval('.picture', (e) => e.classList.remove('none'));
      await scrub(page, 30.02);
      return dark(page);
    })();
    let timer;
    const points = await Promise.race([asked, new Promise((_, fail) => { timer = setTimeout(() => fail(new Error('the page hangs')), 10000); })]).finally(() => clearTimeout(timer));
    assert.ok(points > 20, `${points} dark points`);
    assert.deepEqual(trouble, []);
  });

if (process.env.TRACTION_PICTURES)
  claim('the picture of docs/: demo_sand in a sharp turn', async () => {
    const { page } = await open('drive_demo', { viewport: { width: 1100, height: 760 } });
    await scrub(page, 46);
    await page.$eval('#drive', (e) => e.scrollIntoView());
    await page.locator('.player').screenshot({ path: `${shots}/replay.png` });
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
await Promise.all([withGl.close(), without.close()]);
console.log(`${claims.length - failed} of ${claims.length} claims hold`);
process.exit(failed ? 1 : 0);
