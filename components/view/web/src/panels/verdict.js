// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { byId, setText } from '../ui/dom.js';

const UPDATE_MS = 500;  // it is read aloud, too

/** One sentence on what the system feels now. */
export class Verdict {
  #next_ms = 0;

  constructor(feed) {
    this.node = byId('verdict');
    feed.on('forces', (message) => this.#take(message));
  }

  say(text, state) {
    setText(this.node, text);
    this.node.dataset.state = state;
  }

  #take({ status, reason, forces }) {
    const now_ms = performance.now();
    if (now_ms < this.#next_ms) return;
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
