// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { Group, Mesh, MeshBasicMaterial, SphereGeometry, Vector3 } from 'three';
import { color, onTheme } from '../ui/theme.js';
import { makeLine, segmentsOf } from './cables.js';

const BALL_SHARE = 0.015;  // of the robot's radius

/** Cables that are drawn by clicks: a ball for each point, straight lines between them. They are
 * seen through the body, in which a cable may run. */
export class DrawnCables {
  #labels = [];

  constructor() {
    this.group = new Group();
    this.ball = new SphereGeometry(1, 20, 14);
    this.material = new MeshBasicMaterial({ depthTest: false });
    this.#paint();
    onTheme(() => this.#paint());
  }

  /** @param {import('../cables/cable_drafts.js').CableDrafts} drafts
   * @param {number} radius of the robot, m */
  set(drafts, radius) {
    this.lines?.forEach((line) => line.geometry.dispose());
    this.group.clear();
    this.lines = [];
    this.#labels = [];
    for (const { name, points_m } of drafts.finished) {
      this.#draw(points_m, radius);
      this.#label(points_m[0], name, '');
    }
    const { name, points_m } = drafts.current;
    this.#draw(points_m, radius);
    points_m.forEach((point_m, i) => {
      const last = i > 0 && i === points_m.length - 1;
      this.#label(point_m, String(i + 1), i === 0 ? `${name} is pulled from here`
        : last ? 'it is attached here' : '');
    });
    this.#paint();
  }

  /** As Labels takes them. */
  labels() {
    return this.#labels.map((label) => ({ ...label, color: 'var(--new-cable)' }));
  }

  #label(point_m, text, detail) {
    this.#labels.push({ point: new Vector3(...point_m), text, detail });
  }

  #draw(points_m, radius) {
    for (const point_m of points_m) {
      const ball = new Mesh(this.ball, this.material);
      ball.position.set(...point_m);
      ball.scale.setScalar(BALL_SHARE * radius);
      ball.renderOrder = 5;
      this.group.add(ball);
    }
    if (points_m.length < 2) return;
    const line = makeLine();
    line.material.depthTest = false;
    line.renderOrder = 5;
    line.geometry.setPositions(segmentsOf(points_m.flat()));
    this.lines.push(line);
    this.group.add(line);
  }

  #paint() {
    this.material.color.setStyle(color('new-cable'));
    for (const line of this.lines ?? []) line.material.color.setStyle(color('new-cable'));
  }
}
