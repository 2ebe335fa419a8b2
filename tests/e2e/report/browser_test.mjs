// browser_test.mjs CHROMIUM PAGES_DIR SHOTS_DIR - opens every page from disk in headless chromium and checks what a reader gets:
// no error, no request, every part there, zoom linked, keys working. With TRACTION_PICTURES in the environment also pictures at desktop,
// narrow, dark and print widths, in SHOTS_DIR.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, statSync } from 'node:fs';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const [executablePath, pages, shots] = process.argv.slice(2);
mkdirSync(shots, { recursive: true });
const browser = await chromium.launch({ executablePath, args: ['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync'] });

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const claims = [];
const claim = (name, check) => claims.push([name, check]);

// Pages are opened one after the other in one tab: a tab of its own costs four times as much work as a page does.
const tab = await (await browser.newContext()).newPage();
let address = '', trouble = [];
tab.on('console', (m) => { if (['error', 'warning'].includes(m.type())) trouble.push(`console: ${m.text()}`); });
tab.on('pageerror', (e) => trouble.push(`error: ${e.message}`));
tab.on('request', (r) => { if (!/^(data|blob):/.test(r.url()) && r.url() !== address) trouble.push(`request: ${r.url()}`); });

// Opens a page as a reader finds it who has just come; whatever goes wrong or reaches out is collected.
async function open(name, { viewport = { width: 1280, height: 900 }, colorScheme = 'light' } = {}) {
  await tab.goto('about:blank');
  [address, trouble] = [pathToFileURL(`${pages}/${name}.html`).href, []];
  await tab.setViewportSize(viewport);
  await tab.emulateMedia({ media: 'screen', colorScheme });
  await tab.mouse.move(0, 0);
  const began = Date.now();
  await tab.goto(address);
  await tab.waitForSelector('html[data-ready=yes]', { timeout: 20000 });
  return { page: tab, trouble, ms: Date.now() - began };
}
const picture = (name, settings = { fullPage: true }) => process.env.TRACTION_PICTURES && tab.screenshot({ path: `${shots}/${name}.png`, ...settings });

const shown = (page) => page.$eval('.toolbar output', (e) => e.textContent);
const sectionIds = (page) => page.$$eval('main > section', (all) => all.map((e) => e.id));
const overflow = (page) => page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

for (const name of ['every_effect', 'check', 'compare', 'diagnose', 'demo', 'gaps', 'runs', 'compared', 'figures', 'empty', 'odd', 'large', 'real_compare', 'real_check', 'real_speed', 'real_history'])
  claim(`${name}: opens from disk without an error and without a request`, async () => {
    const { page, trouble } = await open(name);
    assert.deepEqual(trouble, []);
    assert.ok((await page.$$('main h1')).length === 1);
    if (!['large', 'empty', 'real_check', 'real_history'].includes(name)) await picture(`${name}_desktop`);
  });

claim('diagnose: one page, one story, in the order of the questions', async () => {
  const { page } = await open('demo');
  assert.deepEqual(await sectionIds(page), ['verdict', 'seal', 'ladder', 'regimes', 'balances', 'found', 'unknown', 'ruled-out', 'unseen', 'details']);
  const said = await page.textContent('#verdict');
  for (const question of ['Is the model good enough?', 'What is missing?', 'How sure is that?', 'What is left, and why?', 'What next?']) assert.ok(said.includes(question), question);
  assert.match(said, /slip_sinkage explains it. 1.1 times the sensor noise is left, of which 1.0 is noise of the sensors/);
  assert.match(await page.textContent('#seal'), /slip_sinkage: coefficient = 0.15.*right/s);
  assert.equal((await page.$$('#ladder tbody tr')).length, 5); // as given, retuned, with the effect, what is left in parts, noise
  assert.match(await page.textContent('#ladder .legend'), /noise of the sensors \(83 % of the squares\).*how the ground varies/s); // 1 / 1.1^2
  assert.match(await page.textContent('#regimes .lead'), /fails most at slip 0.3 to 0.6/);
  assert.equal((await page.$$('#balances canvas')).length, 2); // one signal at a time, the worst first
  assert.equal(await page.$eval('#signal', (e) => e.selectedOptions[0].textContent), 'Position by camera');
  assert.match(await page.textContent('#balances h2'), /before and after/);
  assert.deepEqual(await page.$$eval('#balances .u-legend th', (all) => all.map((e) => e.textContent).filter((x) => /before|after|measured/.test(x))), ['measured', 'model before', 'model after', 'residual before', 'residual after']);
  assert.match(await page.textContent('#ruled-out'), /mesh_loss.*cannot tell it.*coulomb_friction.*no sure help/s);
  assert.match(await page.textContent('#unseen'), /one wheel drags/);
  assert.match(await page.textContent('#candidates'), /0\.21/); // p is in the details
  assert.equal((await page.textContent('main')).match(/something to find/g), null);
});

