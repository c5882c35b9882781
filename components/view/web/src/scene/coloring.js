// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { UpperEnd } from './scale.js';

/** What the robot's surface can be coloured by. factor: from SI units to those shown. */
export const MODES = {
  displacement: { title: 'Displacement', unit: 'mm', factor: 1e3, least: 1e-3, absent: '' },
  residual: {
    title: 'Residual', unit: 'mm', factor: 1e3, least: 5e-4,
    absent: 'The server sends no residual: no camera measures the surface.',
  },
  stiffness: {
    title: 'Stiffness', unit: 'kPa', factor: 1e-3, least: 0,
    absent: 'The server sends no stiffness: the robot file is not known to it.',
  },
};

/** Values and range of the chosen mode. */
export class Coloring {
  mode = 'displacement';
  #values = { displacement: null, residual: null, stiffness: null };
  #ends = {
    displacement: new UpperEnd(MODES.displacement.least),
    residual: new UpperEnd(MODES.residual.least),
  };

  /** @param {Float32Array | null} values by node; null: not sent */
  set(mode, values) {
    this.#values[mode] = values;
  }

  has(mode) {
    return this.#values[mode] !== null;
  }

  /** @returns {{values: Float32Array, low: number, high: number, mean: number} | null} */
  current(now_ms) {
    const values = this.#values[this.mode];
    if (!values) return null;
    const known = values.filter(Number.isFinite);
    const largest = known.reduce((a, b) => Math.max(a, b), 0);
    if (this.mode === 'stiffness') {
      const least = known.reduce((a, b) => Math.min(a, b), largest);
      return { values, low: least, high: largest, known: known.length };
    }
    this.#ends[this.mode].update(largest, now_ms);
    return { values, low: 0, high: this.#ends[this.mode].value, known: known.length };
  }
}
