// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import {
  BufferAttribute, BufferGeometry, DynamicDrawUsage, Points, PointsMaterial,
} from 'three';
import { color, onTheme } from '../ui/theme.js';

/** Points lie on the robot: its colours must be seen between and through them. */
const OPACITY = 0.5;

/** Measured points in the robot frame. The buffer grows with the largest cloud. */
export class Cloud {
  #capacity = 0;

  /** @param {string} color_name of the style sheet */
  constructor(color_name, size_px) {
    this.geometry = new BufferGeometry();
    this.material = new PointsMaterial({
      size: size_px, sizeAttenuation: false, transparent: true, opacity: OPACITY, depthWrite: false,
    });
    this.points = new Points(this.geometry, this.material);
    this.points.frustumCulled = false;
    const paint = () => this.material.color.setStyle(color(color_name));
    paint();
    onTheme(paint);
  }

  /** @param {Float32Array} points_m 3 for each point; those with NaN are not drawn */
  set(points_m) {
    if (points_m.length > this.#capacity) this.#grow(points_m.length);
    const attribute = this.geometry.getAttribute('position');
    attribute.array.set(points_m);
    attribute.clearUpdateRanges();
    attribute.addUpdateRange(0, points_m.length);
    attribute.needsUpdate = true;
    this.geometry.setDrawRange(0, points_m.length / 3);
  }

  #grow(length) {
    this.#capacity = 3 * Math.ceil((1.25 * length) / 3);
    const attribute = new BufferAttribute(new Float32Array(this.#capacity), 3);
    attribute.setUsage(DynamicDrawUsage);
    this.geometry.dispose();
    this.geometry.setAttribute('position', attribute);
  }
}
