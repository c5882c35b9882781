// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { byId, setText } from '../ui/dom.js';
import { isNumber, millimetres } from '../ui/format.js';

const UPDATE_MS = 500;  // it is read aloud, too

const BEYOND_NOISE = 2;

/** One sentence on what the system feels now. */
export class Verdict {
  #next_ms = 0;
  #experiment = false;

  constructor(feed) {
    this.node = byId('verdict');
    feed.on('hello', ({ source }) => (this.#experiment = source === 'experiment'));
    feed.on('forces', (message) => this.#take(message));
    feed.on('model_error', (message) => this.#takeResidual(message));
  }

  say(text, state) {
    setText(this.node, text);
    this.node.dataset.state = state;
  }

  /** Of an experiment the question is how well the model agrees with what was measured. */
  #takeResidual({ residual_rms_m, noise_rms_m }) {
    const now_ms = performance.now();
    if (!this.#experiment || now_ms < this.#next_ms || !isNumber(residual_rms_m)) return;
    this.#next_ms = now_ms + UPDATE_MS;
    const residual = `Markers ${millimetres(residual_rms_m)} from the model`;
    if (!isNumber(noise_rms_m)) return this.say(residual, 'calm');
    const beyond = residual_rms_m > BEYOND_NOISE * noise_rms_m;
    this.say(`${residual}, noise ${millimetres(noise_rms_m)}`, beyond ? 'touched' : 'calm');
  }

  #take({ status, reason, forces }) {
    const now_ms = performance.now();
    if (this.#experiment || now_ms < this.#next_ms) return;
    this.#next_ms = now_ms + UPDATE_MS;
    const usable = forces.filter((force) => force.status === 'ok').length;
    if (status !== 'ok' && status !== 'no_contact' && usable === 0) {
      const why = reason ? `: ${reason}` : '';
      return this.say(`Feels nothing reliable, ${status.replaceAll('_', ' ')}${why}`, 'trouble');
    }
    if (forces.length === 0) return this.say('No contact', 'calm');
    const doubtful = forces.length - usable;
    const count = (n) => `${n} ${n === 1 ? 'contact' : 'contacts'}`;
    if (doubtful === 0) return this.say(`Feels ${count(usable)}`, 'touched');
    this.say(usable ? `Feels ${count(usable)}, ${doubtful} not usable`
      : `${count(doubtful)}, force not usable`, usable ? 'touched' : 'trouble');
  }
}
