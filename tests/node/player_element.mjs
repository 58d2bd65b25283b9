// node player_element.mjs URL TIMES PICTURE.png
// Opens a page with <azee-player src="…"> and seeks to times of its clip; prints where joints are
// then, what settings do, and milliseconds a frame.
import { opened } from './chromium.mjs';

const [url, times, picture] = process.argv.slice(2);
const { browser, page, complaints, foreign } = await opened(url, { width: 900, height: 700 });
try {
  const player = page.locator('azee-player').first();
  await page.waitForFunction(() => document.querySelector('azee-player').duration > 0);
  const joints = [];
  for (const time of times.split(',').map(Number))
    joints.push(await player.evaluate((p, time) => {
      p.currentTime = time;
      return p.inspect().joints;
    }, time));
  await page.screenshot({ path: picture });
  const state = await player.evaluate(p => ({ state: p.state, paused: p.paused, duration: p.duration }));
  const names = await player.evaluate(p => {
    const heard = [];
    p.addEventListener('azee-sign', event => heard.push(event.detail.label?.text ?? null));
    for (let t = 0; t <= p.duration; t += 0.1) p.currentTime = t;
    return heard;
  });
  const { device, frames_ms } = await player.evaluate(p => p.inspect(12));
  await player.evaluate(p => {
    p.setAttribute('color', 'skyblue');
    p.setAttribute('speed', '7');
    p.setAttribute('position', '0.5,0,0');
  });
  await page.waitForTimeout(300);
  const after = await player.evaluate(p => ({ speed: p.speed, joints: p.inspect().joints }));
  const text = await page.evaluate(() => document.body.innerText);
  console.log(JSON.stringify({
    joints, ...state, names, device, frames_ms, speed: after.speed, moved: after.joints, text,
    complaints, foreign,
  }));
} finally {
  await browser.close();
}
