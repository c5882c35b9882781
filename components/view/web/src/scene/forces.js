// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { Vector3 } from 'three';
import { withInterval } from '../ui/format.js';
import { color } from '../ui/theme.js';
import { Arrows } from './arrows.js';
import { UpperEnd } from './scale.js';

const LONGEST_SHARE = 0.45;  // of the robot's radius, for the strongest force
/** What the server says of a force that was declared in loads.csv. */
export const KNOWN_LOAD = 'known load';
const THICKNESS_SHARE = 0.012;

/** Arrows and labels of estimated and true forces. */
export class ForceArrows {
  estimated = new Arrows();
  truth = new Arrows();
  #last = { estimated: [], truth: [] };
  #full_scale = new UpperEnd(0.5);

  /** @param {import('../ui/contact_colors.js').ContactColors} colors */
  constructor(colors) {
    this.colors = colors;
  }

  setEstimated(forces) {
    this.#last.estimated = forces;
  }

  setTruth(forces) {
    this.#last.truth = forces;
  }

  hasEstimates() {
    return this.#last.estimated.length > 0;
  }

  /** An experiment knows loads, a virtual robot the truth. */
  hasKnownLoads() {
    return this.#last.truth.some(({ reason }) => reason === KNOWN_LOAD);
  }

  metresPerNewton(radius) {
    return (LONGEST_SHARE * radius) / this.#full_scale.value;
  }

  /** @returns {object[]} labels, estimates first. */
  show(radius, now_ms) {
    const all = [...this.#last.estimated, ...this.#last.truth];
    const largest = all.reduce((most, force) => Math.max(most, force.magnitude_N ?? 0), 0);
    this.#full_scale.update(largest, now_ms);
    const sizes = {
      thickness: THICKNESS_SHARE * radius,
      metres_per_newton: this.metresPerNewton(radius),
    };
    const estimated = this.#place(this.estimated, this.#last.estimated, sizes, (force) => ({
      color: this.colors.of(force.name),
      detail: force.status === 'ok' ? '' : force.status.replaceAll('_', ' '),
    }));
    const true_sizes = { ...sizes, thickness: 0.6 * sizes.thickness };
    const truth = this.#place(this.truth, this.#last.truth, true_sizes, ({ reason }) => ({
      color: color('truth'), detail: reason || 'true',
    }));
    return [...estimated, ...truth];
  }

  #place(arrows, forces, sizes, style) {
    const placed = forces.filter((force) => force.position_m.every(Number.isFinite));
    const tails = arrows.set(placed.map((force) => ({
      position: new Vector3(...force.position_m),
      force: force.force_N && new Vector3(...force.force_N),
      ci95: force.ci95_N ?? 0,
      location_ci95: force.location_ci95_m ?? 0,
      usable: force.status === 'ok',
      color: style(force).color,
    })), sizes);
    return placed.map((force, i) => ({
      point: tails[i],
      text: force.force_N ? withInterval(force.magnitude_N, shownInterval(force), 'N') : '',
      ...style(force),
    }));
  }
}

/** The truth has no interval. */
export function shownInterval(force) {
  return force.ci95_N > 0 ? force.ci95_N : NaN;
}
