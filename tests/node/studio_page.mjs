// node studio_page.mjs JOURNEY URL PICTURES [FILE [SECONDS]]
// Uses the page of `azee studio` in headless Chromium. JOURNEY is author, keys, pose, moved, typing,
// text or times, which ends after SECONDS at the latest.
// Prints what was seen as JSON; PICTURES is a folder for screenshots, or empty.
import { readFileSync } from 'node:fs';
import { createInterface } from 'node:readline';
import { chromium } from 'playwright-core';

const [journey, url, pictures, file = 'untitled.azee', seconds = '300'] = process.argv.slice(2);
const SLOW_MS = 120_000;
const server = await chromium.launchServer({
  executablePath: process.env.CHROMIUM,
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
    '--disable-background-networking', '--disable-component-update', '--disable-sync',
    '--disable-quic', '--no-first-run'],
});
const browser = await chromium.connect(server.wsEndpoint());
const complaints = [], foreign = [], own = [url];

async function opened(width = 1366, height = 768, search = '') {
  const query = `?file=${file}${search}`;
  const page = await browser.newPage({ viewport: { width, height }, acceptDownloads: true });
  page.setDefaultTimeout(SLOW_MS);
  page.on('pageerror', error => complaints.push(error.message));
  page.on('request', request => {
    const address = request.url();
    if (!own.some(start => address.startsWith(start)) && !/^(blob|data):/.test(address)) foreign.push(address);
  });
  await page.goto(url + query);
  await page.waitForFunction(() => window.azeeStudio?.document.file);
  return page;
}

const shot = (page, name) => pictures && page.screenshot({ path: `${pictures}/${name}.png` });
/** Waits until the newest text is signed. */
const signed = page => page.waitForFunction(() =>
  azeeStudio.sent > 0 && azeeStudio.shownNumber === azeeStudio.sent && azeeStudio.document.file);
const text = page => page.evaluate(() => azeeStudio.editor.text);
const at = (page, time) => page.evaluate(t => {
  azeeStudio.signer.play(false);
  azeeStudio.signer.seek(t);
  return azeeStudio.signer.joints();
}, time);
const farthest = (a, b) => Math.max(...Object.keys(a).map(name =>
  Math.hypot(...a[name].map((x, i) => x - b[name][i]))));

/** Returns the faults that axe-core calls serious or critical, of the page or of a part of it. */
async function faults(page, part = 'html') {
  if (!await page.evaluate(() => window.axe))
    await page.evaluate(readFileSync('node_modules/axe-core/axe.min.js', 'utf8'));
  const { violations } = await page.evaluate(within => axe.run(within), part);
  return violations.filter(({ impact }) => ['serious', 'critical'].includes(impact))
    .map(({ id, nodes }) => `${id}: ${nodes.map(node => node.target.join(' ')).join(', ')}`);
}

