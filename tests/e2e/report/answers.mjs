// answers.mjs CHROMIUM FOLDER OUT - what the pages FOLDER/SEED/report.html answer to the five questions, from their text, against
// FOLDER/SEED/sealed.json. Exit 1 where an answer is missing, names another effect than was hidden, or the page tells another seal.
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const [executablePath, folder, out] = process.argv.slice(2);
const questions = ['Is the model good enough?', 'What is missing?', 'How sure is that?', 'What is left, and why?', 'What next?'];
const browser = await chromium.launch({ executablePath, args: ['--headless', '--no-sandbox', '--disable-gpu', '--no-first-run', '--disable-background-networking'] });
const faults = [], rows = [], bodies = [];
const seeds = readdirSync(folder).filter((name) => /^\d+$/.test(name)).sort((a, b) => a - b);
for (const seed of seeds) {
  const page = await browser.newPage();
  await page.goto(pathToFileURL(`${folder}/${seed}/report.html`).href);
  await page.waitForSelector('html[data-ready=yes]');
  const pairs = (id) => page.$$eval(`#${id} .answers > div`, (all) => Object.fromEntries(all.map((e) => {
    const words = e.querySelector('dd').cloneNode(true); // without what stands in the drawings
    words.querySelectorAll('svg').forEach((drawing) => drawing.remove());
    return [e.querySelector('dt').textContent, words.textContent.trim()];
  })));
  const answers = await pairs('verdict'), seal = await pairs('seal');
  await page.close();
  const hidden = JSON.parse(readFileSync(`${folder}/${seed}/sealed.json`, 'utf8')).effects[0], missing = answers['What is missing?'] ?? '';
  const fault = (words) => faults.push(`seed ${seed}: ${words}`);
  for (const question of questions) if (!answers[question]) fault(`no answer to "${question}"`);
  if (!(seal['Hidden in the drive'] ?? '').startsWith(hidden.name)) fault(`the page's seal is not ${hidden.name}`);
  const silent = missing.startsWith('Nothing');
  const words = missing.split(/[^a-z_0-9]+/); // whole names only
  if (!silent && !words.includes(hidden.name)) fault(`${hidden.name} was hidden, and the page says: ${missing}`);
  if (!silent && /said beforehand|found nothing|wrong/.test(seal.Judgement)) fault(`the judgement does not fit the answer: ${seal.Judgement}`);
  // strengths that the page tells with an interval, against the seal
  const sizes = Object.entries(hidden.parameters).map(([key, p]) => {
    const told = new RegExp(`\\b${key} = (\\S+) \\[(\\S+), (\\S+)\\]`).exec(missing);
    return told && !silent ? `${key} ${told[1]} [${told[2]}, ${told[3]}], sealed ${p.value.toPrecision(4)}: ${p.value >= +told[2] && p.value <= +told[3] ? 'inside' : 'outside'}` : null;
  }).filter(Boolean);
  rows.push(`| ${seed} | ${seal['Hidden in the drive']} | ${silent ? 'nothing' : seal['The answer']} | ${sizes.join('; ') || '-'} | ${seal.Judgement.replace(/^(✔ right|not named) /, '')} |`);
  bodies.push(`## Seed ${seed}\n\n${questions.map((q) => `- **${q}** ${answers[q]}`).join('\n')}\n`);
}
await browser.close();
const named = rows.filter((row) => !/\| nothing \|/.test(row)).length;
writeFileSync(out, `# What the demo's page answers, seeds 1 to 10

The text of each page, read in Chromium and checked against the seal, by the command
\`sh tests/e2e/report/five_answers.sh build/host/host_tools/cli/traction build/host/tests/e2e/report/browser docs/demo_answers.md\`
(after \`ctest --preset host -R report_browser_test\`). An effect is named for ${named} of ${rows.length}; on the others the page says that nothing was found, and never that all is well.

| seed | hidden | named | size [95 %] | judgement |
|---|---|---|---|---|
${rows.join('\n')}

${bodies.join('\n')}`);
for (const fault of faults) console.log(fault);
console.log(`${seeds.length} pages, ${named} with a name, ${faults.length} faults`);
process.exit(faults.length ? 1 : 0);
