// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { color } from './theme.js';

export const COLOR_COUNT = 4;

/** The same contact has the same colour in the scene, the list and the plot. A new contact takes
 * the colour that has been unused for the longest time. */
export class ContactColors {
  #slots = Array.from({ length: COLOR_COUNT }, () => ({ name: null, used: 0 }));
  #use = 0;

  /** @returns {number} from 0 to COLOR_COUNT - 1 */
  slot(name) {
    this.#use += 1;
    let slot = this.#slots.findIndex((candidate) => candidate.name === name);
    if (slot < 0) {
      slot = this.#slots.reduce((best, candidate, i) =>
        (candidate.used < this.#slots[best].used ? i : best), 0);
      this.#slots[slot].name = name;
    }
    this.#slots[slot].used = this.#use;
    return slot;
  }

  /** For canvases. */
  of(name) {
    return color(`contact-${this.slot(name)}`);
  }
}
