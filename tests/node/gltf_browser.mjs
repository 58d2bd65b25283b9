// node gltf_browser.mjs FILE.glb TIMES STEP PICTURE.png
// Loads a GLB with three.js in headless Chromium, draws it, and prints what `probe` finds there.
// CHROMIUM names the browser's program. Serves its files on the loopback interface only.
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import { chromium } from 'playwright-core';

const [file, times, step, picture] = process.argv.slice(2);
const types = { '.html': 'text/html', '.js': 'text/javascript', '.glb': 'model/gltf-binary' };
const server = http.createServer((request, response) => {
  const name = decodeURIComponent(request.url.split('?')[0]);
  const source = name === '/clip.glb' ? file : path.join(import.meta.dirname, path.normalize(name));
  fs.readFile(source, (error, data) => {
    response.writeHead(error ? 404 : 200, { 'content-type': types[path.extname(name)] ?? '' });
    response.end(data);
  });
});
await new Promise(ready => server.listen(0, '127.0.0.1', ready));

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM,
  args: ['--no-sandbox', '--disable-background-networking', '--disable-component-update',
    '--disable-sync', '--disable-quic', '--no-first-run', '--use-gl=angle',
    '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});
const complaints = [];
try {
  const page = await browser.newPage({ viewport: { width: 480, height: 480 } });
  page.on('pageerror', error => complaints.push(error.message));
  page.on('console', message => {
    if (['error', 'warning'].includes(message.type())) complaints.push(message.text());
  });
  const address = `http://127.0.0.1:${server.address().port}`;
  await page.goto(`${address}/viewer.html?times=${times}&step=${step}`);
  await page.waitForFunction(() => window.found !== undefined, null, { timeout: 120_000 });
  const found = await page.evaluate(() => window.found);
  await page.screenshot({ path: picture });
  console.log(JSON.stringify({ ...found, complaints }));
} finally {
  await browser.close();
  server.close();
}
