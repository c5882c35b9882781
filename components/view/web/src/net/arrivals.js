// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

const KEPT = 31;
/** Nothing is stale sooner, however fast it came. */
const SHORTEST_STALE_MS = 1000;
const STALE_PERIODS = 3;
const RATE_WINDOW_MS = 2000;

/** When messages of one kind came, by the page's own clock. */
export class Arrivals {
  #times_ms = [];
  #period_ms = NaN;  // unknown before the third message
  count = 0;

  add(now_ms) {
    this.count += 1;
    this.#times_ms.push(now_ms);
    if (this.#times_ms.length > KEPT) this.#times_ms.shift();
    if (this.#times_ms.length > 2) this.#period_ms = median(gaps(this.#times_ms));
  }

  /** Since the last message; Infinity: none has come. */
  age_ms(now_ms) {
    return this.count ? now_ms - this.#times_ms.at(-1) : Infinity;
  }

  /** Messages per second over the last 2 s. */
  rate_hz(now_ms) {
    const recent = this.#times_ms.filter((time) => now_ms - time <= RATE_WINDOW_MS);
    if (recent.length < 2) return 0;
    return (1000 * (recent.length - 1)) / Math.max(now_ms - recent[0], 1);
  }

  /** Late by three usual periods, and by one second at least. */
  isStale(now_ms) {
    const limit_ms = Math.max(SHORTEST_STALE_MS, STALE_PERIODS * (this.#period_ms || 0));
    return this.age_ms(now_ms) > limit_ms;
  }
}

function gaps(times) {
  return times.slice(1).map((time, i) => time - times[i]);
}

function median(values) {
  return values.sort((a, b) => a - b)[values.length >> 1];
}
