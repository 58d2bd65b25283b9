// node study_page.mjs URL CHOICES.json SCREENSHOTS
// Takes part in a study of `azee study serve` in headless Chromium. CHOICES is a list, a choice a
// page, and `remarks`. Whenever the server is gone it waits, opens the first page again and goes on
// where that leads. Prints what the server acknowledged, and what the browser complained of.
import { chromium } from 'playwright-core';
import { readFileSync } from 'node:fs';

const [url, file, pictures] = process.argv.slice(2);
const { choices, remarks } = JSON.parse(readFileSync(file, 'utf8'));
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM,
  args: ['--no-sandbox', '--disable-background-networking', '--disable-component-update',
    '--disable-sync', '--disable-quic', '--no-first-run'],
});
const complaints = [], foreign = [], acknowledged = {}, unplayed = [];
let restarts = 0;
const gone = error => /ERR_|Timeout|closed|interrupted/.test(String(error));
try {
  const page = await browser.newPage({ viewport: { width: 1024, height: 700 } });
  page.setDefaultTimeout(5_000);
  page.on('pageerror', error => complaints.push(error.message));
  page.on('request', request => {
    if (!request.url().startsWith(url)) foreign.push(request.url());
  });
  const picture = async name => pictures && page.screenshot({ path: `${pictures}/${name}.png` });
  const next = async (button = 'form button') => {
    const from = page.url();
    await Promise.all([page.waitForURL(to => String(to) !== from), page.click(button)]);
  };

  const step = async () => {
    if (!page.url().startsWith(url)) throw Error('ERR_ no server');
    const at = new URL(page.url()).pathname;
    if (at === '/') {
      await picture('home');
      await page.check('input[name=age] >> nth=1');
      await page.check('input[name=fluency] >> nth=2');
      await next();
    } else if (at === '/instructions') {
      await picture('instructions');
      await next('#next');
    } else if (at.startsWith('/page/')) {
      const number = Number(at.split('/')[2]);
      await page.check(`#page[data-number="${number}"] input[name=choice][value=${choices[number - 1]}]`);
      if (number === 1) {
        await page.waitForFunction(() => [...document.querySelectorAll('video')]
          .every(video => video.readyState >= 2 || video.error)).catch(() => {});
        const broken = await page.evaluate(() => [...document.querySelectorAll('video')]
          .filter(video => video.readyState < 2 || video.error).map(video => video.src));
        unplayed.push(...broken);
        await picture('page');
      }
      await next();
      const now = new URL(page.url()).pathname;
      if (now === `/page/${number + 1}` || now === '/closing') acknowledged[number] = choices[number - 1];
    } else if (at === '/closing') {
      for (const [i, text] of remarks.entries()) await page.fill(`#remark-${i}`, text);
      await picture('closing');
      await next();
    } else {
      throw Error(`at ${at}: ${await page.textContent('body')}`);
    }
  };

  await page.goto(url);
  const end = Date.now() + 240_000;
  while (!page.url().endsWith('/done')) {
    if (Date.now() > end) throw Error(`stuck at ${page.url()}`);
    try {
      await step();
    } catch (error) {
      if (!gone(error)) throw error;
      restarts += 1;
      await new Promise(resolve => setTimeout(resolve, 200));
      await page.goto(url).catch(() => {});
    }
  }
  await picture('done');
  console.log(JSON.stringify({ acknowledged, restarts, unplayed, foreign, complaints }));
} finally {
  await browser.close();
}
