// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { Mesh, MeshBasicMaterial, SphereGeometry } from 'three';
import { byId, setText } from '../ui/dom.js';
import { isNumber, millimetres, place, withUnit } from '../ui/format.js';
import { color, onTheme } from '../ui/theme.js';

/** "1 in 100 000" */
const chance = (p) => (p > 0 ? `1 in ${Math.round(1 / p).toLocaleString('en').replaceAll(',', ' ')}`
  : 'rare');

const ASK_AGAIN_MS = 1000;

/** The point of the skin that was clicked: where it is, how far it has moved, and the smallest
 * force that could be felt there, for which the server is asked. */
export class Probe {
  #node = null;
  #asked_ms = -Infinity;
  #answer = null;

  /** @param {(message: object) => boolean} send */
  constructor(send, onChange) {
    this.send = send;
    this.card = byId('probe');
    this.dot = new Mesh(new SphereGeometry(1, 20, 14), new MeshBasicMaterial({ depthTest: false }));
    this.dot.renderOrder = 4;
    this.dot.visible = false;
    const paint = () => this.dot.material.color.setStyle(color('probe'));
    paint();
    onTheme(paint);
    byId('probe-close').addEventListener('click', () => {
      this.close();
      onChange();
    });
  }

  /** @param {number | null} node of the surface */
  choose(node, surface, radius) {
    if (node === null) return this.close();
    this.#node = node;
    this.#answer = null;
    this.#asked_ms = -Infinity;
    this.dot.scale.setScalar(0.014 * radius);
    this.card.hidden = false;
    this.follow(surface);
  }

  close() {
    this.#node = null;
    this.card.hidden = true;
    this.dot.visible = false;
  }

  /** After each new shape. */
  follow(surface) {
    if (this.#node === null) return;
    if (this.#node >= surface.node_count) return this.close();
    this.dot.visible = true;
    this.dot.position.copy(surface.positionOf(this.#node));
    setText(byId('probe-place'), `${place(this.dot.position.toArray())} mm`);
    const moved_m = surface.displacementOf(this.#node);
    setText(byId('probe-displacement'), millimetres(moved_m.length()));
    setText(byId('probe-direction'), `(${place(moved_m.toArray())})`);
    this.#ask();
    this.#showForce();
  }

  /** @param {{vertex: number, smallest_force_N: number | null, reason: string}} answer */
  take(answer) {
    if (answer.vertex !== this.#node) return;
    this.#answer = answer;
    this.#showForce();
  }

  /** The smallest force changes with the shape and with what the camera sees. */
  #ask() {
    const now_ms = performance.now();
    if (now_ms - this.#asked_ms < ASK_AGAIN_MS) return;
    if (this.send({ kind: 'probe', vertex: this.#node })) this.#asked_ms = now_ms;
  }

  #showForce() {
    const known = isNumber(this.#answer?.smallest_force_N);
    const force = known ? withUnit(this.#answer.smallest_force_N, 'N') : 'unknown';
    setText(byId('probe-force'), this.#answer ? force : 'asking');
    setText(byId('probe-reason'), known
      ? `Noise alone; false alarms ${chance(this.#answer.significance)}.`
      : this.#answer?.reason ?? '');
  }
}
