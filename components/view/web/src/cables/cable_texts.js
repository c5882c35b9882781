// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

const DECIMALS = 4;  // tenths of a millimetre

const numbers = (point_m, separator) => point_m.map((x) => x.toFixed(DECIMALS)).join(separator);

/** Options of `palpate new-robot`, one for each cable. A name has no sign that a shell reads.
 * @param {{name: string, points_m: number[][]}[]} cables */
export function optionsText(cables) {
  return cables.map(({ name, points_m }) =>
    `--cable "${name}=${points_m.map((point_m) => numbers(point_m, ',')).join('; ')} m"`)
    .join(' \\\n');
}

/** Lines of a robot file.
 * @param {boolean} has_cables the file has the key `cables` already */
export function robotFileText(cables, has_cables) {
  const lines = cables.map(({ name, points_m }) => `  - name: "${name}"\n    path_m:\n` +
    points_m.map((point_m) => `      - [${numbers(point_m, ', ')}]\n`).join(''));
  return (cables.length > 0 && !has_cables ? 'cables:\n' : '') + lines.join('');
}