claim('no percentage beyond 100, and the words of what a person reads first hold no p and no d′', async () => {
  const { page } = await open('demo');
  const percents = [...(await page.textContent('main')).matchAll(/([\d.]+)\s*%/g)].map((m) => +m[1]);
  assert.ok(percents.length > 3 && percents.every((x) => x <= 100), String(percents.filter((x) => x > 100)));
  for (const id of ['verdict', 'seal', 'ladder', 'regimes', 'ruled-out', 'unseen']) assert.doesNotMatch(await page.textContent(`#${id}`), /\bp =|p-value|d′|NRMSE/);
});

claim('every effect of the catalogue has its drawing where it is named, with words for who does not see it', async () => {
  const { page } = await open('every_effect');
  const { effects } = JSON.parse(readFileSync(`${pages}/../effects.json`, 'utf8'));
  await page.$$eval('details', (all) => all.forEach((e) => { e.open = true; }));
  for (const { name } of effects) {
    const drawings = await page.$$eval('#ruled-out th:has(svg.effect)', (all, n) => all.filter((e) => e.querySelector('strong').textContent === n)
      .map((e) => ({ words: e.querySelector('svg').getAttribute('aria-label'), wide: e.querySelector('svg').getBoundingClientRect().width, parts: e.querySelectorAll('svg .mark, svg .force').length })), name);
    assert.equal(drawings.length, 1, name);
    assert.ok(drawings[0].words.startsWith(`${name} acts: `) && drawings[0].wide > 100 && drawings[0].parts > 0, `${name}: ${JSON.stringify(drawings[0])}`);
  }
});

