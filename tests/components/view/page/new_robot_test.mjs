// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0
// From a mesh to a robot with a cable by two clicks, by the commands of the tutorial. palpate's
// programs are in PALPATE_PROGRAM_DIR.

import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { copyFileSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { openPage, part, startBrowser, until } from './browser.mjs';
import { readSurface } from './fixture/gmsh_surface.mjs';
import { distanceToSurface } from './fixture/surface_distance.mjs';

const SOURCES = process.env.PALPATE_SOURCE_DIR;
const PALPATE = join(process.env.PALPATE_PROGRAM_DIR, 'palpate');
/** Half the diagonal of what is kept of a coordinate, and the digits of single precision. */
const ROUNDING_M = Math.sqrt(3) * 0.5e-4 + 1e-7;
const MESH = 'four_leg.msh';

/** The address that `palpate view` prints. */
async function addressOf(view) {
  let output = '';
  view.stdout.on('data', (data) => (output += data));
  await until('the address of the page', () => /http:\S+/.test(output));
  return /http:\S+/.exec(output)[0];
}

/** Two points of the body: down two lines of the drawing until each has met it. */
async function clickTwice(page) {
  const { x, y, width, height } = await part(page, 'canvas').boundingBox();
  for (const [count, share_x] of [[1, 0.42], [2, 0.58]]) {
    for (let share = 0.25; await part(page, 'new-cable-point').count() < count; share += 0.04) {
      assert.ok(share < 0.9, `point ${count}: the body was not met`);
      await page.mouse.click(x + share_x * width, y + share * height);
    }
  }
}

const cablePath = (robot_file, name) => {
  const text = readFileSync(robot_file, 'utf8').split(`name: "${name}"\n`)[1];
  const [path] = /path_m:\n(?:\s*- \[.*\]\n)+/.exec(text);
  return [...path.matchAll(/\[(.*)\]/g)].map(([, numbers]) => numbers.split(',').map(Number));
};

test('a mesh becomes a robot with a cable that was clicked', { timeout: 240_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), 'palpate-new-robot-'));
  const run = (...words) => execFileSync(PALPATE, words, { cwd: folder, encoding: 'utf8' });
  copyFileSync(join(SOURCES, 'config/robots/four_leg.msh'), join(folder, MESH));
  const browser = await startBrowser();
  let view;
  try {
    assert.match(run('new-robot', MESH, '--unit', 'mm', '--yes'),
      /palpate view four_leg\/robot\.yaml/);
    view = spawn(PALPATE, ['view', 'four_leg/robot.yaml', '--set', 'http.port=0',
      '--set', 'foxglove.enabled=false'], { cwd: folder, stdio: ['ignore', 'pipe', 'inherit'] });
    const page = await openPage(browser, await addressOf(view));
    await until('a legend', async () => /fixed/.test(await part(page, 'legend').textContent()));
    await clickTwice(page);
    await part(page, 'new-cable-name').fill('pull');
    const option = await part(page, 'new-cables-text').inputValue();
    const [, words] = /^--cable "(.*)"$/.exec(option);
    await page.done();
    run('new-robot', MESH, '--unit', 'mm', '--yes', '--force', '--cable', words);
    const clicked_m = words.split('=')[1].replace(/ m$/, '').split(';')
      .map((point) => point.split(',').map(Number));
    const path_m = cablePath(join(folder, 'four_leg/robot.yaml'), 'pull');
    assert.deepEqual([path_m[0], path_m.at(-1)], clicked_m);
    const surface = readSurface(join(folder, MESH), 1e-3);
    for (const point_m of clicked_m) {
      assert.ok(distanceToSurface(point_m, surface) <= ROUNDING_M, point_m.join());
    }
    assert.match(run('info', 'four_leg/robot.yaml'), /pull/);
  } finally {
    view?.kill('SIGINT');
    await browser.close();
    rmSync(folder, { recursive: true });
  }
});
