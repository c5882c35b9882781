// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { element, setText } from '../ui/dom.js';

const GAP_PX = 4;
const TRIES = 24;
const MEASURE_EVERY_MS = 300;

/** Texts beside points of the scene, moved apart so that none hides another or a control. They
 * repeat what the panel of forces says, so they are hidden from screen readers. */
export class Labels {
  #nodes = [];
  #items = [];
  #measured_ms = -Infinity;
  #frame = null;
  #taken = [];

  /** @param {HTMLElement} layer over the canvas
   * @param {string[]} obstacles selectors of what labels keep clear of */
  constructor(layer, stage, obstacles) {
    this.layer = layer;
    this.stage = stage;
    this.obstacles = obstacles;
  }

  /** @param {{point: import('three').Vector3, text: string, detail: string,
   *     color: string}[]} items */
  set(items) {
    this.#items = items;
  }

  /** Measuring makes the browser lay out the page, so not at each drawing. */
  #measure() {
    const now_ms = performance.now();
    if (now_ms - this.#measured_ms < MEASURE_EVERY_MS) return;
    this.#measured_ms = now_ms;
    this.#frame = this.layer.getBoundingClientRect();
    this.#taken = this.obstacles.map((selector) => {
      const { left, top, width, height } = document.querySelector(selector).getBoundingClientRect();
      return { x: left - this.#frame.left, y: top - this.#frame.top, width, height };
    });
  }

  #write(items) {
    while (this.#nodes.length < items.length) {
      const node = element('div', { class: 'label' }, element('b'), element('span'));
      this.#nodes.push(node);
      this.layer.append(node);
    }
    this.#nodes.forEach((node, i) => {
      node.hidden = i >= items.length;
      if (node.hidden) return;
      setText(node.firstChild, items[i].text);
      setText(node.lastChild, items[i].detail);
      node.style.setProperty('--color', items[i].color);
    });
  }

  /** After each drawing: texts, and where the camera now shows their points. */
  place() {
    this.#write(this.#items);
    if (this.#items.length === 0) return;
    this.#measure();
    const frame = this.#frame;
    const taken = [...this.#taken];
    this.#items.forEach(({ point }, i) => {
      const node = this.#nodes[i];
      const at = this.stage.project(point);
      node.style.visibility = at ? 'visible' : 'hidden';
      if (!at) return;
      const box = findRoom(at, node, frame, taken);
      taken.push(box);
      node.style.transform = `translate(${Math.round(box.x)}px, ${Math.round(box.y)}px)`;
    });
  }
}

const clamp = (x, low, high) => Math.min(Math.max(x, low), Math.max(low, high));

function findRoom(at, node, frame, taken) {
  const [width, height] = [node.offsetWidth, node.offsetHeight];
  let best = null;
  for (let i = 0; i < TRIES; ++i) {
    // Right, left, then farther and farther above and below.
    const side = i % 2 ? -width - 8 : 8;
    const level = Math.ceil((i >> 1) / 2) * ((i >> 1) % 2 ? -1 : 1);
    const box = {
      x: clamp(at.x + side, GAP_PX, frame.width - width - GAP_PX),
      y: clamp(at.y - height / 2 + level * (height + GAP_PX), GAP_PX,
        frame.height - height - GAP_PX),
      width,
      height,
    };
    best ??= box;
    if (!taken.some((other) => overlap(box, other))) return box;
  }
  return best;
}

function overlap(a, b) {
  return a.x < b.x + b.width + GAP_PX && b.x < a.x + a.width + GAP_PX &&
    a.y < b.y + b.height + GAP_PX && b.y < a.y + a.height + GAP_PX;
}