for (const [width, colorScheme] of [[420, 'light'], [1920, 'dark']])
  for (const name of ['demo', 'check', 'figures', 'runs', 'real_compare', 'compared', 'every_effect'])
    claim(`${name} at ${width} px, ${colorScheme}: axe finds nothing, nothing is cut`, async () => {
      const { page, trouble } = await open(name, { viewport: { width, height: 900 }, colorScheme });
      await page.$$eval('details', (all) => all.forEach((e) => { e.open = true; }));
      await page.addScriptTag({ content: axe });
      const found = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ['violations'] }));
      assert.deepEqual(found.violations.map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.target.join(' ')).join('; ')}`), []);
      assert.ok((await overflow(page)) <= 0, `${await overflow(page)} px too wide`);
      const cut = await page.$$eval('.scroll', (all) => all.filter((e) => e.scrollWidth > e.clientWidth + 1).map((e) => e.textContent.slice(0, 40)));
      if (!['check', 'compared'].includes(name)) assert.deepEqual(cut, []); // every table fits
      assert.deepEqual(trouble, []);
      if (name !== 'check') await picture(`${name}_${width}_${colorScheme}_open`);
    });

claim('demo: at 1400 x 900 the story is at most eight screens long, details folded', async () => {
  const { page } = await open('demo', { viewport: { width: 1400, height: 900 } });
  const tall = await page.evaluate(() => document.getElementById('details').offsetTop);
  await picture('demo_1400');
  assert.ok(tall <= 8 * 900, `${tall} px before the details`);
});

claim('keyboard alone: few stops to the plots, a signal is chosen, zoomed, and the whole log comes back', async () => {
  const { page } = await open('demo', { viewport: { width: 1400, height: 900 } });
  let stops = 0;
  const inPlots = () => page.evaluate(() => document.activeElement?.classList.contains('plots'));
  while (!(await inPlots()) && stops < 40) { await page.keyboard.press('Tab'); stops += 1; }
  assert.ok(stops <= 20, `${stops} presses of Tab to the first plot`); // one per section in the contents, the folded maps, the plots' own controls
  const range = () => page.$eval('.uplot', (e) => e.dataset.range);
  const whole = await range();
  await page.keyboard.press('+');
  await page.waitForFunction((before) => document.querySelector('.uplot').dataset.range !== before, whole);
  await page.keyboard.press('Home');
  assert.equal(await range(), whole);
  await page.focus('#signal');
  await page.keyboard.press('ArrowDown');
  await page.waitForFunction(() => document.querySelector('.plots').getAttribute('aria-label').startsWith('Motor current'));
  assert.equal((await page.$$('#balances canvas')).length, 2);
});

claim('gaps: rows left out are counted, and no line is drawn across them', async () => {
  const { page } = await open('gaps', { viewport: { width: 1400, height: 900 } });
  assert.match(await page.textContent('#balances'), /Shaded: 89 rows left out, in 4 stretches/);
  // the better model's line has its own colour, rgb(0, 115, 79): none of it between 42 and 53 s, some between 30 and 38 s (a tenth of the log)
  const coloured = (from, to) => page.evaluate(([a, b]) => {
    const u = document.querySelector('.uplot'), canvas = u.querySelector('canvas'), over = u.querySelector('.u-over');
    const [low, high] = u.dataset.range.split(' ').map(Number), ratio = canvas.width / canvas.clientWidth;
    const x = (t) => (over.offsetLeft + ((t - low) / (high - low)) * over.clientWidth) * ratio;
    const { data } = canvas.getContext('2d').getImageData(x(a), over.offsetTop * ratio, x(b) - x(a), over.clientHeight * ratio);
    let n = 0;
    for (let i = 0; i < data.length; i += 4) n += data[i] < 40 && Math.abs(data[i + 1] - 115) < 30 && Math.abs(data[i + 2] - 79) < 30 && data[i + 3] > 120 ? 1 : 0;
    return n;
  }, [from, to]);
  assert.ok((await coloured(30, 38)) > 20);
  assert.equal(await coloured(42, 53), 0);
});

claim('check: findings with their mend, the rates and the excitation', async () => {
  const { page } = await open('check');
  assert.deepEqual(await sectionIds(page), ['verdict', 'findings', 'rates', 'excitation']);
  assert.match(await page.textContent('#verdict'), /must be mended.*1 errors, 1 warnings/s);
  assert.match(await page.textContent('#findings tbody tr'), /error.*wheel2\.speed_rad_s.*57\.3.*scale = 0\.01745/s);
});

claim('real_compare: every balance that traction compare put out can be chosen, with its numbers', async () => {
  const { page } = await open('real_compare');
  const names = await page.evaluate(() => JSON.parse(document.getElementById('result').textContent).balances.map((b) => b.name));
  assert.ok(names.length >= 4); // at least the current of each of four wheels
  assert.equal((await page.$$('#signal option')).length, names.length);
  assert.equal((await page.$$('#balances .stack tbody tr')).length, names.length);
  assert.match(await page.textContent('#verdict'), /times the sensor noise/);
  for (const id of ['ladder', 'regimes', 'details']) assert.ok((await sectionIds(page)).includes(id), id);
});

claim('method: a verdict on the paper\'s method stands beside that method, not beside ours', async () => {
  const { page, trouble } = await open('method');
  assert.deepEqual(await page.$$eval('#summary thead th', (all) => all.map((e) => e.textContent)), ['figure', 'paper', "the paper's method here", 'verdict on it', 'ours']);
  assert.deepEqual(await page.$$eval('#summary tbody tr', (all) => all.map((e) => e.querySelector('.badge').className)), ['badge odd', 'badge good']);
  assert.deepEqual(await page.$$eval('#figure-table-3 dt', (all) => all.map((e) => e.textContent)), ['paper', "the paper's method here", 'verdict on it', 'ours']);
  assert.deepEqual(trouble, []);
});

claim('compared: errors, ladders, residuals over one another, parameters and signals of several results', async () => {
  const { page, trouble } = await open('compared');
  assert.deepEqual(await sectionIds(page), ['verdict', 'ladder', 'balances', 'parameters', 'runs']);
  assert.match(await page.textContent('#verdict'), /least error is 1\.03 times the sensor noise: diagnosed/);
  assert.match(await page.textContent('#verdict'), /different logs/);
  assert.match(await page.textContent('#parameters'), /slip_sinkage: coefficient.*0\.15/s);
  assert.equal((await page.$$('#balances canvas')).length, 1);
  await page.selectOption('#signal', 'wheel0.current_A');
  assert.deepEqual(await page.$$eval('#balances .u-legend th', (all) => all.map((e) => e.textContent).filter((x) => !/time/.test(x))), ['baseline', 'diagnosed', 'other']);
  await page.selectOption('#origin', 'start');
  assert.equal(await page.$eval('.uplot', (e) => +e.dataset.range.split(' ')[0]), 0);
  assert.deepEqual(trouble, []);
});

claim('real_history: a title that ends, no duration of nothing', async () => {
  const { page } = await open('real_history');
  assert.doesNotMatch(await page.textContent('h1'), /against\s*$/);
  assert.doesNotMatch(await page.textContent('main'), /duration/);
});

claim('real_speed: a table without a word in it is not there', async () => {
  const { page } = await open('real_speed');
  assert.equal(await page.$('#summary'), null);
  assert.equal((await page.$$('.pair')).length, 0);
  assert.match(await page.textContent('main'), /mean speed/);
});

claim('compare: parts that the result lacks are absent', async () => {
  const { page } = await open('compare');
  assert.deepEqual(await sectionIds(page), ['verdict', 'ladder', 'regimes', 'balances', 'details']);
});

claim('several runs: what differs between them stands beside how they are predicted, and what agrees does not', async () => {
  const { page } = await open('runs');
  const said = await page.textContent('#validation');
  assert.match(said, /of 2 numbers of the machine 1 differs between the runs/);
  assert.match(said, /soil\.shear_slip.*0\.292.*0\.0918.*5\.5/s);
  assert.ok(!said.includes('motor.resistance_ohm'), said);
});

claim('a worst window, a drag and the keys zoom both plots alike, and the whole log comes back', async () => {
  const { page, trouble } = await open('diagnose');
  const ranges = () => page.$$eval('.u-over', (all) => all.length && new Set(all.map((e) => e.closest('.uplot').dataset.range)).size);
  const whole = await shown(page);
  await page.click('#balances summary');
  await page.click('#balances button.window');
  await page.waitForFunction(() => document.querySelector('.toolbar output').textContent === '60–65 s');
  assert.equal(await ranges(), 1);
  await page.click('.toolbar button');
  assert.equal(await shown(page), whole);
  const plot = page.locator('.u-over').first();
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.boundingBox();
  await page.mouse.move(box.x + box.width * 0.25, box.y + 60);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.5, box.y + 60, { steps: 5 });
  await page.mouse.up();
  await page.waitForFunction((before) => document.querySelector('.toolbar output').textContent !== before, whole);
  const range = () => page.$eval('.uplot', (e) => e.dataset.range.split(' ').map(Number));
  const [from, to] = await range();
  // a quarter to a half of 120 s; one pixel of the plot is about 0.11 s, two pixels at either end
  assert.ok(Math.abs(from - 30) < 0.3 && Math.abs(to - 60) < 0.3, `${from} ${to}`);
  assert.equal(await ranges(), 1);
  await page.locator('.plots').first().focus();
  await page.keyboard.press('ArrowRight');
  await page.waitForFunction((before) => document.querySelector('.uplot').dataset.range.split(' ')[0] !== String(before), from);
  const [panned] = await range();
  assert.ok(Math.abs(panned - from - (to - from) / 4) < 1e-6, `${panned}`); // a quarter of what was shown, in doubles
  await page.keyboard.press('Home');
  assert.equal(await shown(page), whole);
  assert.deepEqual(trouble, []);
});

claim('text of the data is text: markup in it is shown, not obeyed', async () => {
  const { page } = await open('odd');
  assert.equal(await page.textContent('h1'), '</script><b>"quoted" & odd</b>');
  assert.equal((await page.$$('main b')).length, 0);
});

claim('large: a log of 1000 s stands in 3 s beside a small page, its one high row is seen, zoom shows every row', async () => {
  const { ms: base } = await open('compare');
  const { ms, page, trouble } = await open('large');
  const heap = await page.evaluate(() => performance.memory?.usedJSHeapSize ?? 0);
  console.log(`      1000 s, 11 signals of 20000 rows: ${ms} ms (a small page: ${base} ms), heap ${Math.round(heap / 1e6)} MB`);
  assert.ok(ms - base <= 3000, `${ms} ms`);
  await page.selectOption('#signal', '0');
  // the one row that stands out (9.5 A) is drawn, though a screen has far fewer columns than the log rows; zoomed in, every row is there
  const drawn = () => page.$eval('.uplot', (e) => ({ most: +e.dataset.most, rows: +e.dataset.rows }));
  const far = await drawn();
  assert.equal(far.most, 9.5);
  assert.ok(far.rows < 20000, `${far.rows} rows drawn`);
  for (let i = 0; i < 6; ++i) { await page.focus('.plots'); await page.keyboard.press('+'); } // each halves what is shown
  await page.waitForFunction(() => +document.querySelector('.uplot').dataset.rows < 700);
  const [from, to] = await page.$eval('.uplot', (e) => e.dataset.range.split(' ').map(Number));
  assert.ok(Math.abs((await drawn()).rows - 20 * (to - from)) <= 3, `${(await drawn()).rows} rows over ${to - from} s`); // 20 rows a second, one more at either end
  assert.deepEqual(trouble, []);
  await picture('large', { clip: { x: 0, y: 0, width: 1280, height: 900 } });
});

claim('diagnose: prints light, within the paper, every plot on it', async () => {
  const { page } = await open('diagnose', { colorScheme: 'dark', viewport: { width: 1280, height: 900 } });
  await page.emulateMedia({ media: 'print' });
  await page.setViewportSize({ width: 680, height: 960 }); // A4 less 15 mm margins at 96 dpi
  await page.waitForFunction(() => [...document.querySelectorAll('.uplot')].every((e) => e.offsetWidth <= 680));
  assert.equal(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), 'rgb(255, 255, 255)');
  assert.ok((await overflow(page)) <= 0, `${await overflow(page)} px too wide`);
  await picture('diagnose_print');
  await page.pdf({ path: `${shots}/diagnose.pdf`, format: 'A4', printBackground: true });
  assert.ok(statSync(`${shots}/diagnose.pdf`).size > 20000); // two plots and the tables; an empty A4 page has about 1 kB
});

claim('every control has a name, every table a caption and scoped heads', async () => {
  const { page } = await open('diagnose');
  assert.equal(await page.$$eval('button', (all) => all.filter((e) => !e.textContent.trim()).length), 0);
  assert.equal(await page.$$eval('main table:not(.u-legend)', (all) => all.filter((e) => !e.caption).length), 0);
  assert.equal(await page.$$eval('main table:not(.u-legend) th', (all) => all.filter((e) => !e.scope).length), 0);
  assert.equal(await page.$$eval('svg[role=img], [role=group], [role=region]', (all) => all.filter((e) => !e.getAttribute('aria-label')).length), 0);
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
await browser.close();
console.log(`${claims.length - failed} of ${claims.length} claims hold`);
process.exit(failed ? 1 : 0);
