// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial } from 'three';
import { color, onTheme } from '../ui/theme.js';
import { Surface } from './surface.js';

/** The true shape of the virtual robot: a veil with creases, seen through the estimate. */
export class Ghost {
  surface = null;

  constructor() {
    this.group = new Group();
    this.veil = new MeshBasicMaterial({ transparent: true, opacity: 0.14, depthWrite: false });
    this.line = new LineBasicMaterial({ transparent: true, opacity: 0.85 });
    this.#paint();
    onTheme(() => this.#paint());
  }

  setMesh(mesh) {
    this.surface?.dispose();
    this.group.clear();
    this.surface = new Surface(mesh);
    const parts = [
      new Mesh(this.surface.geometry, this.veil),
      new LineSegments(this.surface.creases, this.line),
    ];
    for (const part of parts) {
      part.frustumCulled = false;
      part.renderOrder = 2;
    }
    this.group.add(...parts);
  }

  #paint() {
    for (const material of [this.veil, this.line]) material.color.setStyle(color('truth'));
  }
}
