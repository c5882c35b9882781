// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import assert from 'node:assert/strict';
import { chromium } from 'playwright-core';
import { PNG } from 'pngjs';

/** Test machines have no graphics card: the processor draws. */
const FLAGS = [
  '--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
  '--disable-accelerated-2d-canvas', '--disable-gpu-rasterization',
  '--disable-gpu-compositing',
  '--disable-background-networking', '--no-first-run', '--hide-scrollbars',
];
export const LONG_MS = 20000;

export function startBrowser() {
  return chromium.launch({ executablePath: '/usr/bin/chromium', args: FLAGS });
}

/** A page of its own, with all that went wrong on it. */
export async function openPage(browser, url, { width = 1280, height = 720, theme = 'dark' } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: theme });
  context.setDefaultTimeout(LONG_MS);
  const page = await context.newPage();
  page.problems = [];
  page.on('console', (message) => {
    if (message.type() === 'error') page.problems.push(message.text());
  });
  page.on('pageerror', (error) => page.problems.push(`uncaught: ${error.message}`));
  await page.exposeFunction('tellViolation', (text) => page.problems.push(text));
  await page.addInitScript(() => addEventListener('securitypolicyviolation', (event) =>
    window.tellViolation(`policy: ${event.violatedDirective} ${event.blockedURI}`)));
  await page.goto(url);
  page.done = async () => {
    assert.deepEqual(page.problems, [], 'console errors and policy violations');
    await context.close();
  };
  return page;
}

/** Those that a failed test has left, too. */
export async function closePages(browser) {
  for (const context of browser.contexts()) await context.close();
}

export const part = (page, id) => page.locator(`[data-testid="${id}"]`);

/** Clicks on the robot: down the middle of the drawing, below the buttons over it, until a point of
 * the skin is hit. */
export async function probeSkin(page) {
  const { x, y, width, height } = await part(page, 'canvas').boundingBox();
  for (let i = 6; i < 24 && !(await part(page, 'probe').isVisible()); ++i) {
    await page.mouse.click(x + width / 2, y + (i * height) / 24);
  }
  assert.ok(await part(page, 'probe').isVisible(), 'no point of the skin was hit');
}

/** Waits until a function of the page's parts is true; the message says what was waited for. */
export async function until(what, condition, limit_ms = LONG_MS) {
  const end_ms = performance.now() + limit_ms;
  for (;;) {
    if (await condition()) return;
    if (performance.now() > end_ms) assert.fail(`waited ${limit_ms} ms: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

/** Colours of the drawing, without what lies over it. */
export async function pixelsOf(page) {
  const hide = '#scene > :not(#view) { visibility: hidden }';
  const shot = await part(page, 'canvas').screenshot({ style: hide });
  return PNG.sync.read(shot);
}

/** The drawing after it has come to rest: what is sent has stopped before. */
export async function settledPixels(page) {
  let last = await pixelsOf(page);
  for (let same = 0; same < 3;) {
    await page.waitForTimeout(300);
    const next = await pixelsOf(page);
    same = difference(last, next) === 0 ? same + 1 : 0;
    last = next;
  }
  return last;
}

/** Share of pixels that differ. */
export function difference(a, b) {
  let count = 0;
  for (let i = 0; i < a.data.length; i += 4) {
    const moved = [0, 1, 2].some((k) => Math.abs(a.data[i + k] - b.data[i + k]) > 24);
    if (moved) count += 1;
  }
  return count / (a.data.length / 4);
}

/** Pixels of the robot's colour scale, which the rest of the page has nowhere. */
export function robotShare({ data }) {
  let count = 0;
  for (let i = 0; i < data.length; i += 4) {
    const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
    if (Math.max(r, g, b) - Math.min(r, g, b) > 40) count += 1;
  }
  return count / (data.length / 4);
}

/** Rectangles of elements that are seen. */
export function boxes(page, selector) {
  return page.$$eval(selector, (nodes) => nodes
    .map((node) => {
      const { x, y, width, height } = node.getBoundingClientRect();
      return { name: node.dataset.testid ?? node.id ?? node.className, x, y, width, height };
    })
    .filter(({ width, height }) => width > 0 && height > 0));
}

/** Pairs that lie over each other by more than a rounding of pixels. */
export function overlaps(rectangles) {
  const by = (a, b, from, size) =>
    Math.min(a[from] + a[size], b[from] + b[size]) - Math.max(a[from], b[from]);
  const pairs = rectangles.flatMap((a, i) => rectangles.slice(i + 1).map((b) => [a, b]));
  return pairs.filter(([a, b]) => by(a, b, 'x', 'width') > 1 && by(a, b, 'y', 'height') > 1)
    .map(([a, b]) => `${a.name} and ${b.name}`);
}
