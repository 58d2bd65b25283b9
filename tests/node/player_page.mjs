// node player_page.mjs URL PICTURES
// Uses the page of `azee play --page` in headless Chromium as a person does: types, plays, turns the
// view, errs, changes speed and body, quits. Prints what it saw.
import { chromium } from 'playwright-core';

const [url, pictures] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM,
  args: ['--no-sandbox', '--disable-background-networking', '--disable-component-update',
    '--disable-sync', '--disable-quic', '--no-first-run', '--use-gl=angle',
    '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});
const SMALL = { width: 480, height: 720 }; // what moves is drawn without a graphics card
const complaints = [], foreign = [], seen = {};
try {
  const page = await browser.newPage({ viewport: SMALL, locale: 'en' });
  page.setDefaultTimeout(120_000);
  page.on('pageerror', error => complaints.push(error.message));
  page.on('console', message => {
    if (['error', 'warning'].includes(message.type())) complaints.push(message.text());
  });
  page.on('request', request => {
    if (!request.url().startsWith(url) && !request.url().startsWith('data:')) foreign.push(request.url());
  });
  const player = page.locator('azee-player');
  const state = wanted => page.waitForFunction(
    wanted => document.querySelector('azee-player')?.state === wanted, wanted);
  const inspect = frames => player.evaluate((p, frames) => p.inspect(frames), frames);
  const picture = async (name, width = 1366, height = 768) => {
    await page.setViewportSize({ width, height });
    await page.waitForTimeout(500);
    await page.screenshot({ path: `${pictures}/${name}-${width}.png` });
    const scrolled = await page.evaluate(() => document.documentElement.scrollWidth);
    await page.setViewportSize(SMALL);
    await page.waitForTimeout(300);
    return scrolled;
  };
  const shown = () => page.waitForFunction(() => {
    const p = document.querySelector('azee-player');
    return p && !p.hasAttribute('data-loading') && p.shadowRoot?.querySelector('.bar');
  });

  await page.goto(url);
  await shown();
  await page.waitForFunction(() => document.querySelector('#now').textContent === 'idle');
  await picture('idle');

  // Every frame: when, state, what the box says, where the right palm is.
  await player.evaluate(p => {
    globalThis.frames = [];
    const note = now => {
      const joints = p.inspect().joints;
      frames.push([now / 1000, p.state, document.querySelector('#now').textContent, joints['palm.R'] ?? joints['palm_R'], p.currentTime, p.idleTime]);
      globalThis.noting = requestAnimationFrame(note);
    };
    requestAnimationFrame(note);
  });
  await page.fill('#text', 'hi!');
  await page.selectOption('#source', 'asl');
  await page.press('#text', 'Enter');
  await state('playing');
  await state('idle');
  seen.told = await page.locator('#told li').allTextContents();
  seen.frames = await page.evaluate(() => { cancelAnimationFrame(noting); return frames; });

  // The view: sideways, up and down, sideways with the middle button, the wheel.
  const box = await player.boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 3];
  seen.views = [(await inspect(0)).view];
  for (const [button, dx, dy] of [['left', 90, 0], ['left', 0, 45], ['middle', 60, 0], ['right', -90, 0]]) {
    await page.mouse.move(x, y);
    await page.mouse.down({ button });
    await page.mouse.move(x + dx, y + dy);
    await page.mouse.up({ button });
    seen.views.push((await inspect(0)).view);
  }
  await page.mouse.wheel(0, 200);
  await page.waitForTimeout(200);
  seen.views.push((await inspect(0)).view);
  await picture('turned');
  await player.locator('canvas').press('0');
  seen.views.push((await inspect(0)).view);

  // A mistake, then the same mended.
  await page.selectOption('#source', 'azee');
  await page.fill('#text', ':tree\n:nobody\n');
  await page.press('#text', 'Control+Enter');
  await page.locator('#told li').waitFor();
  seen.mistake = await page.locator('#told li').allTextContents();
  await picture('mistake');
  await page.fill('#text', ':tree\n');
  await page.click('#play');
  await state('playing');
  await player.evaluate(p => { p.pause(); p.currentTime = p.duration * 0.5; });
  await picture('playing');
  await player.evaluate(p => p.play());
  await player.locator('select').selectOption('0.1');
  const slow = async () => {
    const [time, now] = await player.evaluate(p => [p.currentTime, performance.now() / 1000]);
    return { time, now };
  };
  const a = await slow();
  await page.waitForTimeout(1500);
  const b = await slow();
  seen.slow = (b.time - a.time) / (b.now - a.now);
  await page.keyboard.press('Escape');
  await state('idle');
  await player.locator('select').selectOption('1');

  await page.selectOption('#body', 'child');
  await shown();
  await page.waitForFunction(() => document.querySelector('#now').textContent === 'idle');
  seen.widths = {};
  for (const [width, height] of [[1366, 768], [1024, 768], [390, 844]])
    seen.widths[width] = await picture('child', width, height);
  const { device, frames_ms } = await inspect(25);
  Object.assign(seen, { device, frames_ms });

  await page.goto(`${url}?lang=fr&color=skyblue&text=ami&background=studio&controls=false`);
  await page.waitForFunction(() => document.querySelector('#now').textContent === 'au repos');
  await page.waitForTimeout(500);
  seen.french = [await page.textContent('#play'), await page.inputValue('#text'), await player.locator('.bar').count()];
  await picture('french', 1024);
  await page.click('#quit');
  await page.waitForFunction(() => document.querySelector('#now').textContent.includes('terminé') || document.querySelector('#now').textContent.includes('arrêté'));
  console.log(JSON.stringify({ ...seen, complaints, foreign }));
} finally {
  await browser.close();
}
