// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { Raycaster, Vector2 } from 'three';

const CLICK_PX = 5;  // a longer way is a drag, which turns the view

function hitAt(stage, robot, at) {
  if (!robot.mesh) return null;
  const ray = new Raycaster();
  ray.setFromCamera(new Vector2(at.x, at.y), stage.camera);
  return ray.intersectObject(robot.mesh, false)[0] ?? null;
}

/** Point of the surface at a place of the canvas, robot frame, m; null where there is none.
 * @param {{x: number, y: number}} at from -1 to 1, y up
 * @returns {import('three').Vector3 | null} */
export function pointAt(stage, robot, at) {
  return hitAt(stage, robot, at)?.point ?? null;
}

/** Node of the surface nearest to that point. */
export function nodeAt(stage, robot, at) {
  const hit = hitAt(stage, robot, at);
  if (!hit) return null;
  const nodes = [hit.face.a, hit.face.b, hit.face.c].map((vertex) => robot.surface.source[vertex]);
  const distance = (node) => robot.surface.positionOf(node).distanceTo(hit.point);
  return nodes.reduce((best, node) => (distance(node) < distance(best) ? node : best));
}

/** Calls back with the place of each click, as pointAt() takes it. */
export function onClick(canvas, callback) {
  let begin = null;
  canvas.addEventListener('pointerdown', (event) => {
    begin = event.isPrimary ? { x: event.clientX, y: event.clientY } : null;
  });
  canvas.addEventListener('pointerup', (event) => {
    if (!begin || Math.hypot(event.clientX - begin.x, event.clientY - begin.y) > CLICK_PX) return;
    const box = canvas.getBoundingClientRect();
    callback({
      x: (2 * (event.clientX - box.left)) / box.width - 1,
      y: 1 - (2 * (event.clientY - box.top)) / box.height,
    });
  });
}
