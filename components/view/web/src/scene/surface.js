// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Vector3 } from 'three';
import { splitAtCreases } from './creases.js';

/** The surface of a body as it is drawn. Positions come by node; the drawing has more vertices,
 * since nodes at creases are doubled. */
export class Surface {
  /** @param {{rest_m: Float32Array, triangles: Uint32Array}} mesh */
  constructor({ rest_m, triangles }) {
    this.rest_m = rest_m;
    this.positions_m = rest_m;
    this.node_count = rest_m.length / 3;
    const split = splitAtCreases(rest_m, triangles);
    this.source = split.source;
    this.position = new BufferAttribute(new Float32Array(3 * this.source.length), 3);
    this.position.setUsage(DynamicDrawUsage);
    this.geometry = this.#withIndex(split.index);
    this.edges = this.#withIndex(split.edges);
    this.creases = this.#withIndex(split.creases);
    this.move(rest_m);
  }

  /** @param {Float32Array} positions_m 3 for each node */
  move(positions_m) {
    this.positions_m = positions_m;
    const drawn = this.position.array;
    this.source.forEach((node, vertex) => {
      for (let k = 0; k < 3; ++k) drawn[3 * vertex + k] = positions_m[3 * node + k];
    });
    this.position.needsUpdate = true;
    this.geometry.computeVertexNormals();
    this.geometry.boundingSphere = null;  // picking computes it again
  }

  positionOf(node) {
    return new Vector3().fromArray(this.positions_m, 3 * node);
  }

  /** Against the rest shape, m. */
  displacementOf(node) {
    return this.positionOf(node).sub(new Vector3().fromArray(this.rest_m, 3 * node));
  }

  /** Magnitudes of all nodes, m. */
  displacements() {
    const [now, rest] = [this.positions_m, this.rest_m];
    return Float32Array.from({ length: this.node_count }, (_, i) =>
      Math.hypot(now[3 * i] - rest[3 * i], now[3 * i + 1] - rest[3 * i + 1],
        now[3 * i + 2] - rest[3 * i + 2]));
  }

  dispose() {
    for (const part of [this.geometry, this.edges, this.creases]) part.dispose();
  }

  #withIndex(index) {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', this.position);
    geometry.setIndex(new BufferAttribute(index, 1));
    return geometry;
  }
}
