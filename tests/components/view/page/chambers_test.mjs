// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0
// The page of a robot with chambers.

import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';
import { closePages, openPage, part, pixelsOf, robotShare, startBrowser, until }
  from './browser.mjs';
import { startServer } from './fixture/server.mjs';

let browser;
before(async () => (browser = await startBrowser()));
afterEach(() => closePages(browser));
after(() => browser?.close());

function withRobot(name, robot, body) {
  test(name, async () => {
    const server = await startServer({ robot });
    try {
      const page = await openPage(browser, server.url);
      await until('a row for each actuator', async () =>
        (await rows(page)).length === Object.keys(robot.cables).length + robot.chambers.length);
      await body(page, server);
      await page.done();
    } finally {
      await server.stop();
    }
  });
}

const title = (page) => page.locator('#cables-name').textContent();
const rows = (page) => page.locator('#cables-body tr').evaluateAll((lines) =>
  lines.map((line) => [...line.children].map((cell) => cell.textContent)));

withRobot('shows volume and pressure of a chamber as they were sent, and no cables',
  { name: 'pneumatic_finger', cables: {}, chambers: ['bend'] }, async (page, server) => {
    assert.equal(await title(page), 'Chambers');
    assert.equal(await part(page, 'show-cables').isVisible(), false, 'a button for cables');
    await until('a drawing of the finger', async () => robotShare(await pixelsOf(page)) > 0.01);
    const [before] = await rows(page);
    await until('another pressure', async () => (await rows(page))[0][2] !== before[2]);
    const [[name, volume, pressure]] = await rows(page);
    assert.equal(name, 'bend');
    const [, volume_cm3] = /^(−?\d+\.\d\d) cm³$/.exec(volume) ?? [];
    const [, pressure_kPa] = /^(−?\d+\.\d\d) kPa$/.exec(pressure) ?? [];
    assert.ok(volume_cm3 && pressure_kPa, `${volume}, ${pressure}`);
    // The fixture's volume is 0.1 cm3 for each kPa.
    assert.ok(Math.abs(Number(volume_cm3) - 0.1 * Number(pressure_kPa)) < 0.006,
      `${volume} at ${pressure}`);
    server.sending = false;
    await until('a chamber that is sucked empty', async () => {
      server.broadcast([JSON.stringify({ kind: 'cables', stamp_ns: '1', cables: [],
        chambers: [{ name: 'bend', volume_m3: -2.34e-6, pressure_Pa: -12300 }] })]);
      return (await rows(page))[0].join(' ') === 'bend −2.34 cm³ −12.30 kPa';
    });
  });

withRobot('shows cables and chambers of one robot, and what is not measured as unknown',
  { name: 'four_leg', cables: { north: [0, 1] }, chambers: ['upper_left', 'lower'] },
  async (page) => {
    assert.equal(await title(page), 'Cables and chambers');
    assert.ok(await part(page, 'show-cables').isVisible());
    const [north, upper, lower] = await rows(page);
    assert.match(north.join(' '), /^north 0\.00 mm \d\.\d\d N$/);
    assert.match(upper.join(' '), /^upper left \d\.\d\d cm³ \d+\.\d\d kPa$/);
    assert.deepEqual(lower, ['lower', '–', '0.00 kPa']);
  });
