// long_test.mjs CHROMIUM TRACTION FOLDER SHOTS_DIR - a log of 1000 s in the live page: what its result costs the page, beside a log of 20 s in
// the same run, in processor time (the machine may be busy), and how much memory server and page take.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { begin, click, open as openPage, pictures, serve, tryAll, until } from './page.mjs';

const [executablePath, traction, folder, shots] = process.argv.slice(2);
const browser = await begin(executablePath, folder, shots, ['--disable-gpu', '--enable-precise-memory-info']);
const part = (s, what) => `[[drive]]\nfor_s = ${s}\nmode = "platform_speed"\n${what}\n`;
const lap = part(10, 'speed_m_s = [0.0, 0.4]') + part(8, 'speed_m_s = 0.3\nyaw_rate_rad_s = 0.3') + part(2, 'speed_m_s = 0');
for (const [name, laps] of [['short', 1], ['long', 50]]) {
  writeFileSync(`${folder}/${name}.toml`, `title = "${name}"\nduration_s = ${20 * laps}.0\nseed = 3\n[ground]\nsoil = "sand"\n${lap.repeat(laps)}`);
  execFileSync(traction, ['simulate', `${folder}/${name}.toml`, '--out', `${folder}/${name}.csv`]);
}

const server = await serve(traction, folder);
const trouble = [], claims = [], took = {};
const claim = (name, check) => claims.push([name, check]);
const peak = () => +readFileSync(`/proc/${server.child.pid}/status`, 'utf8').match(/VmHWM:\s+(\d+) kB/)[1] / 1e3;
const open = () => openPage(browser, () => server.address, trouble);
const { page } = await open();
// runs a verb on a log, waits for its result
async function run(log, verb, title) {
  await page.check(`#logs input[value="${log}.csv"]`);
  await click(page, '#bench', verb);
  await until(page, (begins) => document.querySelector('#result h1')?.textContent.startsWith(begins), title);
  await until(page, () => document.querySelector('#running').hidden);
}
// what a fresh page works from its address to the result, which it shows last
async function load(key, what) {
  const { page: p, worked_s, close } = await open();
  await p.waitForSelector(what, { timeout: 60000 });
  await p.evaluate(() => new Promise((drawn) => { requestAnimationFrame(() => requestAnimationFrame(drawn)); }));
  took[key] = { s: await worked_s(), MB: (await p.evaluate(() => performance.memory.usedJSHeapSize)) / 1e6 };
  if (key.startsWith('long')) await pictures(shots)(p, key);
  await close();
}

for (const [verb, title, what] of [['Compare', 'compare', '#balances canvas'], ['Look', 'drive: ', '#result .stage[data-view]']])
  claim(`${verb}: the result of 1000 s costs the page at most 3 s of work more than that of 20 s`, async () => {
    const key = verb.toLowerCase();
    for (const log of ['short', 'long']) {
      await run(log, verb, title === 'compare' ? title : `${title}${log}`);
      await load(`${log}_${key}`, what);
    }
    const [small, large] = [took[`short_${key}`], took[`long_${key}`]];
    console.log(`      ${key}: 1000 s ${large.s.toFixed(2)} s, page's heap ${large.MB.toFixed(0)} MB; 20 s ${small.s.toFixed(2)} s, ${small.MB.toFixed(0)} MB; server's peak ${peak().toFixed(0)} MB`);
    assert.ok(small.s > 0.01 && large.s - small.s <= 3, `${large.s} s, the short one ${small.s} s`);
  });

claim('a simulated drive of 1000 s grows to its end: every row is there, and zero is lost', async () => {
  await page.$eval('#simulated', (e) => { e.open = true; });
  await page.selectOption('#scenario', 'long.toml');
  await page.fill('#seconds', '1000');
  await click(page, '#simulated', 'Start the drive');
  await until(page, () => /The drive ended after/.test(document.querySelector('#driving').textContent));
  assert.equal(await page.$eval('#live', (e) => +e.dataset.rows), 10000); // ten a second; the first tick is number 0 or 10
  console.log(`      after a drive of 1000 s: page's heap ${((await page.evaluate(() => performance.memory.usedJSHeapSize)) / 1e6).toFixed(0)} MB, server's peak ${peak().toFixed(0)} MB`);
});

claim('server and page keep within their memory', () => {
  // the server holds a result as text once for each request and parses it once for the list: ten times the largest is roomy; rows of an hour are some MB
  assert.ok(peak() < 250, `${peak()} MB`);
  for (const [key, { MB }] of Object.entries(took)) assert.ok(MB < 250, `${key}: ${MB} MB`);
});

claim('nothing went wrong in any page', () => assert.deepEqual(trouble, []));

const failed = await tryAll(claims, page, `${shots}/failed_long`);
server.child.kill('SIGTERM');
await browser.close();
process.exit(failed ? 1 : 0);
