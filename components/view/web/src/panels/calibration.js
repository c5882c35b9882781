// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { byId, element, replaceIfChanged } from '../ui/dom.js';
import { duration, isNumber, millimetres, place, secondsBetween } from '../ui/format.js';

const UPDATE_MS = 1000;  // the age is counted on

/** State of the last request, and what is known since when. */
export class CalibrationPanel {
  #last = null;
  #server_ahead_ns = 0n;

  constructor(feed) {
    this.body = byId('calibration-body');
    feed.on('hello', ({ server_time_ns }) => {
      this.#server_ahead_ns = BigInt(server_time_ns) - BigInt(Date.now()) * 1_000_000n;
      this.#last = null;
      this.#show();
    });
    feed.on('calibration', (message) => {
      this.#last = message;
      this.#show();
    });
    setInterval(() => this.#show(), UPDATE_MS);
    this.#show();
  }

  #show() {
    if (!this.#last) {
      return replaceIfChanged(this.body, element('p', { class: 'empty' },
        'No calibration received. Settings and files apply.'));
    }
    const it = this.#last;
    const rows = [];
    const add = (name, value) => rows.push(element('dt', {}, name), element('dd', {}, value));
    if (it.state) add('state', this.#state(it));
    if (it.found_ns && it.found_ns !== '0') {
      const now_ns = BigInt(Date.now()) * 1_000_000n + this.#server_ahead_ns;
      add('found', `${duration(secondsBetween(it.found_ns, String(now_ns)))} ago`);
    }
    if (isNumber(it.residual_rms_m)) add('residual', millimetres(it.residual_rms_m));
    if (it.has_camera && it.T_robot_camera) {
      add('camera at', `${place(it.T_robot_camera.translation_m)} mm`);
    } else if (it.has_camera === false) {
      add('camera', 'pose not part of it');
    }
    replaceIfChanged(this.body, element('dl', {}, ...rows),
      it.reason ? element('p', { class: 'why' }, it.reason) : null);
  }

  #state({ state, frames_taken, frames_wanted }) {
    return frames_wanted > 0 && state === 'collecting'
      ? `${state}, frame ${frames_taken} of ${frames_wanted}` : state;
  }
}
