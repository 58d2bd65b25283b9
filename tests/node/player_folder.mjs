// node player_folder.mjs URL TEXT PICTURE.png
// Types on an exported page and notes every frame until the signer idles again.
import { opened, played } from './chromium.mjs';

const [url, text, picture] = process.argv.slice(2);
const { browser, page, complaints, foreign } = await opened(url, { width: 480, height: 720 });
try {
  const clips = [];
  page.on('request', request => { if (request.url().includes('/sign/')) clips.push(request.url()); });
  await page.waitForFunction(() => document.querySelector('#now')?.textContent === 'idle');
  await page.evaluate(() => { document.querySelector('azee-player').held = true; });
  const state = wanted => page.waitForFunction(
    wanted => document.querySelector('azee-player').state === wanted, wanted);
  await page.fill('#text', text);
  await page.press('#text', 'Enter');
  await state('waiting');
  const frames = await played(page);
  const told = await page.locator('#told li').allTextContents();
  const first = clips.length;
  await page.press('#text', 'Enter');
  await state('waiting');
  await page.evaluate(() => {
    const player = document.querySelector('azee-player');
    while (player.state !== 'playing') player.advance(0.1);
    player.pause();
    player.currentTime = player.duration / 2;
  });
  await page.waitForTimeout(500);
  await page.screenshot({ path: picture });
  const quit = await page.locator('#quit').isVisible();
  console.log(JSON.stringify({
    frames, told, clips: first, again: clips.length - first, quit, complaints, foreign,
  }));
} finally {
  await browser.close();
}
