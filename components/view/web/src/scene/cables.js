// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { Color, Group } from 'three';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { color, onTheme } from '../ui/theme.js';
import { sample } from './colormap.js';

const WIDTH_PX = 3.5;

/** The paths of the cables along the body, coloured by tension where it is known. */
export class Cables {
  #lines = new Map();  // by name
  #tensions = new Map();
  #highest_N = 1;

  constructor() {
    this.group = new Group();
    onTheme(() => this.#paint());
  }

  /** @param {Object<string, Float32Array>} paths points of each cable, robot frame, m */
  setPaths(paths) {
    const names = Object.keys(paths);
    if (names.length !== this.#lines.size || names.some((name) => !this.#lines.has(name))) {
      this.group.clear();
      this.#lines = new Map(names.map((name) => [name, makeLine()]));
      this.group.add(...this.#lines.values());
      this.#paint();
    }
    for (const [name, points_m] of Object.entries(paths)) {
      const { geometry } = this.#lines.get(name);
      geometry.setPositions(segmentsOf(points_m));  // it makes new buffers
    }
  }

  /** @param {Map<string, number>} tensions N; absent where unknown */
  setTensions(tensions, highest_N) {
    this.#tensions = tensions;
    this.#highest_N = highest_N;
    this.#paint();
  }

  #paint() {
    for (const [name, { material }] of this.#lines) {
      const tension = this.#tensions.get(name);
      if (tension === undefined) material.color.setStyle(color('cable'));
      else material.color.copy(tensionColor(tension / this.#highest_N));
    }
  }
}

/** Both ends of each straight piece of a path. @param {ArrayLike<number>} points_m 3 for each */
export function segmentsOf(points_m) {
  const segments = [];
  for (let i = 0; i + 5 < points_m.length; i += 3) segments.push(...points_m.slice(i, i + 6));
  return segments;
}

export function makeLine() {
  const line = new LineSegments2(new LineSegmentsGeometry(),
    new LineMaterial({ linewidth: WIDTH_PX }));
  line.frustumCulled = false;
  return line;
}

function tensionColor(t) {
  const [r, g, b] = sample('cividis', t);
  return new Color().setStyle(`rgb(${r}, ${g}, ${b})`);
}
