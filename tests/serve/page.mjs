// page.mjs - what the tests of the live page share: a server, a browser that listens for trouble, claims that are tried one after the other.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { chromium } from 'playwright-core';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

// Starts the server of a folder; its address, and how to end it: exit code.
export async function serve(traction, folder, { port = 0, more = [] } = {}) {
  const child = spawn(traction, ['serve', folder, '--port', String(port), ...more], { stdio: ['ignore', 'pipe', 'pipe'] });
  const ended = new Promise((done) => child.on('exit', (code, signal) => done(signal ?? code)));
  let said = '';
  child.stderr.on('data', (bytes) => { said += bytes; });
  const address = await new Promise((found, fail) => {
    child.stdout.on('data', (bytes) => { said += bytes; const at = said.match(/http:\/\/\S+/); if (at) found(at[0]); });
    ended.then((code) => fail(new Error(`traction serve ended with ${code}: ${said}`)));
  });
  return { address, port: +new URL(address).port, child, end: (signal = 'SIGINT') => { child.kill(signal); return ended; } };
}

// A fresh folder, a place for pictures, a browser.
export async function begin(executablePath, folder, shots, more = []) {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  mkdirSync(shots, { recursive: true });
  return launch(executablePath, more);
}
export const launch = (executablePath, more) => chromium.launch({ executablePath, args: ['--headless', '--no-sandbox', '--disable-quic', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync', ...more] });

// Pictures are for people: they are taken where TRACTION_PICTURES is set.
export const pictures = (shots) => (what, name, settings = {}) => process.env.TRACTION_PICTURES && what.screenshot({ path: `${shots}/${name}.png`, ...settings });

export const ready = (page) => page.waitForSelector('html[data-ready=yes]', { timeout: 20000 });
export const click = (page, where, words) => page.click(`${where} button:text-is("${words}")`);
// Asked ten times a second: asked before every picture, as is usual, the page draws all the time that it waits.
export const until = (page, what, argument) => page.waitForFunction(what, argument, { timeout: 240000, polling: 100 });

// A page of the server that `where` gives; what goes wrong in it is added to `trouble`.
export async function open(browser, where, trouble, settings = {}) {
  const context = await browser.newContext({ viewport: { width: 1400, height: 900 }, ...settings });
  const page = await context.newPage();
  page.on('console', (m) => { if (['error', 'warning'].includes(m.type()) && !/GPU stall|software rendering|WebGL: CONTEXT_LOST|ERR_CONNECTION_REFUSED|ERR_INCOMPLETE_CHUNKED|ERR_EMPTY_RESPONSE|ERR_CONNECTION_RESET/.test(m.text())) trouble.push(`console: ${m.text()}`); });
  page.on('pageerror', (e) => trouble.push(`error: ${e.message}`));
  page.on('request', (r) => { if (!/^(data|blob):/.test(r.url()) && new URL(r.url()).host !== new URL(where()).host) trouble.push(`request: ${r.url()}`); });
  // what the page's main thread has worked, in seconds of the processor: what else the machine does is not in it
  const seen = await context.newCDPSession(page);
  await seen.send('Performance.enable', { timeDomain: 'threadTicks' });
  const worked_s = async () => (await seen.send('Performance.getMetrics')).metrics.find((m) => m.name === 'TaskDuration').value;
  await page.goto(where());
  await ready(page);
  return { page, worked_s, close: () => context.close() };
}

// The page of a tab of its own, which is slow to come by, anew in a window of another size.
export async function anew(page, width, colorScheme) {
  await page.setViewportSize({ width, height: 900 });
  await page.emulateMedia({ colorScheme });
  await page.reload();
  await ready(page);
}

// Opens every fold; axe finds nothing and nothing is cut. The page must be one with bypassCSP.
export async function nothingIsAmiss(page) {
  await page.$$eval('details', (all) => all.forEach((e) => { e.open = true; }));
  await page.waitForTimeout(500);
  await page.addScriptTag({ content: axe });
  const found = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ['violations'] }));
  assert.deepEqual(found.violations.map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.target.join(' ')).join('; ')}`), []);
  const over = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  assert.ok(over <= 0, `${over} px too wide`);
}

const longest_s = 300; // of a claim: what waits on a page that is stuck is told by its name
const within = (work) => {
  let timer;
  return Promise.race([work, new Promise((_, fail) => { timer = setTimeout(() => fail(new Error(`not done after ${longest_s} s`)), 1000 * longest_s); })]).finally(() => clearTimeout(timer));
};

// Tries [name, check] in their order; how many do not hold.
export async function tryAll(claims, page, failure) {
  let failed = 0;
  for (const [name, check] of claims) {
    try {
      await within(Promise.resolve().then(check));
      console.log(`ok      ${name}`);
    } catch (error) {
      failed += 1;
      console.log(`FAILED  ${name}\n${error.stack}`);
      await page.screenshot({ path: `${failure}_${failed}.png`, fullPage: true }).catch(() => {});
    }
  }
  console.log(`${claims.length - failed} of ${claims.length} claims hold`);
  return failed;
}
