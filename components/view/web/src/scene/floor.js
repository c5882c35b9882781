// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import {
  BufferGeometry, CanvasTexture, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments,
  Sprite, SpriteMaterial,
} from 'three';
import { color, onTheme } from '../ui/theme.js';
import { niceAbove } from './scale.js';

/** A square grid under the robot, whose lines are a round distance apart, and the robot frame's
 * axes at its origin. */
export class Floor {
  spacing_m = 0;

  constructor() {
    this.group = new Group();
    this.line = new LineBasicMaterial();
    this.#paint();
    onTheme(() => this.#paint());
  }

  /** @param {{x: number, y: number, z: number}} center of the robot @param {number} z_m */
  set(center, z_m, radius) {
    this.group.clear();
    this.spacing_m = niceAbove(radius / 8);
    const step = this.spacing_m;
    const count = Math.ceil((1.25 * radius) / step);
    const [x0, y0] = [center.x, center.y].map((x) => Math.round(x / step) * step);
    const half = count * step;
    const points = [];
    for (let i = -count; i <= count; ++i) {
      points.push(x0 + i * step, y0 - half, z_m, x0 + i * step, y0 + half, z_m);
      points.push(x0 - half, y0 + i * step, z_m, x0 + half, y0 + i * step, z_m);
    }
    this.group.add(segments(points, this.line));
    const length = 2 * step;
    const axes = { 'axis-x': [1, 0, 0], 'axis-y': [0, 1, 0], 'axis-z': [0, 0, 1] };
    for (const [name, direction] of Object.entries(axes)) {
      const material = new LineBasicMaterial({ color: color(name) });
      const end = direction.map((x) => length * x);
      this.group.add(segments([0, 0, 0, ...end], material));
      const letter = makeLetter(name.at(-1), color(name));
      letter.position.fromArray(direction.map((x) => 1.2 * length * x));
      letter.scale.setScalar(0.55 * step);
      this.group.add(letter);
    }
  }

  #paint() {
    this.line.color.setStyle(color('grid'));
  }
}

function segments(points, material) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(points, 3));
  return new LineSegments(geometry, material);
}

function makeLetter(letter, css) {
  const canvas = Object.assign(document.createElement('canvas'), { width: 64, height: 64 });
  const context = canvas.getContext('2d');
  Object.assign(context, { font: '44px sans-serif', textAlign: 'center', textBaseline: 'middle',
    fillStyle: css });
  context.fillText(letter, 32, 32);
  return new Sprite(new SpriteMaterial({ map: new CanvasTexture(canvas), depthWrite: false }));
}
