// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0
// The page when something is wrong, and what its controls do.

import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';
import {
  closePages, difference, openPage, part, pixelsOf, probeSkin, robotShare, settledPixels,
  startBrowser, until,
} from './browser.mjs';
import { encodeBinary } from './fixture/encode.mjs';
import { startServer } from './fixture/server.mjs';

let browser;
before(async () => (browser = await startBrowser()));
afterEach(() => closePages(browser));
after(() => browser?.close());

/** A test with a server and one page. */
function withPage(name, options, body) {
  test(name, async () => {
    const server = await startServer(options);
    try {
      const page = await openPage(browser, server.url);
      await body(page, server);
      await page.done();
    } finally {
      await server.stop();
    }
  });
}

const state = (page, panel) => part(page, `panel-${panel}`).getAttribute('data-state');
const sees = (page, id, pattern) => until(`${id}: ${pattern}`, async () =>
  pattern.test(await part(page, id).textContent()));
const hasRobot = (page) => until('a robot', async () => robotShare(await pixelsOf(page)) > 0.05);

withPage('says what it waits for, and the command to type', { silent: true }, async (page) => {
  await sees(page, 'scene-empty', /Waiting for the robot.*palpate launch demo/s);
  assert.match(await part(page, 'panel-forces').textContent(), /Waiting for forces/);
  assert.equal(await part(page, 'colorbar').isVisible(), false);
});

function spoil(message) {
  const [first, second] = message.forces;
  return { ...message, forces: [
    { ...first, status: 'unobservable', reason: 'no measured point near it', force_N: null,
      magnitude_N: null, ci95_N: null },
    { ...second, status: 'uncertain', reason: 'interval above half of the force' }] };
}

withPage('shows states of forces with their reasons, never as zero', { forces: spoil },
  async (page) => {
    await until('two forces', async () => (await part(page, 'force').count()) === 2);
    const first = part(page, 'force').first();
    const text = await first.textContent();
    assert.match(text, /no number.*unobservable no measured point near it/);
    assert.equal(await first.locator('data').count(), 0);
    const second = part(page, 'force').nth(1);
    assert.match(await second.textContent(), /± .*uncertain interval above half/);
    assert.equal(await second.getAttribute('data-usable'), 'false');
    await sees(page, 'verdict', /2 contacts, force not usable/);
  });

withPage('says why a frame has no forces',
  { forces: (it) => ({ ...it, status: 'no_calibration', reason: 'no camera pose', forces: [] }) },
  async (page) => {
    await sees(page, 'verdict', /no calibration: no camera pose/);
    assert.match(await part(page, 'forces-status').textContent(), /no calibration no camera pose/);
    assert.equal(await part(page, 'no-contact').count(), 0);
  });

withPage('says that nothing touches the robot',
  { forces: (it) => ({ ...it, forces: [] }) }, async (page) => {
    await sees(page, 'verdict', /^No contact$/);
    await until('no contact', () => part(page, 'no-contact').isVisible());
  });

withPage('greys what is old, and says how old', {}, async (page, server) => {
  await until('fresh forces', async () => (await state(page, 'forces')) === 'fresh');
  server.sending = false;
  for (const panel of ['forces', 'scene', 'camera', 'cables', 'plot-residual']) {
    await until(`${panel} stale`, async () => (await state(page, panel)) === 'stale');
  }
  assert.match(await part(page, 'age-forces').textContent(), /^[\d.]+ s old$/);
  assert.equal(await state(page, 'calibration'), 'fresh', 'it was sent once, as it should be');
  server.sending = true;
  await until('fresh again', async () => (await state(page, 'forces')) === 'fresh');
});

test('finds a server that was started again', async () => {
  let server = await startServer();
  const page = await openPage(browser, server.url);
  await until('forces', async () => (await part(page, 'force').count()) === 2);
  await server.stop();
  await sees(page, 'banner', /No connection to palpate-view/);
  assert.equal(await part(page, 'banner').getAttribute('role'), 'alert');
  await until('stale', async () => (await state(page, 'forces')) === 'stale');
  await sees(page, 'verdict', /No connection/);
  server = await startServer({ port: server.port });
  try {
    await until('connected', async () => !(await part(page, 'banner').isVisible()));
    await until('fresh', async () => (await state(page, 'forces')) === 'fresh');
    page.problems = page.problems.filter((text) => !/WebSocket connection to/.test(text));
    await page.done();
  } finally {
    await server.stop();
  }
});

test('serves three pages at once', async () => {
  const server = await startServer();
  try {
    const pages = [];
    for (let i = 0; i < 3; ++i) pages.push(await openPage(browser, server.url));
    for (const page of pages) {
      await until('fresh', async () => (await state(page, 'forces')) === 'fresh');
      await page.done();
    }
  } finally {
    await server.stop();
  }
});

