// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { color } from './theme.js';

export const COLOR_COUNT = 4;

const FREE_AFTER_MS = 3000;

/** The same contact has the same colour in the scene, the list and the plot. A new contact takes
 * the first colour that is free; where none is, the one that was used the longest time ago. */
export class ContactColors {
  #slots = Array.from({ length: COLOR_COUNT }, () => ({ name: null, used_ms: -Infinity }));

  /** @returns {number} from 0 to COLOR_COUNT - 1 */
  slot(name) {
    const now_ms = performance.now();
    let slot = this.#slots.findIndex((candidate) => candidate.name === name);
    if (slot < 0) {
      slot = this.#slots.findIndex(({ used_ms }) => now_ms - used_ms > FREE_AFTER_MS);
      if (slot < 0) slot = this.#longestUnused();
      this.#slots[slot].name = name;
    }
    this.#slots[slot].used_ms = now_ms;
    return slot;
  }

  #longestUnused() {
    return this.#slots.reduce((best, { used_ms }, i) =>
      (used_ms < this.#slots[best].used_ms ? i : best), 0);
  }

  /** For canvases. */
  of(name) {
    return color(`contact-${this.slot(name)}`);
  }
}
