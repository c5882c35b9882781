// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0
// Cables that are drawn by clicks on the body of a robot file.

import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';
import {
  boxes, closePages, difference, openPage, overlaps, part, pixelsOf, probeSkin, settledPixels,
  startBrowser, until,
} from './browser.mjs';
import { startServer } from './fixture/server.mjs';
import { distanceToSurface } from './fixture/surface_distance.mjs';

const ROBOT = { name: 'four_leg' };

let browser;
let server;
before(async () => {
  browser = await startBrowser();
  server = await startServer({ robot: ROBOT, robot_file: true });
});
afterEach(() => closePages(browser));
after(async () => {
  await browser?.close();
  await server?.stop();
});

const textOf = (page) => part(page, 'new-cables-text').inputValue();
const pointsOf = (text) => text.split('=')[1].replace(/ m"$/, '').split(';')
  .map((point) => point.split(',').map(Number));
const countOf = (page) => part(page, 'new-cable-point').count();

/** A page whose body is drawn. */
async function openRobotFile(options = {}) {
  const page = await openPage(browser, server.url, options);
  await until('a legend', async () => /grid/.test(await part(page, 'legend').textContent()));
  return page;
}

/** Clicks down a line of the drawing until one more point is there; where that was, px. */
async function clickBody(page, share_x, from = 0.25) {
  const { x, y, width, height } = await part(page, 'canvas').boundingBox();
  const before_count = await countOf(page);
  for (let share = from; share < 0.9; share += 0.04) {
    const at = { x: x + share_x * width, y: y + share * height };
    await page.mouse.click(at.x, at.y);
    if (await countOf(page) > before_count) return { x: at.x - x, y: at.y - y };
  }
  return assert.fail(`no point of the body at ${share_x}`);
}

/** Half the diagonal of what is kept of a coordinate, and the coordinates' own digits. */
function tolerance_m({ rest_m }) {
  const largest_m = rest_m.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
  return Math.sqrt(3) * 0.5e-4 + 8 * 2 ** -24 * largest_m;
}

test('two clicks make the option of a cable, with both points on the surface', async () => {
  const page = await openRobotFile();
  assert.equal(await textOf(page), '');
  await clickBody(page, 0.3);
  assert.equal(await textOf(page), '', 'one point is no cable');
  await clickBody(page, 0.6);
  const text = await textOf(page);
  assert.match(text, /^--cable "cable_1=(-?\d\.\d{4},?){3}; (-?\d\.\d{4},?){3} m"$/);
  const points_m = pointsOf(text);
  const limit_m = tolerance_m(server.robot);
  for (const point_m of points_m) {
    const distance_m = distanceToSurface(point_m, server.robot);
    assert.ok(distance_m <= limit_m, `${point_m} is ${distance_m} m off the surface`);
  }
  const apart_m = Math.hypot(...points_m[0].map((x, k) => x - points_m[1][k]));
  assert.ok(apart_m > 0.02, 'the clicks were a third of the drawing apart');
  await page.done();
});

test('a point is drawn where it was clicked, and goes with undo', async () => {
  const page = await openRobotFile({ theme: 'light' });
  const at = await clickBody(page, 0.5);
  const wanted = [176, 0, 79];  // --new-cable in light
  const isDrawn = async () => {
    const { data, width } = await pixelsOf(page);
    const i = 4 * (Math.round(at.y) * width + Math.round(at.x));
    return wanted.every((value, k) => Math.abs(data[i + k] - value) < 8);
  };
  await until('a ball under the pointer', isDrawn);
  await page.keyboard.press('u');
  assert.equal(await countOf(page), 0);
  await until('no ball', async () => !(await isDrawn()));
  await page.done();
});

/** A point at the centre of the view, after it was turned. A point is chosen in what is seen. */
async function choosePointByKeys(page, turn) {
  const first = await settledPixels(page);
  await page.keyboard.press(turn);
  await until('a turned view', async () => difference(first, await pixelsOf(page)) > 0.002);
  const count = await countOf(page);
  await page.keyboard.press('p');
  assert.equal(await countOf(page), count + 1, `a point at the centre after ${turn}`);
}

test('keys alone draw two cables; the name is checked; both are copied', async () => {
  const finger = await startServer({ robot: { name: 'pneumatic_finger', cables: {} },
    robot_file: true });
  try {
    const page = await openPage(browser, finger.url);
    await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
    await until('a legend', async () => /grid/.test(await part(page, 'legend').textContent()));
    for (const turn of ['ArrowUp', 'ArrowLeft']) await choosePointByKeys(page, turn);
    await page.keyboard.press('n');
    assert.match(await part(page, 'new-cables-list').textContent(), /Drawn: cable_1/);
    for (const turn of ['ArrowUp', 'ArrowLeft']) await choosePointByKeys(page, turn);
    const name = part(page, 'new-cable-name');
    assert.equal(await name.inputValue(), 'cable_2');
    await name.fill('$(id)');
    assert.match(await part(page, 'new-cable-reason').textContent(), /letters, digits/);
    assert.equal((await textOf(page)).split('\n').length, 1, 'a cable with that name');
    await name.fill('nun');  // n and u are keys elsewhere
    assert.match((await textOf(page)).split('\n')[1], /^--cable "nun=/);
    await part(page, 'new-cables-file').click();
    assert.match(await textOf(page), /^cables:\n {2}- name: "cable_1"\n {4}path_m:\n/);
    await part(page, 'new-cables-copy').click();
    await until('copied', async () =>
      (await part(page, 'new-cables-copy').textContent()) === 'Copied');
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), await textOf(page));
    await page.done();
  } finally {
    await finger.stop();
  }
});

