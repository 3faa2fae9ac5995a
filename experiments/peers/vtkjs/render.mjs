// Opens the page in Chromium: render.mjs CHROMIUM < scene.json > rgba bytes
import fs from 'node:fs';
import { text } from 'node:stream/consumers';
import puppeteer from 'puppeteer-core';

const scene = JSON.parse(await text(process.stdin));
const browser = await puppeteer.launch({
  executablePath: process.argv[2],
  headless: true,
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
});
try {
  const page = await browser.newPage();
  page.on('pageerror', (error) => console.error(error.message));
  await page.setContent('<!doctype html><html><body></body></html>');
  await page.addScriptTag({ path: new URL('../build/page.js', import.meta.url).pathname });
  const pixels = await page.evaluate((asked) => window.renderScene(asked), scene);
  fs.writeSync(1, Buffer.from(pixels));
} finally {
  await browser.close();
}
