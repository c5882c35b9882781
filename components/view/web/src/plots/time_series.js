// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

const GAP_S = 1.5;  // longer: the line is broken

/** Values over the time of their stamps, the last `window_s` of them. */
export class TimeSeries {
  #origin_ns = null;

  /** @param {number} columns values at each time */
  constructor(columns, window_s) {
    this.window_s = window_s;
    this.times_s = [];
    this.columns = Array.from({ length: columns }, () => []);
  }

  /** @param {string} stamp_ns @param {(number | null)[]} values null: a gap */
  push(stamp_ns, values) {
    this.#origin_ns ??= BigInt(stamp_ns);
    const time_s = Number(BigInt(stamp_ns) - this.#origin_ns) / 1e9;
    const last_s = this.times_s.at(-1);
    // A player that has jumped back, or a system that was started again.
    if (time_s < last_s || time_s > last_s + this.window_s) {
      this.clear();
      return this.push(stamp_ns, values);
    }
    if (time_s === last_s) return;
    if (time_s > last_s + GAP_S) this.#append(last_s + 0.5 * GAP_S, this.columns.map(() => null));
    this.#append(time_s, values);
    this.#forget(time_s - this.window_s);
  }

  clear() {
    this.#origin_ns = null;
    this.times_s = [];
    this.columns = this.columns.map(() => []);
  }

  /** As uPlot takes it: times before the newest, then the columns. */
  table() {
    const newest_s = this.times_s.at(-1);
    return [this.times_s.map((time) => time - newest_s), ...this.columns];
  }

  #append(time_s, values) {
    this.times_s.push(time_s);
    this.columns.forEach((column, i) => column.push(values[i]));
  }

  #forget(before_s) {
    const keep = this.times_s.findIndex((time) => time >= before_s);
    if (keep < 30) return;  // in lots: each removal moves all that is kept
    this.times_s.splice(0, keep);
    for (const column of this.columns) column.splice(0, keep);
  }
}
