// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { byId, element, replaceIfChanged } from '../ui/dom.js';
import { hundredths } from '../ui/format.js';

const UPDATE_MS = 100;

/** Displacement and tension of each cable, as the robot reports them. */
export class CablesPanel {
  #next_ms = 0;

  constructor(feed) {
    this.body = byId('cables-body');
    replaceIfChanged(this.body, element('p', { class: 'empty' }, 'Waiting for joint states.'));
    feed.on('cables', ({ cables }) => this.#show(cables));
  }

  #show(cables) {
    if (performance.now() < this.#next_ms) return;
    this.#next_ms = performance.now() + UPDATE_MS;
    const rows = cables.map(({ name, displacement_m, tension_N }) => element('tr', {},
      element('th', { scope: 'row' }, name.replaceAll('_', ' ')),
      element('td', {}, hundredths(1000 * displacement_m, 'mm')),
      element('td', {}, hundredths(tension_N, 'N'))));
    replaceIfChanged(this.body, rows.length
      ? element('table', {}, element('tbody', {}, ...rows))
      : element('p', { class: 'empty' }, 'This robot has no cables.'));
  }
}
