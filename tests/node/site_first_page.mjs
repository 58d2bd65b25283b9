// node site_first_page.mjs URL
// Opens the first page of the site and waits until its player has moved by itself; prints where a
// hand was before and after, whether the picture behind it is hidden, and complaints.
import { opened } from './chromium.mjs';

const { browser, page, complaints, foreign } = await opened(process.argv[2], { width: 900, height: 700 });
try {
  await page.waitForFunction(() => document.querySelector('azee-player').state === 'playing');
  const player = page.locator('azee-player').first();
  const hand = () => player.evaluate(p => p.inspect().joints['wrist.R']);
  const before = await hand();
  await page.waitForFunction(() => document.querySelector('azee-player').currentTime > 0.6);
  const after = await hand();
  const hidden = await page.locator('azee-player > img').isHidden();
  console.log(JSON.stringify({ before, after, hidden, complaints, foreign }));
} finally {
  await browser.close();
}