/** A new author: writes, errs, mends, sees, looks closer, exports, saves, comes back. */
async function author() {
  const page = await opened();
  const told = {};
  const lines = [':info-about', "    'topic", ':persone', "'info", ':âge'];
  await page.click('.cm-content');
  for (const line of lines) await page.keyboard.insertText(line).then(() => page.keyboard.press('Enter'));
  // Texts on the way to this one have other mistakes, which may be shown first.
  const mistake = '.problems li.error:has-text(":persone")';
  await page.waitForSelector(mistake);
  await page.waitForSelector('.cm-lintRange-error:has-text(":persone")');
  told.problem = await page.textContent(mistake);
  told.under = await page.textContent('.cm-lintRange-error');
  await shot(page, 'error');

  await page.click(`${mistake} button`);
  await page.keyboard.press('End');
  await page.keyboard.press('Backspace');
  await page.keyboard.insertText('ne');
  await signed(page);
  told.problems = await page.locator('.problems li').count();
  told.text = await text(page);
  const end = await page.evaluate(() => azeeStudio.signer.duration);
  told.moved_m = farthest(await at(page, 0), await at(page, end / 2));
  await shot(page, 'signed');

  await page.click('.score .block[aria-label^="INFO"]');
  told.chosen = await page.getAttribute('.score .block[aria-selected=true]', 'aria-label');
  told.lit = await page.locator('.line-chosen').allTextContents();
  await page.selectOption('select[aria-label=Speed]', '0.5');
  told.speed = await page.evaluate(() => azeeStudio.signer.speed);
  await page.selectOption('select[aria-label=Camera]', 'hands');
  await page.click('#tab-reasons');
  await page.check('.panel .check input');
  await page.waitForSelector('.reasons li');
  told.reasons = await page.locator('.reasons li').count();
  await page.waitForTimeout(300);
  await shot(page, 'reasons');

  await page.click('#tab-rules');
  await page.fill('input[type=search]', 'tree');
  await page.waitForSelector('.rules .rule:has-text(":arbre")');
  told.first_rule = await page.textContent('.rules .rule code');
  await page.waitForSelector('.rules .thumb img');
  await shot(page, 'rules');
  await page.click('#tab-blocks');
  await page.waitForSelector('.blocks [role=treeitem]');
  told.blocks = await page.locator('.blocks .block-row code').allTextContents();
  await shot(page, 'blocks');

  await at(page, 0.7 * end);
  await page.click('#tab-pose');
  await posed(page);
  await drag(page, '@I_TIP(s)', 30, -25);
  await posed(page);
  await shot(page, 'corrected');
  await page.click('.proposals button');
  told.corrected = await text(page);
  await signed(page);
  await page.click('.cm-content');
  await page.keyboard.press('Control+z');
  told.undone = await text(page);
  await page.keyboard.press('Control+y');
  await signed(page);

  const before = await at(page, 1);
  await page.click('#tab-settings');
  await page.selectOption('.panel select[aria-label=Body]', 'child');
  await signed(page);
  await page.waitForFunction(height =>
    azeeStudio.signer.joints().head?.[1] < height - 0.1, before.head[1]);
  await shot(page, 'child');

  const [download] = await Promise.all([
    page.waitForEvent('download'), page.selectOption('select[aria-label=Export]', '.bvh'),
  ]);
  told.exported = download.suggestedFilename();
  const [start] = await (await download.createReadStream()).take(1).toArray();
  told.export_begins = String(start).slice(0, 9);

  await page.click('.cm-content');
  await page.keyboard.press('Control+s');
  await page.waitForFunction(() => azeeStudio.document.state === 'saved');
  await page.reload();
  await page.waitForFunction(() => window.azeeStudio?.document.file);
  await signed(page);
  told.reloaded = await text(page);
  told.state = await page.textContent('.state');
  told.faults = await faults(page);
  for (const panel of ['blocks', 'pose', 'reasons', 'versions', 'film', 'settings']) {
    await page.click(`#tab-${panel}`);
    await page.waitForTimeout(200);
    told.faults.push(...await faults(page, '#panel'));
  }
  await page.close();
  for (const [width, height] of [[1366, 768], [1024, 768], [390, 844]]) {
    const other = await opened(width, height, width < 500 ? '&lang=fr' : '');
    await signed(other);
    await at(other, 1.9);
    await other.waitForTimeout(300);
    await shot(other, `page-${width}`);
    told.faults.push(...await faults(other));
    told[`wide_${width}`] = await other.evaluate(() => document.documentElement.scrollWidth);
    await other.close();
  }
  return told;
}

/** Drags a part of the body by the mouse, in steps; returns where it was on the page. */
async function drag(page, handle, dx, dy, steps = 12) {
  // A text that has just changed is posed anew: its parts are there when that is done.
  await page.waitForFunction(h => azeeStudio.posing.idle && azeeStudio.posing.onPage(h), handle);
  const [x, y] = await page.evaluate(h => azeeStudio.posing.onPage(h), handle);
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= steps; i++) await page.mouse.move(x + (dx * i) / steps, y + (dy * i) / steps);
  await page.mouse.up();
  return [x, y];
}
const posed = page => page.waitForFunction(() => azeeStudio.posing.idle);

