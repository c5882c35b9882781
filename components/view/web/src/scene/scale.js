// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

/** The least of 1, 2, 5 times a power of ten that is not below x. */
export function niceAbove(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  const step = [1, 2, 5, 10].find((factor) => factor * power >= x * (1 - 1e-9));
  return step * power;
}

/** Round numbers from low to high, about `count` of them. */
export function niceTicks(low, high, count) {
  const step = niceAbove((high - low) / count);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high * (1 + 1e-9); ++i) {
    ticks.push(Number((i * step).toPrecision(12)));
  }
  return ticks;
}

const SHRINK_AFTER_MS = 4000;
const SHRINK_BELOW = 0.45;

/** The upper end of a scale from zero. It grows at once, and shrinks only after values have been
 * small for some time, so that colours and lengths keep their meaning. */
export class UpperEnd {
  #low_since_ms = NaN;

  constructor(least) {
    this.least = least;
    this.value = least;
  }

  /** @returns {boolean} whether it has changed */
  update(largest, now_ms) {
    const wanted = Math.max(niceAbove(Math.max(largest, this.least)), this.least);
    const before = this.value;
    if (wanted > this.value) {
      this.value = wanted;
    } else if (largest < SHRINK_BELOW * this.value) {
      if (Number.isNaN(this.#low_since_ms)) this.#low_since_ms = now_ms;
      if (now_ms - this.#low_since_ms > SHRINK_AFTER_MS) this.value = wanted;
    }
    if (largest >= SHRINK_BELOW * this.value || this.value !== before) this.#low_since_ms = NaN;
    return this.value !== before;
  }
}