test('what is drawn stays when the server was away, and asks the server for nothing', async () => {
  const own = await startServer({ robot: ROBOT, robot_file: true });
  const page = await openPage(browser, own.url);
  await until('a legend', async () => /grid/.test(await part(page, 'legend').textContent()));
  await clickBody(page, 0.3);
  await clickBody(page, 0.6);
  const text = await textOf(page);
  assert.deepEqual(own.received.filter(({ kind }) => kind !== 'subscribe'), []);
  await own.stop();
  await until('no connection', () => part(page, 'banner').isVisible());
  const again = await startServer({ robot: ROBOT, robot_file: true, port: own.port });
  try {
    await until('connected', async () => !(await part(page, 'banner').isVisible()));
    assert.equal(await textOf(page), text);
  } finally {
    await again.stop();
  }
});

test('shows the fixed nodes and the cables of the file, and nothing that is measured', async () => {
  const page = await openRobotFile();
  await until('a legend', async () =>
    /cable of the robot file.*fixed/s.test(await part(page, 'legend').textContent()));
  assert.match(await part(page, 'new-cables-list').textContent(), /north, west, south, east/);
  for (const panel of ['forces', 'camera', 'processes', 'calibration', 'plot-forces']) {
    assert.equal(await part(page, `panel-${panel}`).isVisible(), false, panel);
  }
  await page.done();
});

test('a live page has no panel of new cables, and a click probes', async () => {
  const live = await startServer();
  try {
    const page = await openPage(browser, live.url);
    await until('a colour scale', () => part(page, 'colorbar').isVisible());
    live.sending = false;  // a slow machine first draws what has come
    assert.equal(await part(page, 'panel-new-cables').isVisible(), false);
    await page.keyboard.press('u');
    await page.keyboard.press('n');
    await probeSkin(page);
    assert.equal(await countOf(page), 0);
    await page.done();
  } finally {
    await live.stop();
  }
});

for (const [width, height] of [[1280, 720], [800, 900], [360, 740]]) {
  test(`nothing lies over anything else at ${width} x ${height}`, async () => {
    const page = await openRobotFile({ width, height });
    for (const share_x of [0.35, 0.6]) await clickBody(page, share_x);
    assert.deepEqual(overlaps(await boxes(page, 'header > *, .panel')), [], 'panels');
    assert.deepEqual(overlaps(await boxes(page,
      '#scene-tools > *, #colorbar, #legend, #scene .age')), [], 'over the scene');
    assert.deepEqual(overlaps(await boxes(page,
      '#new-cables .body > *')), [], 'in the panel');
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= width);
    await page.done();
  });
}
