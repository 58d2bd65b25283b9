// node player_page.mjs URL PICTURES
// Uses the page of `azee play --page` in headless Chromium as a person does: types, plays, turns the
// view, errs, changes speed and body, quits. Prints what it saw.
import axe from 'axe-core';
import { opened, played } from './chromium.mjs';

const [url, pictures] = process.argv.slice(2);
const SMALL = { width: 480, height: 720 }; // what moves is drawn without a graphics card
const { browser, page, complaints, foreign } = await opened(url, SMALL);
const seen = {};
try {
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
  const says = text => page.waitForFunction(
    text => document.querySelector('#now')?.textContent?.includes(text), text);

  await says('idle');
  await picture('idle');

  await player.evaluate(p => { p.held = true; });
  await page.fill('#text', 'hi!');
  await page.selectOption('#source', 'asl');
  await page.press('#text', 'Enter');
  await state('waiting');
  await page.locator('#told li').waitFor();
  seen.told = await page.locator('#told li').allTextContents();
  seen.frames = await played(page);

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
  await page.evaluate(axe.source);
  seen.inaccessible = await page.evaluate(async () => (await globalThis.axe.run()).violations
    .filter(({ impact }) => ['serious', 'critical'].includes(impact))
    .map(({ id, nodes }) => `${id}: ${nodes.map(node => node.html).join(' ')}`));
  await page.fill('#text', ':tree\n');
  await page.click('#play');
  await state('waiting');
  await player.evaluate(p => { p.pause(); p.currentTime = p.duration * 0.5; });
  await picture('playing');
  await player.evaluate(p => p.play());
  await player.locator('select').selectOption('0.1');
  seen.slow = await player.evaluate(p => {
    const before = p.currentTime;
    for (let i = 0; i < 30; i++) p.advance(1 / 30);
    return p.currentTime - before;
  });
  await page.keyboard.press('Escape');
  await state('idle');
  await player.locator('select').selectOption('1');

  await page.selectOption('#body', 'child');
  await page.waitForFunction(() => document.querySelector('azee-player').hasAttribute('data-loading'));
  await page.waitForFunction(() => !document.querySelector('azee-player').hasAttribute('data-loading'));
  seen.widths = {};
  for (const [width, height] of [[1366, 768], [1024, 768], [390, 844]])
    seen.widths[width] = await picture('child', width, height);
  const { device, frames_ms } = await inspect(25);
  Object.assign(seen, { device, frames_ms });

  await page.goto(`${url}?lang=fr&color=skyblue&text=ami&background=studio&controls=false`);
  await says('au repos');
  await page.waitForTimeout(500);
  seen.french = [await page.textContent('#play'), await page.inputValue('#text'), await player.locator('.bar').count()];
  await picture('french', 1024);
  await page.click('#quit');
  await says('arrêté');
  console.log(JSON.stringify({ ...seen, complaints, foreign }));
} finally {
  await browser.close();
}
