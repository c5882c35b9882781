// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { byId, element, replaceIfChanged } from '../ui/dom.js';
import { hundredths } from '../ui/format.js';

const UPDATE_MS = 100;

/** Displacement and tension of each cable, change of volume and pressure of each chamber. */
export class CablesPanel {
  #next_ms = 0;

  constructor(feed) {
    this.body = byId('cables-body');
    replaceIfChanged(this.body, element('p', { class: 'empty' }, 'Waiting for joint states.'));
    this.title = byId('cables-name');
    feed.on('cables', ({ cables, chambers }) => this.#show(cables, chambers));
  }

  #show(cables, chambers) {
    if (performance.now() < this.#next_ms) return;
    this.#next_ms = performance.now() + UPDATE_MS;
    const rows = [
      ...cables.map(({ name, displacement_m, tension_N }) => row(name,
        hundredths(scaled(displacement_m, 1e3), 'mm'), hundredths(tension_N, 'N'))),
      ...chambers.map(({ name, volume_m3, pressure_Pa }) => row(name,
        hundredths(scaled(volume_m3, 1e6), 'cm³'), hundredths(scaled(pressure_Pa, 1e-3), 'kPa'))),
    ];
    byId('show-cables').hidden = !cables.length && chambers.length > 0;  // none are drawn
    this.title.textContent = [cables.length || !chambers.length ? 'Cables' : '',
      chambers.length ? 'Chambers' : ''].filter(Boolean).join(' and ').replace('and C', 'and c');
    replaceIfChanged(this.body, rows.length
      ? element('table', {}, element('tbody', {}, ...rows))
      : element('p', { class: 'empty' }, 'This robot has neither cables nor chambers.'));
  }
}

/** A number that is not known stays so. */
const scaled = (value, factor) => (value === null ? null : factor * value);

function row(name, first, second) {
  return element('tr', {},
    element('th', { scope: 'row' }, name.replaceAll('_', ' ')),
    element('td', {}, first),
    element('td', {}, second));
}
