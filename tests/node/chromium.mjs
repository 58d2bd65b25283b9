// Headless Chromium that draws WebGL without a graphics card and asks nobody but the page's server.
import { chromium } from 'playwright-core';

/** Opens a page; returns it, what the browser complained of, and addresses of others it asked. */
export async function opened(url, viewport) {
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM,
    args: ['--no-sandbox', '--disable-background-networking', '--disable-component-update',
      '--disable-sync', '--disable-quic', '--no-first-run', '--use-gl=angle',
      '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });
  const complaints = [], foreign = [];
  const page = await browser.newPage({ viewport, locale: 'en' });
  page.setDefaultTimeout(120_000);
  page.on('pageerror', error => complaints.push(error.message));
  page.on('console', message => {
    if (['error', 'warning'].includes(message.type())) complaints.push(message.text());
  });
  page.on('request', request => {
    const to = request.url();
    if (!to.startsWith(url) && !/^(data|blob):/.test(to)) foreign.push(to);
  });
  await page.goto(url);
  return { browser, page, complaints, foreign };
}

/**
 * Lets a player that waits for the end of its idle loop play to the end, 30 frames a second whatever
 * the machine does. Returns of every frame: state, what is signed, right wrist, times.
 */
export const played = page => page.evaluate(() => {
  const player = document.querySelector('azee-player'), frames = [];
  const note = () => frames.push({
    state: player.state, sign: document.querySelector('#now').textContent,
    wrist: player.inspect().joints['wrist.R'], time: player.currentTime, idle: player.idleTime,
  });
  note();
  while (frames.length < 1500 && !(player.state === 'idle' && frames.at(-1).state === 'idle')) {
    player.advance(1 / 30);
    note();
  }
  return frames;
});
