// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import {
  ConeGeometry, CylinderGeometry, Group, Mesh, MeshBasicMaterial, MeshLambertMaterial, Quaternion,
  SphereGeometry, Vector3,
} from 'three';

const GLOW = 0.3;  // keeps the colour on the side away from the light
const UP = new Vector3(0, 1, 0);
const SHAFT = new CylinderGeometry(1, 1, 1, 16).translate(0, 0.5, 0);
const HEAD = new ConeGeometry(1, 1, 20).rotateX(Math.PI).translate(0, 0.5, 0);  // tip at 0
const BALL = new SphereGeometry(1, 24, 16);

/** One force: an arrow whose head touches the contact. A wider sleeve at its tail is the 95 %
 * interval of the magnitude, a ball the 95 % interval of the location. */
class Arrow {
  constructor() {
    this.solid = new MeshLambertMaterial({ transparent: true });
    this.pale = new MeshBasicMaterial({ transparent: true, opacity: 0.3, depthWrite: false });
    this.group = new Group();
    this.direction = new Group();
    this.shaft = new Mesh(SHAFT, this.solid);
    this.head = new Mesh(HEAD, this.solid);
    this.sleeve = new Mesh(SHAFT, this.pale);
    this.location = new Mesh(BALL, this.pale);
    this.contact = new Mesh(BALL, this.solid);
    this.direction.add(this.shaft, this.head, this.sleeve);
    this.group.add(this.direction, this.location, this.contact);
    this.group.traverse((part) => (part.renderOrder = 3));
    this.tail = new Vector3();
  }

  /** Lengths in m. @param {{position: Vector3, force: Vector3 | null, ci95: number,
   *     location_ci95: number, color: string, usable: boolean}} it */
  set(it, { thickness, metres_per_newton }) {
    this.group.visible = true;
    this.group.position.copy(it.position);
    this.solid.color.setStyle(it.color);
    this.solid.emissive.setStyle(it.color).multiplyScalar(GLOW);
    this.pale.color.setStyle(it.color);
    this.solid.opacity = it.usable ? 1 : 0.45;
    this.contact.scale.setScalar(1.6 * thickness);
    this.location.visible = it.location_ci95 > 0;
    this.location.scale.setScalar(Math.max(it.location_ci95, 1e-6));
    this.direction.visible = it.force !== null && it.force.length() > 0;
    this.tail.copy(it.position);
    if (!this.direction.visible) return;
    const length = it.force.length() * metres_per_newton;
    const half = Math.min(it.ci95 * metres_per_newton, length);
    const back = it.force.clone().normalize().negate();
    this.direction.quaternion.copy(new Quaternion().setFromUnitVectors(UP, back));
    const head = Math.min(6 * thickness, 0.6 * length);
    this.head.scale.set(2.4 * thickness, head, 2.4 * thickness);
    this.shaft.position.y = 0.8 * head;
    this.shaft.scale.set(thickness, Math.max(length - 0.8 * head, 1e-6), thickness);
    this.sleeve.visible = half > 0;
    this.sleeve.position.y = length - half;
    this.sleeve.scale.set(2.1 * thickness, Math.max(2 * half, 1e-6), 2.1 * thickness);
    this.tail.addScaledVector(back, length);
  }
}

/** All arrows of one source, estimated or true. */
export class Arrows {
  #arrows = [];

  constructor() {
    this.group = new Group();
  }

  /** @returns {Vector3[]} the tails, where the labels are put */
  set(items, sizes) {
    while (this.#arrows.length < items.length) {
      const arrow = new Arrow();
      this.#arrows.push(arrow);
      this.group.add(arrow.group);
    }
    this.#arrows.forEach((arrow, i) => {
      if (i < items.length) arrow.set(items[i], sizes);
      else arrow.group.visible = false;
    });
    return items.map((_, i) => this.#arrows[i].tail);
  }
}
