// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { Color, Group } from 'three';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { color, onTheme } from '../ui/theme.js';
import { sample } from './colormap.js';

const WIDTH_PX = 3.5;

/** The paths of the cables, coloured by tension where it is known. */
export class Cables {
  #materials = new Map();
  #tensions = new Map();
  #highest_N = 1;

  constructor() {
    this.group = new Group();
    onTheme(() => this.#paint());
  }

  /** @param {Object<string, Float32Array>} paths points of each cable, robot frame, m */
  setPaths(paths) {
    this.group.clear();
    this.#materials.clear();
    for (const [name, points_m] of Object.entries(paths)) {
      const segments = [];
      for (let i = 0; i + 5 < points_m.length; i += 3) segments.push(...points_m.slice(i, i + 6));
      const material = new LineMaterial({ linewidth: WIDTH_PX });
      const geometry = new LineSegmentsGeometry().setPositions(segments);
      const line = new LineSegments2(geometry, material);
      line.frustumCulled = false;
      this.group.add(line);
      this.#materials.set(name, material);
    }
    this.#paint();
  }

  /** @param {Map<string, number>} tensions N; absent where unknown */
  setTensions(tensions, highest_N) {
    this.#tensions = tensions;
    this.#highest_N = highest_N;
    this.#paint();
  }

  #paint() {
    for (const [name, material] of this.#materials) {
      const tension = this.#tensions.get(name);
      if (tension === undefined) material.color.setStyle(color('cable'));
      else material.color.copy(tensionColor(tension / this.#highest_N));
    }
  }
}

function tensionColor(t) {
  const [r, g, b] = sample('cividis', t);
  return new Color().setStyle(`rgb(${r}, ${g}, ${b})`);
}
