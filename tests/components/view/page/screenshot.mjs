// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0
// An image of the live page for the documents, of a system that runs (palpate launch demo):
//   node screenshot.mjs URL OUT.png [light|dark] [WIDTHxHEIGHT] [HEADLINE]
// It waits until the headline of the page matches HEADLINE, "2 contacts" where none is given.

import { openPage, part, startBrowser, until } from './browser.mjs';

const LIMIT_MS = 120_000;
const PLOTTED_MS = 14_000;  // so that the plots have something to show

const [url, file, theme = 'light', size = '1600x900', headline = '2 contacts'] =
  process.argv.slice(2);
const [width, height] = size.split('x').map(Number);
const browser = await startBrowser();
try {
  const page = await openPage(browser, url, { width, height, theme });
  await page.waitForTimeout(PLOTTED_MS);
  await until(`the headline "${headline}"`, async () =>
    new RegExp(headline).test(await part(page, 'verdict').textContent()), LIMIT_MS);
  await page.waitForTimeout(1500);  // the drawing follows
  await page.screenshot({ path: file, fullPage: width < 1000 });
  await page.done();
} finally {
  await browser.close();
}