/** Poses the body of a text: a hand, a palm, a finger and the face; then chooses what is written. */
async function pose() {
  const page = await opened();
  const told = {};
  await page.click('.cm-content');
  await page.keyboard.insertText('key 1\n    place @I_TIP(s) ^Mssp\n');
  await signed(page);
  await page.evaluate(() => { azeeStudio.signer.play(false); azeeStudio.signer.seek(azeeStudio.signer.duration / 2); });
  await page.selectOption('select[aria-label=Camera]', 'hands');
  await page.click('#tab-pose');
  await posed(page);
  const joints = () => page.evaluate(() => azeeStudio.signer.joints());
  const place = handle => page.evaluate(h => azeeStudio.posing.place(h), handle);
  const start = await joints(), before = await text(page), tip = await place('@I_TIP(s)');
  const [x, y] = await drag(page, '@I_TIP(s)', 70, -60, 40);
  await posed(page);
  told.wrist_m = Math.hypot(...(await joints())['wrist.R'].map((v, i) => v - start['wrist.R'][i]));
  told.under_px = await page.evaluate(([x, y]) => {
    const [a, b] = azeeStudio.posing.onPage('@I_TIP(s)');
    return Math.hypot(a - x, b - y);
  }, [x + 70, y - 60]);
  told.answers_ms = await page.evaluate(() => azeeStudio.posing.answers);
  const there = await place('@I_TIP(s)');
  told.moved_m = Math.hypot(...there.map((v, i) => v - tip[i]));
  told.proposals = await page.locator('.proposals code').allTextContents();
  await shot(page, 'pose');
  const exact = page.locator('.proposals button:has-text("point(")').first();
  told.written = await exact.locator('code').textContent();
  await exact.click();
  told.changed = await text(page);
  await signed(page);
  await posed(page);
  told.off_m = Math.hypot(...(await place('@I_TIP(s)')).map((v, i) => v - there[i]));
  await page.click('.cm-content');
  await page.keyboard.press('Control+z');
  told.undone = await text(page) === before;
  await signed(page);
  await posed(page);
  await drag(page, 'nrm !palm(s)', 30, 10);
  await posed(page);
  told.palm = await page.locator('.proposals code').first().textContent();
  await page.selectOption('select[aria-label="Fingers or face"]', "'AU12");
  await page.fill('input[aria-label=Weight]', '0.7');
  await page.dispatchEvent('input[aria-label=Weight]', 'change');
  await posed(page);
  told.face = await page.locator('.proposals code').allTextContents();
  await page.selectOption('select[aria-label="Fingers or face"]', "'index_bend s");
  await page.fill('input[aria-label=Weight]', '0.5');
  await page.dispatchEvent('input[aria-label=Weight]', 'change');
  await posed(page);
  told.finger = await page.locator('.proposals code').allTextContents();
  await page.selectOption('select[aria-label=Part]', 'gaze');
  await page.focus('select[aria-label=Part]');
  for (let i = 0; i < 5; i++) await page.keyboard.press('Alt+ArrowRight').then(() => posed(page));
  await page.keyboard.press('Enter');
  await posed(page);
  told.gaze = await page.locator('.proposals code').first().textContent();
  await shot(page, 'pose-face');
  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForTimeout(300);
  await shot(page, 'pose-390');
  told.wide_390 = await page.evaluate(() => document.documentElement.scrollWidth);
  return told;
}

/** All of it without a mouse. */
async function keys() {
  const page = await opened(1024, 768);
  const told = {};
  const press = async (...names) => { for (const name of names) await page.keyboard.press(name); };
  const focused = () => page.evaluate(() => document.activeElement?.closest('[data-part]')?.dataset.part ?? null);
  await press('F6');
  told.parts = [await focused()];
  await page.keyboard.insertText(':arbre');
  await press('Enter');
  await signed(page);
  const before = await page.evaluate(() => azeeStudio.signer.playing);
  await press('Control+Enter');
  told.toggles = before !== await page.evaluate(() => azeeStudio.signer.playing);
  await press('Control+Enter', 'Control+s');
  await page.waitForFunction(() => azeeStudio.document.state === 'saved');
  await press('F6');
  told.parts.push(await focused());
  await press('F6');
  told.parts.push(await focused());
  await press('ArrowRight', 'ArrowDown');
  told.block = await page.getAttribute('.score .block[aria-selected=true]', 'aria-label');
  await press('Enter');
  told.loops = await page.evaluate(() => azeeStudio.signer.loop !== null && azeeStudio.signer.playing);
  await shot(page, 'keys-score');
  await press('F6');
  told.parts.push(await focused());
  await press('Escape', 'Shift+Tab');
  for (let i = 0; i < 12 && !(await page.evaluate(() => document.activeElement?.id === 'tab-blocks')); i++)
    await press('Shift+Tab');
  told.tab = await page.evaluate(() => document.activeElement?.id);
  await press('Enter');
  await page.waitForSelector('.blocks [role=treeitem]');
  for (let i = 0; i < 20 && (await focused()) !== 'panel'; i++) await press('F6');
  told.parts.push(await focused());
  await press('ArrowDown');
  told.tree = await page.evaluate(() => document.activeElement?.getAttribute('role'));
  await shot(page, 'keys-blocks');
  await press('Escape');
  told.closed = await page.evaluate(() => document.querySelector('.panel').hidden);
  told.back = await page.evaluate(() => document.activeElement?.id);
  return told;
}

