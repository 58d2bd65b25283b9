// node notebook_view.mjs PAGE.html TIMES PICTURE.png…
// Opens a page of azee.notebook in headless Chromium, draws it at each time into a picture, and
// prints where its joints are then and what the browser complained of. Nothing is fetched.
import { chromium } from 'playwright-core';
import { pathToFileURL } from 'node:url';

const [file, times, ...pictures] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM,
  args: ['--no-sandbox', '--disable-background-networking', '--disable-component-update',
    '--disable-sync', '--disable-quic', '--no-first-run', '--use-gl=angle',
    '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});
const complaints = [], asked = [];
try {
  const page = await browser.newPage({ viewport: { width: 600, height: 540 } });
  page.on('pageerror', error => complaints.push(error.message));
  page.on('console', message => {
    if (['error', 'warning'].includes(message.type())) complaints.push(message.text());
  });
  page.on('request', request => {
    if (!request.url().startsWith('data:')) asked.push(request.url());
  });
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction(() => typeof played === 'boolean', null, { timeout: 60_000 });
  if (!await page.evaluate(() => played)) throw Error(complaints.join('\n'));
  const joints = [];
  for (const [i, time] of times.split(',').map(Number).entries()) {
    joints.push(await page.evaluate(time => { stage.azee.stop(time); return stage.azee.joints(time); }, time));
    await page.screenshot({ path: pictures[i] });
  }
  const state = await page.evaluate(() => ({
    played, error: stage.azee.error(), hidden: stage.hidden, shown: stage.querySelector('output').textContent,
  }));
  console.log(JSON.stringify({ ...state, joints, complaints, asked: asked.slice(1) }));
} finally {
  await browser.close();
}
