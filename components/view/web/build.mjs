// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0
// Bundles src/ into dist/, which is committed and embedded in palpate-view. The same sources and
// the same package-lock.json give the same bytes.

import { build } from 'esbuild';
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const folder = dirname(fileURLToPath(import.meta.url));
const dist = join(folder, 'dist');

const BANNER = `/* SPDX-FileCopyrightText: 2026 The palpate authors
 * SPDX-License-Identifier: Apache-2.0
 * Made by components/view/web/build.mjs. Licences of three.js and uPlot: licenses.txt. */`;

function licenses() {
  const parts = ['three', 'uplot'].map((name) => {
    const read = (file) => readFileSync(join(folder, 'node_modules', name, file), 'utf8');
    return `${name} ${JSON.parse(read('package.json')).version}\n\n${read('LICENSE').trim()}\n`;
  });
  const line = `\n${'-'.repeat(80)}\n\n`;
  return `app.js and app.css hold parts of these packages.\n\n${parts.join(line)}`;
}

rmSync(dist, { recursive: true, force: true });
mkdirSync(dist);
await build({
  absWorkingDir: folder,
  entryPoints: { app: 'src/main.js' },
  outdir: 'dist',
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2022',
  charset: 'utf8',
  legalComments: 'none',
  banner: { js: BANNER, css: BANNER },
  logLevel: 'warning',
});
copyFileSync(join(folder, 'src', 'index.html'), join(dist, 'index.html'));
writeFileSync(join(dist, 'licenses.txt'), licenses());
