// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

/** Points are kept to a tenth of a millimetre, which is what a click on a screen can mean. */
const PER_METRE = 1e4;
export const LEAST_POINTS = 2;
/** Other signs mean something to a shell, to YAML or in tables. */
const NAME = /^[\p{L}\p{N}][\p{L}\p{N}_-]*$/u;

/** To the digits that are kept; `+ 0` takes the sign from a zero. */
const rounded = (metres) => Math.round(metres * PER_METRE) / PER_METRE + 0;

/** Cables that are drawn point by point on the undeformed surface: finished ones, and the one to
 * which the next point goes. Points are [x, y, z] in the robot frame, m; the first is where the
 * cable is pulled from, the last where it is attached. */
export class CableDrafts {
  /** @type {{name: string, points_m: number[][]}[]} */
  #finished = [];
  #points_m = [];
  #name = null;  // null: none was given
  #taken = [];

  /** @param {string[]} names that are not suggested */
  setTaken(names) {
    this.#taken = names;
  }

  get finished() {
    return this.#finished;
  }

  /** The one to which the next point goes. */
  get current() {
    return { name: this.#name ?? this.#suggestion(), points_m: this.#points_m };
  }

  /** Finished ones, and the current one as soon as it is a cable with a name that can be. */
  get complete() {
    const ready = this.#points_m.length >= LEAST_POINTS && this.whyNotName() === '';
    return ready ? [...this.#finished, this.current] : this.#finished;
  }

  get isEmpty() {
    return this.#finished.length === 0 && this.#points_m.length === 0;
  }

  setName(text) {
    this.#name = text.trim().replaceAll(/\s+/g, '_');
  }

  /** Why the name of the current cable cannot be; '' where it can. */
  whyNotName() {
    const { name } = this.current;
    if (name === '') return 'The cable needs a name.';
    if (!NAME.test(name)) {
      return 'A name has letters, digits, _ and -. It begins with a letter or digit.';
    }
    const same = this.#finished.some((cable) => cable.name === name);
    return same ? `There is a cable ${name} already.` : '';
  }

  /** @param {number[]} point_m @returns {string} why it was not added; '' where it was */
  add(point_m) {
    const point = point_m.map(rounded);
    const last = this.#points_m.at(-1);
    if (last?.every((x, k) => x === point[k])) return 'This is the same point again.';
    this.#points_m.push(point);
    return '';
  }

  /** Takes the last point back; where the current cable has none, the one before is current again,
   * with all its points. */
  undo() {
    if (this.#points_m.length > 0) {
      this.#points_m.pop();
    } else if (this.#finished.length > 0) {
      const { name, points_m } = this.#finished.pop();
      this.#name = name;
      this.#points_m = points_m;
    }
  }

  /** Begins the next cable. @returns {string} why it cannot be; '' where it was begun */
  finish() {
    if (this.#points_m.length < LEAST_POINTS) return 'A cable has two points at least.';
    const reason = this.whyNotName();
    if (reason) return reason;
    this.#finished.push(this.current);
    this.#name = null;
    this.#points_m = [];
    return '';
  }

  clear() {
    this.#finished = [];
    this.#points_m = [];
    this.#name = null;
  }

  #suggestion() {
    const names = new Set([...this.#taken, ...this.#finished.map(({ name }) => name)]);
    let number = 1;
    while (names.has(`cable_${number}`)) number += 1;
    return `cable_${number}`;
  }
}