/** Types numbered comments and prints each; ends when the text cannot be sent, or when killed. */
async function typing() {
  const page = await opened(1024);
  await page.click('.cm-content');
  await page.keyboard.press('Control+End');
  console.log(JSON.stringify({ browser: server.process().pid }));
  for (let i = 0; i < 2000; i++) {
    await page.keyboard.insertText(`# ${i}\n`);
    console.log(JSON.stringify({ typed: i, at: Date.now() }));
    await new Promise(resolve => setTimeout(resolve, 40));
  }
  return {};
}

/** Types when the server was killed, and goes to the address of the next; both are told on stdin. */
async function moved() {
  const told = createInterface({ input: process.stdin })[Symbol.asyncIterator]();
  const page = await opened(1024);
  page.on('dialog', dialog => dialog.accept(own[1]));
  await page.click('.cm-content');
  await page.keyboard.insertText('# before\n');
  await page.waitForFunction(() => azeeStudio.document.state === 'kept');
  console.log('ready');
  await told.next();
  await page.waitForSelector('.notice[data-name=offline] button');
  await page.keyboard.insertText('# after 100 % ✓\n');
  console.log('typed');
  own.push((await told.next()).value);
  await page.click('.notice[data-name=offline] button');
  await page.waitForURL(`${own[1]}**`);
  // What the server keeps is shown first, then what was brought along.
  await page.waitForFunction(() => window.azeeStudio?.document.state === 'kept'
    && azeeStudio.editor.text.includes('after'));
  return { text: await text(page), address: page.url() };
}

/** The text that the page shows first, and what it says about it. */
async function shown() {
  const page = await opened(1024);
  await page.waitForTimeout(300);
  return { text: await text(page), notices: await page.locator('.notice').allTextContents() };
}

const WORDS = ['bonjour', 'armoire', 'bien', 'arbre', 'cinéma', 'chat'];

/**
 * Edits a sentence of two signs and tells how long each edit took to move the signer; then frames
 * and drags. What is not measured when the time is over is left out, and `during` says where it was.
 */
async function times() {
  const told = { during: 'opening the page', failure: '', edits: [], device: '', frames_ms: [], drags_ms: [] };
  const work = measured(told).catch(error => { told.failure = String(error).split('\n')[0]; });
  let timer;
  await Promise.race([work, new Promise(resolve => { timer = setTimeout(resolve, 1000 * seconds); })]);
  clearTimeout(timer);
  return structuredClone(told);
}

async function measured(told) {
  const page = await opened();
  const sentence = word => `:info-about(:personne, :${word})\n`;
  const stand = () => page.evaluate(() => {
    azeeStudio.signer.play(false);
    azeeStudio.signer.seek(azeeStudio.signer.duration / 2);
  });
  await page.click('.cm-content');
  await page.keyboard.insertText(sentence('âge'));
  await signed(page);
  for (const [kind, plays] of [['a new sign', false], ['a known sign', false], ['a known sign, playing', true]]) {
    for (const word of WORDS) {
      told.during = `editing: ${kind}`;
      await stand();
      if (plays) await page.evaluate(() => azeeStudio.signer.play(true));
      await page.waitForTimeout(700); // the palette is loaded again after an edit
      await page.evaluate(other => azeeStudio.editor.replace(other), sentence(word));
      await signed(page);
      const times = await page.evaluate(() => ({
        ...azeeStudio.latencies.at(-1), worker: azeeStudio.workerTimes.at(-1),
      }));
      told.edits.push({ kind, word, ...times });
    }
  }
  told.during = 'drawing frames';
  await stand();
  told.device = await page.evaluate(() => azeeStudio.signer.device);
  for (let i = 0; i < 40; i++)
    told.frames_ms.push(await page.evaluate(share =>
      azeeStudio.signer.timed(share * azeeStudio.signer.duration), i / 40));
  told.during = 'dragging';
  await page.click('#tab-pose');
  await posed(page);
  for (let i = 0; i < 4; i++) {
    await drag(page, '@I_TIP(s)', 40 - 20 * i, -30 + 15 * i, 40);
    await posed(page);
    told.drags_ms = await page.evaluate(() => azeeStudio.posing.answers);
  }
  told.during = null;
}

const journeys = { author, keys, pose, moved, typing, text: shown, times };
try {
  const told = await journeys[journey]();
  console.log(JSON.stringify({ ...told, complaints, foreign }));
} finally {
  await browser.close().catch(() => {});
  await server.close().catch(() => {});
}
