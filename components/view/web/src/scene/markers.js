// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import {
  BufferGeometry, DynamicDrawUsage, Float32BufferAttribute, Group, InstancedMesh, LineBasicMaterial,
  LineSegments, Matrix4, MeshBasicMaterial, SphereGeometry,
} from 'three';
import { color, onTheme } from '../ui/theme.js';
import { UpperEnd } from './scale.js';

const BALL_SHARE = 0.016;  // of the robot's radius
const LINE_SHARE = 0.2;  // of the robot's radius, for the largest residual
/** Lines are never longer by more than this, and the factors are round. */
const FACTORS = [1, 2, 5, 10, 20, 50, 100, 200];

/** Measured markers as balls. A line from each ball, away from where the model has the marker, is
 * its residual, drawn longer than it is. */
export class Markers {
  /** How many times longer than they are residuals are drawn; 0: none is known. */
  factor = 0;
  #count = 0;
  #largest_m = new UpperEnd(1e-4);

  constructor() {
    this.group = new Group();
    // A marker that the model has inside the body is measured all the same.
    this.material = new MeshBasicMaterial({ depthTest: false });
    this.line = new LineBasicMaterial({ depthTest: false });
    this.segments = new LineSegments(new BufferGeometry(), this.line);
    this.segments.frustumCulled = false;
    this.segments.renderOrder = 3;
    this.#paint();
    onTheme(() => this.#paint());
  }

  get count() {
    return this.#count;
  }

  /** @param {{measured_m: Float32Array, model_m: Float32Array | undefined}} arrays 3 for each
   *     marker, NaN: not seen */
  set({ measured_m, model_m }, radius, now_ms) {
    const seen = [];
    for (let i = 0; i < measured_m.length; i += 3) if (Number.isFinite(measured_m[i])) seen.push(i);
    this.#count = seen.length;
    this.#placeBalls(measured_m, seen, BALL_SHARE * radius);
    this.#drawResiduals(measured_m, model_m, seen, radius, now_ms);
  }

  #placeBalls(measured_m, seen, size_m) {
    if (!this.balls || this.balls.instanceMatrix.count < seen.length) {
      this.balls?.dispose();
      this.group.clear();
      this.balls = new InstancedMesh(new SphereGeometry(1, 14, 10), this.material, seen.length);
      this.balls.instanceMatrix.setUsage(DynamicDrawUsage);
      this.balls.frustumCulled = false;
      this.balls.renderOrder = 3;
      this.group.add(this.balls, this.segments);
    }
    this.balls.count = seen.length;
    const place = new Matrix4().makeScale(size_m, size_m, size_m);
    seen.forEach((at, i) => {
      place.setPosition(measured_m[at], measured_m[at + 1], measured_m[at + 2]);
      this.balls.setMatrixAt(i, place);
    });
    this.balls.instanceMatrix.needsUpdate = true;
  }

  #drawResiduals(measured_m, model_m, seen, radius, now_ms) {
    const known = model_m ? seen.filter((at) => Number.isFinite(model_m[at])) : [];
    this.factor = 0;
    this.segments.visible = known.length > 0;
    if (known.length === 0) return;
    const residual = (at) => [0, 1, 2].map((k) => measured_m[at + k] - model_m[at + k]);
    const largest_m = Math.max(...known.map((at) => Math.hypot(...residual(at))));
    this.#largest_m.update(largest_m, now_ms);
    const room = (LINE_SHARE * radius) / this.#largest_m.value;
    this.factor = FACTORS.findLast((factor) => factor <= room) ?? 1;
    const ends = known.flatMap((at) => {
      const from = [0, 1, 2].map((k) => measured_m[at + k]);
      return [...from, ...residual(at).map((x, k) => from[k] + this.factor * x)];
    });
    this.segments.geometry.dispose();
    this.segments.geometry = new BufferGeometry()
      .setAttribute('position', new Float32BufferAttribute(ends, 3));
  }

  #paint() {
    this.material.color.setStyle(color('marker'));
    this.line.color.setStyle(color('marker-residual'));
  }
}
