// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { byId, setText } from './dom.js';
import { duration } from './format.js';

/** Which message each panel lives on. */
const PANELS = {
  scene: 'mesh_state', forces: 'forces', camera: 'color_image', processes: 'health',
  cables: 'cables', calibration: 'calibration', 'plot-forces': 'forces',
  'plot-residual': 'model_error', 'plot-latency': 'forces', 'plot-rates': 'client',
};
/** Comes when it changes: old is not stale, as long as there is a connection. */
const LATCHED = new Set(['calibration']);
const UPDATE_MS = 200;

/** Writes the age of each panel's data in its corner, and greys the panel where they are stale. */
export class Freshness {
  open = false;
  paused = false;

  constructor(feed) {
    this.feed = feed;
    /** The kind of image that is shown. */
    this.camera_kind = 'color_image';
    setInterval(() => this.update(), UPDATE_MS);
  }

  update() {
    const now_ms = performance.now();
    for (const [id, kind] of Object.entries(PANELS)) {
      const used = id === 'camera' ? this.camera_kind : kind;
      this.#show(byId(id), this.feed.arrivals(used), LATCHED.has(kind), now_ms);
    }
  }

  #show(panel, arrivals, latched, now_ms) {
    const came = arrivals.count > 0;
    const late = latched ? false : arrivals.isStale(now_ms);
    const stale = came && (!this.open || (late && !this.paused));
    const state = !came ? 'empty' : stale ? 'stale' : 'fresh';
    if (panel.dataset.state !== state) panel.dataset.state = state;
    const age = panel.querySelector('.age');
    if (!came || (latched && this.open)) return setText(age, '');
    if (this.paused && this.open && late) return setText(age, 'held');
    setText(age, duration(arrivals.age_ms(now_ms) / 1000) + (stale ? ' old' : ''));
  }
}