withPage('a message that cannot be read is named, and the next ones are shown', {},
  async (page, server) => {
    await until('fresh', async () => (await state(page, 'forces')) === 'fresh');
    server.broadcast([Buffer.from([255, 255, 255, 255, 1, 2, 3, 4]), '{"kind":']);
    await sees(page, 'banner', /cannot be read/);
    const before = await part(page, 'force-value').first().getAttribute('value');
    await until('new numbers', async () =>
      (await part(page, 'force-value').first().getAttribute('value')) !== before);
  });

withPage('shows what was dropped, and why a process does not work', {}, async (page) => {
  await sees(page, 'drops', /^3$/);
  const table = await part(page, 'process-table').textContent();
  assert.match(table, /dropped: 3 robot cloud/);
  assert.match(table, /waits for a request/);
});

withPage('a click on the skin asks for the smallest force there', {}, async (page, server) => {
  await hasRobot(page);
  await probeSkin(page);
  await sees(page, 'probe-force', /^0\.0873 N$/);
  const { vertex } = server.received.find(({ kind }) => kind === 'probe');
  assert.ok(Number.isInteger(vertex) && vertex < server.robot.rest_m.length / 3);
  const place_mm = (await part(page, 'probe-place').textContent()).replaceAll('−', '-');
  const shown = place_mm.match(/-?[\d.]+/g).slice(0, 3).map(Number);
  const rest = [...server.robot.rest_m.subarray(3 * vertex, 3 * vertex + 3)];
  const apart_mm = Math.hypot(...rest.map((m, k) => 1000 * m - shown[k]));
  assert.ok(apart_mm < 15, `vertex ${vertex} is ${apart_mm} mm away from ${place_mm}`);
  assert.match(await part(page, 'probe-displacement').textContent(), /^[\d.]+ mm$/);
  await page.keyboard.press('Escape');
  assert.equal(await part(page, 'probe').isVisible(), false);
});

withPage('keys choose colours and parts, hold, and are listed', {}, async (page, server) => {
  await hasRobot(page);
  server.sending = false;
  const pressed = async (key, selector, attribute, value) => {
    await page.keyboard.press(key);
    await until(`${key}: ${selector} ${attribute}`, async () =>
      (await page.getAttribute(selector, attribute)) === value);
  };
  await pressed('3', '#color-stiffness', 'aria-checked', 'true');
  assert.match(await part(page, 'colorbar').getAttribute('aria-label'), /100 to 125 kPa/);
  await pressed('2', '#color-residual', 'aria-checked', 'true');
  await pressed('1', '#color-displacement', 'aria-checked', 'true');
  await pressed('c', '#show-cloud', 'aria-pressed', 'false');
  await pressed('g', '#show-ghost', 'aria-pressed', 'false');
  await pressed('l', '#show-cables', 'aria-pressed', 'false');
  await pressed('d', '#camera-depth', 'aria-pressed', 'true');
  await pressed('s', '#camera-overlay', 'aria-pressed', 'false');
  await page.keyboard.press('?');
  await until('help', () => part(page, 'help').isVisible());
  assert.match(await part(page, 'help').textContent(), /reset the view/);
  await page.keyboard.press('Escape');
  await until('no help', async () => !(await part(page, 'help').isVisible()));
  server.sending = true;
  await page.keyboard.press(' ');
  await sees(page, 'banner', /held/);
  const held = await part(page, 'force-value').first().getAttribute('value');
  await page.waitForTimeout(600);
  assert.equal(await part(page, 'force-value').first().getAttribute('value'), held);
  await page.keyboard.press(' ');
  await until('numbers again', async () =>
    (await part(page, 'force-value').first().getAttribute('value')) !== held);
});

withPage('keys turn the view while no data come', {}, async (page, server) => {
  await hasRobot(page);
  server.sending = false;
  const first = await settledPixels(page);
  for (const key of ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown', '+', '-']) {
    await page.keyboard.press(key);
    await until(`${key} turns the view`, async () =>
      difference(first, await pixelsOf(page)) > 0.01);
    await page.keyboard.press('r');
    await until(`the first view after ${key}`, async () =>
      difference(first, await pixelsOf(page)) < 0.002);
  }
  await page.keyboard.press('3');
  await until('other colours', async () => difference(first, await pixelsOf(page)) > 0.02);
});

withPage('a drawing whose end is never told does not stop the next ones', {},
  async (page, server) => {
    await hasRobot(page);
    server.sending = false;
    const first = await settledPixels(page);
    await page.evaluate(() => {
      WebGL2RenderingContext.prototype.clientWaitSync = function () {
        return this.TIMEOUT_EXPIRED;
      };
    });
    for (const key of ['ArrowLeft', 'r', 'ArrowLeft']) await page.keyboard.press(key);
    await until('a turned view', async () => difference(first, await pixelsOf(page)) > 0.01);
  });

