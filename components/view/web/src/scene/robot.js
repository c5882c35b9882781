// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import {
  BufferAttribute, DataTexture, Group, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial,
  NearestFilter, SRGBColorSpace,
} from 'three';
import { color, onTheme } from '../ui/theme.js';
import { sample } from './colormap.js';
import { Surface } from './surface.js';

const COLORS = 256;
const UNKNOWN = [139, 148, 158];

/** First row: the scale. Second row: grey, for nodes without a value. */
function makeTexture() {
  const texels = new Uint8Array(4 * 2 * COLORS);
  for (let i = 0; i < COLORS; ++i) {
    texels.set([...sample('viridis', i / (COLORS - 1)), 255], 4 * i);
    texels.set([...UNKNOWN, 255], 4 * (COLORS + i));
  }
  const texture = new DataTexture(texels, COLORS, 2);
  texture.colorSpace = SRGBColorSpace;
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

/** The estimated shape of the robot, coloured by one value for each node. */
export class Robot {
  surface = null;
  mesh = null;

  constructor() {
    this.group = new Group();
    this.material = new MeshLambertMaterial({
      map: makeTexture(), polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    });
    this.thin = new LineBasicMaterial({ transparent: true, opacity: 0.13 });
    this.strong = new LineBasicMaterial({ transparent: true, opacity: 0.6 });
    this.#paintLines();
    onTheme(() => this.#paintLines());
  }

  /** @param {{rest_m: Float32Array, triangles: Uint32Array}} mesh */
  setMesh(mesh) {
    this.surface?.dispose();
    this.group.clear();
    this.surface = new Surface(mesh);
    this.uv = new BufferAttribute(new Float32Array(2 * this.surface.source.length), 2);
    this.surface.geometry.setAttribute('uv', this.uv);
    this.mesh = new Mesh(this.surface.geometry, this.material);
    const lines = [
      new LineSegments(this.surface.edges, this.thin),
      new LineSegments(this.surface.creases, this.strong),
    ];
    for (const part of [this.mesh, ...lines]) part.frustumCulled = false;
    this.group.add(this.mesh, ...lines);
  }

  /** @param {Float32Array} values by node; NaN is drawn grey */
  paint(values, low, high) {
    // One value for all, as of a body of one material, has the colour in the middle.
    const is_one = high - low <= 1e-6 * high;
    const range = is_one ? Infinity : high - low;
    const from = is_one ? 0.5 : 0;
    const uv = this.uv.array;
    this.surface.source.forEach((node, vertex) => {
      const value = values[node];
      const known = Number.isFinite(value);
      uv[2 * vertex] = known ? Math.min(Math.max(from + (value - low) / range, 0.002), 0.998) : 0;
      uv[2 * vertex + 1] = known ? 0.25 : 0.75;
    });
    this.uv.needsUpdate = true;
  }

  #paintLines() {
    for (const material of [this.thin, this.strong]) material.color.setStyle(color('mesh-line'));
  }
}
