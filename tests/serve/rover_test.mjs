// rover_test.mjs CHROMIUM TRACTION TRACTIOND FOLDER SHOTS_DIR - a rover on the live page, in a real browser: its telemetry grows, its silence is
// told with its age, it comes back by itself; its on-board log is fetched and checked; what was received is a log when it ends.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { createSocket } from 'node:dgram';
import { existsSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { anew, begin, click, nothingIsAmiss, open as openPage, pictures, serve, tryAll, until } from './page.mjs';

const [executablePath, traction, tractiond, folder, shots] = process.argv.slice(2);
const browser = await begin(executablePath, folder, shots, ['--disable-gpu']);
const beside = `${folder}_files`;
rmSync(beside, { recursive: true, force: true });
execFileSync('mkdir', [beside]);
execFileSync(traction, ['drive', '--new-key', `${beside}/key`]);
writeFileSync(`${beside}/cruise.toml`, 'title = "drives"\nduration_s = 600.0\nseed = 7\n[ground]\nsoil = "concrete"\n[[drive]]\nfor_s = 600.0\nmode = "platform_speed"\nspeed_m_s = 0.3\n');
const port = await new Promise((found) => { // one that is free, for the rover to come back to
  const socket = createSocket('udp4');
  socket.bind(0, '127.0.0.1', () => { const at = socket.address().port; socket.close(() => found(at)); });
});
function rover() {
  const child = spawn(tractiond, ['--hal', 'sim', `${beside}/cruise.toml`, '--link', `127.0.0.1:${port}`, '--link-key', `${beside}/key`, '--log', `${beside}/onboard`], { stdio: 'ignore' });
  const ended = new Promise((done) => child.on('exit', done));
  return { end: () => { child.kill('SIGTERM'); return ended; } };
}

let driving = null;
const server = await serve(traction, folder, { more: ['--host', `127.0.0.1:${port}`, '--key', `${beside}/key`] });
const trouble = [], claims = [];
const claim = (name, check) => claims.push([name, check]);
const open = (settings) => openPage(browser, () => server.address, trouble, settings);
const picture = pictures(shots);
const { page } = await open();
const words = (id) => page.textContent(`#rover-${id}`);
const status = (text) => until(page, (t) => document.querySelector('#watching').textContent.includes(t), text);

claim('before the rover is there: the page says so, and what it will not do', async () => {
  await status('No rover answers yet');
  assert.match(await page.textContent('#rover'), /it sends the rover no command/);
  assert.ok(await page.isVisible('nav a[href="#rover"]'));
});

claim('the rover comes: speed, slip, currents and battery grow before the eyes, with mode, faults and age', async () => {
  driving = rover();
  await status('The rover is heard');
  await until(page, () => +document.querySelector('#telemetry').dataset.rows > 15);
  const rows = await page.$eval('#telemetry', (e) => +e.dataset.rows);
  await until(page, (n) => +document.querySelector('#telemetry').dataset.rows > n + 8, rows);
  assert.equal((await page.$$('#telemetry canvas')).length, 4);
  // 0.3 m/s on concrete, a tenth: the platform's speed loop (tests/link/supervision.sh)
  await until(page, () => Math.abs(parseFloat(document.querySelector('#rover-speed').textContent) - 0.3) < 0.03);
  assert.match(await words('mode'), /^platform speed, bridges: drive$/);
  assert.match(await words('battery'), /^[678]\.\d+ V$/);
  assert.equal(await words('faults'), 'none');
  assert.match(await words('link'), /^last heard 0(\.\d)? s ago$/);
  await picture(page, 'rover', { fullPage: true });
});

claim('the rover falls silent: told with an age that grows; it comes back by itself', async () => {
  await driving.end();
  await status('The rover is silent');
  const age = async () => parseFloat((await words('link')).match(/last heard ([\d.]+) s/)[1]);
  const first = await age();
  assert.ok(first >= 1.5, `${first} s`);
  await page.waitForTimeout(2000);
  const second = await age();
  assert.ok(second > first + 1 && second < first + 4, `${first} s, two seconds later ${second} s`);
  assert.match(await words('speed'), /m\/s/); // what was heard last stays
  await picture(page, 'rover_silent');
  driving = rover();
  await status('The rover is heard');
  const rows = await page.$eval('#telemetry', (e) => +e.dataset.rows);
  await until(page, (n) => +document.querySelector('#telemetry').dataset.rows > n + 60, rows);
  await picture(page.locator('#rover'), 'rover_page'); // of docs/serve.md
});

claim('its on-board log is fetched while it is watched, chosen, and fit to be checked', async () => {
  await click(page, '#rover', 'List its logs');
  await page.waitForSelector('#rover-log option[value="1"]', { state: 'attached' });
  await page.selectOption('#rover-log', '1');
  await click(page, '#rover', 'Fetch');
  await until(page, () => document.querySelector('#logs input:checked')?.value === 'rover_log_1.csv');
  assert.match(readFileSync(`${folder}/rover_log_1.csv`, 'utf8').slice(0, 4000), /wheel0\.encoder_count/);
  await click(page, '#bench', 'Check');
  await until(page, () => document.querySelector('#result h1')?.textContent.startsWith('check'));
  assert.match(await page.textContent('#watching'), /The rover is heard/);
});

claim('no page can make the rover move, and another sees the same', async () => {
  const { page: other, close } = await open();
  await until(other, () => /The rover is heard/.test(document.querySelector('#watching').textContent));
  for (const body of [{ verb: 'drive', speed: 1 }, { verb: 'watch', host: '10.0.0.5' }, { verb: 'watch', speed: 1 }]) {
    const answer = await other.evaluate(async (asked) => (await fetch(`/api/run${location.search}`, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(asked) })).status, body);
    assert.equal(answer, 400, JSON.stringify(body));
  }
  trouble.splice(0, trouble.length, ...trouble.filter((t) => !/status of 400/.test(t))); // the console tells these three
  await close();
});

let looked = null; // with bypassCSP, for axe alone
for (const [width, colorScheme] of [[420, 'dark'], [1400, 'light']])
  claim(`${width} px, ${colorScheme}: axe finds nothing, nothing is cut`, async () => {
    const { page: p } = looked ??= await open({ bypassCSP: true });
    await anew(p, width, colorScheme);
    await until(p, () => +document.querySelector('#telemetry').dataset.rows > 15);
    await nothingIsAmiss(p);
    await picture(p, `rover_${width}_${colorScheme}`, { fullPage: true });
  });

claim('Stop: what was received is a log of the folder; Watch begins another', async () => {
  await click(page, '#rover', 'Stop');
  await status('The log: telemetry.csv');
  await page.waitForSelector('#logs input[value="telemetry.csv"]');
  assert.match(await page.textContent('#history tbody'), /\d+ statuses in \d+ s/);
  await click(page, '#rover', 'Watch');
  await status('The rover is heard');
});

claim('nothing went wrong in any page, and none asked anything of anybody else', async () => assert.deepEqual(trouble, []));

claim('Ctrl-C: what was received since is kept', async () => {
  assert.equal(await server.end('SIGINT'), 0);
  assert.ok(existsSync(`${folder}/telemetry_2.csv`));
});

const failed = await tryAll(claims, page, `${shots}/failed_rover`);
server.child.kill('SIGTERM');
await driving?.end();
await browser.close();
process.exit(failed ? 1 : 0);
