// replay_bench.mjs CHROMIUM PAGE - how often a drive of 120 s is drawn a second, its picture 1200 x 700 points, in headless chromium where the
// processor draws (SwiftShader); beside it, in the same browser, a page that does nothing but clear a picture of that size: what the browser
// itself leaves. Exit 1 below 30 a second in a view of three dimensions, or above 3 MB.
import { statSync, writeFileSync } from 'node:fs';
import { loadavg } from 'node:os';
import { dirname } from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const [executablePath, file] = process.argv.slice(2), seconds = 6;
const empty = `${dirname(file)}/empty.html`;
writeFileSync(empty, `<!doctype html><html data-ready="yes"><body style="margin:0"><div class="stage"><canvas width="1200" height="700"></canvas></div><script>
const gl = document.querySelector('canvas').getContext('webgl2', { antialias: false, alpha: false }), stage = document.querySelector('.stage');
let n = 0;
(function clear() { gl.clearColor(n % 100 / 100, 0.5, 0.5, 1); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT); stage.dataset.frames = ++n; requestAnimationFrame(clear); })();
</script>`);
const browser = await chromium.launch({ executablePath, args: ['--headless', '--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--no-first-run', '--disable-background-networking'] });

async function rate(path, before) {
  const page = await (await browser.newContext({ viewport: { width: 1200, height: 700 } })).newPage();
  await page.goto(pathToFileURL(path).href);
  await page.waitForSelector('html[data-ready=yes]');
  const size = await before(page), frames = () => page.$eval('.stage', (e) => +e.dataset.frames);
  await page.waitForTimeout(4000); // until the scene's programs are made, and its fineness is found
  const from = await frames(), began = Date.now();
  await page.waitForTimeout(1000 * seconds);
  const got = (1000 * ((await frames()) - from)) / (Date.now() - began);
  const fine = await page.$eval('.stage canvas', (c) => `${c.width} x ${c.height}`);
  await page.context().close();
  return { got, size, fine };
}
const play = (view) => async (page) => {
  await page.click('text=Fill the window');
  await page.locator('.player select').nth(1).selectOption(view);
  const size = await page.$eval('.picture', (e) => `${e.clientWidth} x ${e.clientHeight}`);
  await page.locator('.player select').nth(0).selectOption('8');
  await page.click('.player button');
  return size;
};
const bare = await rate(empty, async () => '1200 x 700');
console.log(`an empty picture of 1200 x 700: ${bare.got.toFixed(1)} a second; load of the machine ${loadavg()[0].toFixed(1)}`);
let slow = false;
for (const view of ['behind', 'above', 'whole', 'map']) {
  const { got, size, fine } = await rate(file, play(view));
  console.log(`${view}: ${got.toFixed(1)} a second at ${size}, drawn with ${fine} points`);
  slow ||= view !== 'map' && got < 30; // the map is for browsers without WebGL; told here for comparison
}
const bytes = statSync(file).size;
console.log(`the page: ${(bytes / 1e6).toFixed(2)} MB`);
await browser.close();
process.exit(slow || bytes > 3e6 ? 1 : 0);
