// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0
// The page with a server that behaves: loading, data, numbers, pictures.

import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';
import { closePages, openPage, part, pixelsOf, robotShare, startBrowser, until }
  from './browser.mjs';
import { startServer } from './fixture/server.mjs';

const PANELS = ['scene', 'forces', 'camera', 'processes', 'cables', 'calibration', 'plot-forces',
  'plot-residual', 'plot-latency', 'plot-rates'];
const LOAD_LIMIT_MS = 3000;

let browser;
let server;
before(async () => {
  browser = await startBrowser();
  server = await startServer();
});
afterEach(() => closePages(browser));
after(async () => {
  await browser?.close();
  await server?.stop();
});

/** A number with three significant digits, and the interval with its decimals. */
function assertShows(text, magnitude_N, ci95_N) {
  const [, value, interval] = /^(\d+\.\d+) ± (\d+\.\d+) N$/.exec(text) ?? [];
  assert.ok(value, `"${text}" is no force with an interval`);
  const decimals = value.split('.')[1].length;
  assert.equal(value.replace('.', '').replace(/^0+/, '').length, 3, `digits of ${text}`);
  const half_unit = 0.5 * 10 ** -decimals * (1 + 1e-9);
  assert.ok(Math.abs(Number(value) - magnitude_N) <= half_unit, `${text}: sent ${magnitude_N}`);
  assert.ok(Math.abs(Number(interval) - ci95_N) <= half_unit, `${text}: sent ${ci95_N}`);
}

test('loads, shows each panel, and receives what is sent at 30 Hz', async () => {
  const page = await openPage(browser, 'about:blank');
  let received = 0;
  const frames_before = server.robot.counter;
  page.on('websocket', (socket) => socket.on('framereceived', ({ payload }) => {
    if (typeof payload === 'string' && payload.startsWith('{"kind":"forces"')) received += 1;
  }));
  await page.goto(server.url);
  const load_ms = await page.evaluate(() =>
    performance.getEntriesByType('navigation')[0].loadEventEnd);
  assert.ok(load_ms > 0 && load_ms < LOAD_LIMIT_MS, `loaded after ${load_ms} ms`);
  for (const panel of PANELS) assert.ok(await part(page, `panel-${panel}`).isVisible(), panel);
  await until('frames', () => received > 10);
  const sent_before = server.robot.counter;
  await until('3 s of frames', () => server.robot.counter > sent_before + 90);
  await until('a rate of about 30 Hz', async () => {
    const values = await part(page, 'panel-plot-rates').locator('.values').textContent();
    const shown_hz = Number(/forces ([\d.]+)/.exec(values)?.[1]);
    return shown_hz > 24 && shown_hz < 36;
  });
  server.sending = false;
  const sent = server.robot.counter - frames_before;
  await until(`each of ${sent} frames`, () => received === sent);
  server.sending = true;
  await page.done();
});

test('shows the numbers that were sent, with three digits and their intervals', async () => {
  const page = await openPage(browser, server.url);
  await until('forces', async () => (await part(page, 'force-value').count()) === 2);
  server.sending = false;
  const { forces } = server.sent_forces;
  await until('the last numbers', async () =>
    (await part(page, 'force-value').first().getAttribute('value')) ===
      String(forces[0].magnitude_N));
  for (const [i, force] of forces.entries()) {
    const value = part(page, 'force-value').nth(i);
    assert.equal(Number(await value.getAttribute('value')), force.magnitude_N);
    assertShows(await value.textContent(), force.magnitude_N, force.ci95_N);
  }
  assert.match(await part(page, 'verdict').textContent(), /2 contacts/);
  server.sending = true;
  await page.done();
});

test('draws the robot, and the images of the camera', async () => {
  const page = await openPage(browser, server.url);
  await until('a colour scale', () => part(page, 'colorbar').isVisible());
  await until('a drawing of the robot', async () => robotShare(await pixelsOf(page)) > 0.05);
  const colors = await part(page, 'camera-image').evaluate(async (canvas) => {
    while (!canvas.width) await new Promise(requestAnimationFrame);
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    return new Set(new Uint32Array(data.buffer)).size;
  });
  assert.ok(colors > 20, `${colors} colours in the image`);
  assert.match(await part(page, 'legend').textContent(), /0\.1 N = [\d.]+ mm/);
  await page.done();
});
