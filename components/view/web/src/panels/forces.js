// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { KNOWN_LOAD, shownInterval } from '../scene/forces.js';
import { UpperEnd } from '../scene/scale.js';
import { byId, element, replaceIfChanged } from '../ui/dom.js';
import { isNumber, place, withInterval } from '../ui/format.js';

const UPDATE_MS = 100;  // digits that change faster cannot be read
/** Words of a frame that mean: measured, and nothing touches the robot. */
const NOTHING_WRONG = new Set(['ok', 'no_contact']);

const EMPTY = {
  live: 'Waiting for forces of palpate-force-estimation.',
  recording: 'No forces at this place of the recording.',
  robot: 'A robot file has no forces.',
  experiment: 'No estimate is shown: give forces.csv of palpate estimate as --results.',
};

const words = (status) => status.replaceAll('_', ' ');

/** The list of forces: number, interval, place; or why there is none. */
export class ForcesPanel {
  #forces = null;
  #truth = [];
  #source = 'live';
  #full_scale = new UpperEnd(0.5);
  #pending = false;

  constructor(feed, colors) {
    this.colors = colors;
    this.body = byId('forces-body');
    feed.on('forces', (message) => {
      this.#forces = message;
      this.#soon();
    });
    feed.on('truth_forces', ({ forces }) => {
      this.#truth = forces;
      if (!this.#forces) this.#soon();
    });
    feed.on('hello', ({ source }) => {
      this.#source = source;
      this.#forces = null;
      this.#truth = [];
      this.#show();
    });
    this.#show();
  }

  #soon() {
    if (this.#pending) return;
    this.#pending = true;
    setTimeout(() => {
      this.#pending = false;
      this.#show();
    }, UPDATE_MS);
  }

  #show() {
    if (!this.#forces) {
      const known = this.#truth.filter((force) => force.magnitude_N > 0)
        .map((force) => this.#trueForce(force));
      return replaceIfChanged(this.body, ...known,
        element('p', { class: 'empty' }, EMPTY[this.#source]));
    }
    const { status, reason, forces } = this.#forces;
    const rows = [];
    if (!NOTHING_WRONG.has(status)) {
      rows.push(element('p', { class: 'trouble', 'data-testid': 'forces-status' },
        element('b', {}, words(status)), ` ${reason}`));
    } else if (forces.length === 0) {
      rows.push(element('p', { class: 'calm', 'data-testid': 'no-contact' },
        'No contact. The shape is that of the robot without external forces.'));
    }
    const largest = [...forces, ...this.#truth]
      .reduce((most, force) => Math.max(most, (force.magnitude_N ?? 0) + (force.ci95_N || 0)), 0);
    this.#full_scale.update(largest, performance.now());
    rows.push(...forces.map((force) => this.#estimate(force)));
    rows.push(...this.#truth.filter((force) => force.magnitude_N > 0)
      .map((force) => this.#trueForce(force)));
    replaceIfChanged(this.body, ...rows);
  }

  #estimate(force) {
    const usable = force.status === 'ok';
    const known = force.force_N !== null && isNumber(force.magnitude_N);
    const location = force.location_ci95_m > 0
      ? ` ± ${(1000 * force.location_ci95_m).toFixed(1)} mm` : ' mm';
    const value = known
      ? element('data', { value: force.magnitude_N, 'data-testid': 'force-value' },
        withInterval(force.magnitude_N, shownInterval(force), 'N'))
      : element('span', { class: 'none' }, 'no number');
    return element('div', {
      class: 'force', 'data-testid': 'force', 'data-usable': String(usable),
      style: `--color: var(--contact-${this.colors.slot(force.name)})`,
    },
    element('span', { class: 'name' }, element('i'), force.name), value,
    element('span', { class: 'where' }, `at ${place(force.position_m)}${location}`),
    known ? this.#bar(force) : element('span'),
    usable ? null : element('span', { class: 'why', 'data-testid': 'force-status' },
      element('b', {}, words(force.status)), force.reason ? ` ${force.reason}` : ''));
  }

  #trueForce(force) {
    const name = `${force.reason === KNOWN_LOAD ? 'known' : 'true'}, ${words(force.name)}`;
    return element('div', { class: 'force truth', 'data-testid': 'truth-force' },
      element('span', { class: 'name' }, element('i'), name),
      element('data', { value: force.magnitude_N }, withInterval(force.magnitude_N, NaN, 'N')));
  }

  /** The magnitude as a length, with its interval. */
  #bar(force) {
    const share = (x) => 100 * Math.min(Math.max(x / this.#full_scale.value, 0), 1);
    const half = force.ci95_N > 0 ? force.ci95_N : 0;
    const [from, to] = [share(force.magnitude_N - half), share(force.magnitude_N + half)];
    return element('span', { class: 'bar', 'aria-hidden': 'true' },
      element('i', { class: 'length', style: `width: ${share(force.magnitude_N).toFixed(1)}%` }),
      half > 0 ? element('i', {
        class: 'interval', style: `left: ${from.toFixed(1)}%; width: ${(to - from).toFixed(1)}%`,
      }) : null);
  }
}