withPage('an experiment shows markers and how far they are from the model', {
  hello: { source: 'experiment', source_name: 'exp' }, silent: true,
  player: { duration_s: 40, position_s: 10, rate: 1, paused: true, part: 'r1_hold' },
}, async (page, server) => {
  await sees(page, 'source', /experiment exp/);
  const place = Float32Array.from([0.06, 0, 0.087, 0.018, -0.02, 0.108]);
  server.broadcast([server.robot.first()[0],
    encodeBinary({ kind: 'markers', stamp_ns: '1', names: ['a', 'b'] },
      { measured_m: place, model_m: place.map((x) => x + 0.001) }),
    JSON.stringify({ kind: 'model_error', stamp_ns: '1', residual_rms_m: 0.00121, samples: 2,
      noise_rms_m: 0.0003, judgement: '' }),
    JSON.stringify({ kind: 'truth_forces', stamp_ns: '1', status: 'ok', reason: '', age_s: 0,
      latency_s: 0, forces: [{ name: 'load 1', status: 'ok', reason: 'known load',
        position_m: [0.06, 0, 0.087], force_N: [0, 0, -0.5], magnitude_N: 0.5, ci95_N: 0,
        location_ci95_m: 0 }] }),
    JSON.stringify({ kind: 'player', ...server.player })]);
  await sees(page, 'verdict', /^Markers 1\.21 mm from the model, noise 0\.300 mm$/);
  await sees(page, 'legend', /marker as measured/);
  await sees(page, 'legend', /from the model to the marker, × \d+/);
  await sees(page, 'legend', /known load/);
  await sees(page, 'truth-force', /known, load 1.*0\.500 N/);
  await sees(page, 'player-time', /^r1 hold, 0:10\.0/);
});

withPage('the keyboard reaches each control, and focus is seen', {}, async (page) => {
  await until('fresh', async () => (await state(page, 'forces')) === 'fresh');
  const reached = new Set();
  for (let i = 0; i < 24; ++i) {
    await page.keyboard.press('Tab');
    const { id, outline } = await page.evaluate(() => ({ id: document.activeElement.id,
      outline: getComputedStyle(document.activeElement).outlineStyle }));
    if (!id) continue;
    reached.add(id);
    assert.equal(outline, 'solid', `focus of ${id}`);
  }
  for (const id of ['record', 'theme', 'help-open', 'view', 'color-residual', 'show-cloud']) {
    assert.ok(reached.has(id), id);
  }
});

withPage('records, and says what is written', {}, async (page, server) => {
  await until('allowed', async () =>
    (await part(page, 'record').getAttribute('aria-disabled')) === 'false');
  await part(page, 'record').click();
  await sees(page, 'record', /12 s, 32\.0 MB/);
  assert.deepEqual(server.received.filter(({ kind }) => kind === 'record'),
    [{ kind: 'record', on: true }]);
  await part(page, 'record').click();
  await sees(page, 'record', /^Record$/);
});

withPage('says why it may not record',
  { hello: { read_only: true }, recorder: { allowed: false, reason: 'started with --read-only' } },
  async (page, server) => {
    await until('the reason', async () =>
      /read-only/.test(await part(page, 'record').getAttribute('title')));
    assert.equal(await part(page, 'record').getAttribute('aria-disabled'), 'true');
    await part(page, 'record').click({ force: true });
    await sees(page, 'banner', /Cannot record\. started with --read-only/);
    assert.equal(server.received.filter(({ kind }) => kind === 'record').length, 0);
  });

withPage('controls a player',
  { hello: { source: 'recording', source_name: 'run.mcap' },
    player: { duration_s: 40, position_s: 10, rate: 1, paused: false } },
  async (page, server) => {
    await until('a player', () => part(page, 'player').isVisible());
    assert.match(await part(page, 'source').textContent(), /recording run\.mcap/);
    assert.equal(await part(page, 'player-time').textContent(), '0:10.0 / 0:40.0');
    await page.keyboard.press(' ');
    await sees(page, 'player-pause', /Play/);
    await page.keyboard.press('.');
    await sees(page, 'player-time', /^0:15\.0/);
    await part(page, 'player-position').focus();
    await page.keyboard.press('End');
    await sees(page, 'player-time', /^0:40\.0/);
    assert.deepEqual(server.received.filter(({ kind }) => kind !== 'probe'),
      [{ kind: 'play', paused: true, rate: 1 }, { kind: 'seek', position_s: 15 },
        { kind: 'seek', position_s: 40 }]);
  });
