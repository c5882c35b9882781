// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { shownInterval } from '../scene/forces.js';
import { COLOR_COUNT } from '../ui/contact_colors.js';
import { TimePlot } from './time_plot.js';

const TRUE_LINES = 3;
const DASH = [4, 3];
const RATES_EVERY_MS = 500;
const OLDEST_S = 60;
/** Kinds whose rate is plotted, and their colours. */
const RATES = [['forces', 'line-1'], ['robot_cloud', 'line-2'], ['color_image', 'line-3']];
const RATE_LABELS = { forces: 'forces', robot_cloud: 'cloud', color_image: 'image' };

/** Forces by colour of their contact: magnitude, lower and upper end; then the true ones. */
function forceLines() {
  const lines = [];
  for (let slot = 0; slot < COLOR_COUNT; ++slot) {
    const at = lines.length;
    const look = { color: `contact-${slot}`, label: 'force' };
    lines.push({ ...look, quiet: true, width: 2, band: [at + 1, at + 2] });
    lines.push({ ...look, hidden: true }, { ...look, hidden: true });
  }
  for (let i = 0; i < TRUE_LINES; ++i) {
    lines.push({ label: 'true', color: 'truth', dash: DASH, quiet: true });
  }
  return lines;
}

/** The four plots over time. */
export class Plots {
  #truth = [];

  constructor(feed, contact_colors) {
    this.feed = feed;
    this.colors = contact_colors;
    this.forces = new TimePlot('plot-forces', forceLines(), 0.2);
    this.residual = new TimePlot('plot-residual', [
      { label: 'rms', color: 'line-1', width: 2 },
      { label: 'noise', color: 'line-4', dash: DASH },
    ], 0.2);
    this.latency = new TimePlot('plot-latency', [
      { label: 'total', color: 'line-1', width: 2 },
      { label: 'estimator', color: 'line-4', dash: DASH },
    ], 20);
    this.rates = new TimePlot('plot-rates', RATES.map(([kind, color]) =>
      ({ label: RATE_LABELS[kind], color, width: 1.75 })), 30);
    feed.on('truth_forces', ({ forces }) => (this.#truth = forces));
    feed.on('forces', (message) => this.#takeForces(message));
    feed.on('model_error', ({ stamp_ns, residual_rms_m, noise_rms_m }) =>
      this.residual.push(stamp_ns, [1e3 * residual_rms_m, 1e3 * noise_rms_m]));
    setInterval(() => this.#takeRates(), RATES_EVERY_MS);
  }

  /** A force that may not be used is a gap, never zero. */
  #takeForces({ stamp_ns, age_s, latency_s, forces }) {
    const row = forceLines().map(() => null);
    for (const force of forces) {
      if (force.status !== 'ok' || force.force_N === null) continue;
      const at = 3 * this.colors.slot(force.name);
      const half = shownInterval(force);
      row[at] = force.magnitude_N;
      row[at + 1] = Math.max(force.magnitude_N - half, 0);
      row[at + 2] = force.magnitude_N + half;
    }
    this.#truth.slice(0, TRUE_LINES).forEach((force, i) => {
      row[3 * COLOR_COUNT + i] = force.magnitude_N > 0 ? force.magnitude_N : null;
    });
    this.forces.push(stamp_ns, row);
    // The age of a frame that is played again means nothing.
    const age_ms = age_s < OLDEST_S ? 1e3 * age_s : null;
    this.latency.push(stamp_ns, [age_ms, 1e3 * latency_s]);
  }

  #takeRates() {
    const now_ms = performance.now();
    const stamp_ns = String(BigInt(Math.round(now_ms)) * 1_000_000n);
    this.rates.push(stamp_ns, RATES.map(([kind]) => this.feed.arrivals(kind).rate_hz(now_ms)));
  }
}
