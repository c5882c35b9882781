// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { Arrivals } from './arrivals.js';

/** Kinds that are passed on while the display is held: they say how the system is, not what it
 * feels. */
const NEVER_HELD = new Set([
  'hello', 'client', 'health', 'recorder', 'player', 'probe', 'refused', 'mesh', 'truth_mesh',
  'cable_paths', 'fixed_nodes',
]);

/** Passes messages to who asked for their kind, and counts when they came. */
export class Feed {
  #handlers = new Map();
  #arrivals = new Map();
  held = false;

  on(kind, handler) {
    if (!this.#handlers.has(kind)) this.#handlers.set(kind, []);
    this.#handlers.get(kind).push(handler);
  }

  publish(message) {
    this.arrivals(message.kind).add(performance.now());
    if (this.held && !NEVER_HELD.has(message.kind)) return;
    for (const handler of this.#handlers.get(message.kind) ?? []) handler(message);
  }

  /** @returns {Arrivals} */
  arrivals(kind) {
    if (!this.#arrivals.has(kind)) this.#arrivals.set(kind, new Arrivals());
    return this.#arrivals.get(kind);
  }
}
