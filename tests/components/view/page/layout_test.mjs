// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0
// Nothing lies over anything else, at each size and in both themes.

import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';
import {
  boxes, closePages, openPage, overlaps, part, probeSkin, startBrowser, until,
} from './browser.mjs';
import { startServer } from './fixture/server.mjs';

const SIZES = [[1280, 720], [1920, 1080], [800, 900], [360, 740]];
const OVER_THE_SCENE = '#scene-tools > *, #colorbar, #legend, #probe, #player, #scene .age';

let browser;
let server;
before(async () => {
  browser = await startBrowser();
  const player = { duration_s: 40, position_s: 10, rate: 1, paused: false };
  server = await startServer({ player });
});
afterEach(async () => {
  server.sending = true;
  await closePages(browser);
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

async function check(page, width, height) {
  assert.deepEqual(overlaps(await boxes(page, 'header > *, .panel')), [], 'panels');
  assert.deepEqual(overlaps(await boxes(page, 'header > :not(.buttons), .buttons > *')), []);
  assert.deepEqual(overlaps(await boxes(page, OVER_THE_SCENE)), [], 'over the scene');
  const { scroll_width, scroll_height } = await page.evaluate(() => ({
    scroll_width: document.documentElement.scrollWidth,
    scroll_height: document.documentElement.scrollHeight }));
  assert.ok(scroll_width <= width, `${scroll_width} px wide`);
  if (width >= 1280) assert.ok(scroll_height <= height, `${scroll_height} px high`);
  for (const { name, width: w, height: h } of await boxes(page, '.panel')) {
    assert.ok(w >= 140 && h >= 70, `${name}: ${w} x ${h} px`);
  }
}

for (const [width, height] of SIZES) {
  for (const theme of ['light', 'dark']) {
    test(`${width} x ${height}, ${theme}`, async () => {
      const page = await openPage(browser, server.url, { width, height, theme });
      await until('a legend', async () => /grid/.test(await part(page, 'legend').textContent()));
      await until('processes', async () => (await part(page, 'process').count()) > 3);
      await until('a player', () => part(page, 'player').isVisible());
      server.sending = false;  // a slow machine first draws what has come
      await probeSkin(page);
      await until('its force', async () =>
        /N$/.test(await part(page, 'probe-force').textContent()));
      const background = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
      const lightness = Math.max(...background.match(/\d+/g).map(Number));
      assert.equal(lightness < 128 ? 'dark' : 'light', theme);
      await check(page, width, height);
      await page.done();
    });
  }
}

test('the theme that was chosen stays, and the page follows a new size', async () => {
  const page = await openPage(browser, server.url, { theme: 'light' });
  const theme = () => page.evaluate(() => document.documentElement.dataset.theme);
  await part(page, 'theme').click();
  assert.equal(await theme(), 'dark');
  await page.reload();
  assert.equal(await theme(), 'dark');
  await until('a legend', async () => /grid/.test(await part(page, 'legend').textContent()));
  await page.setViewportSize({ width: 1920, height: 1080 });
  await until('a larger drawing', async () =>
    (await part(page, 'canvas').evaluate((canvas) => canvas.width)) > 1200);
  await check(page, 1920, 1080);
  await page.done();
});
