// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { byId, setText } from '../ui/dom.js';
import { withUnit } from '../ui/format.js';
import { color, onTheme } from '../ui/theme.js';

const OPACITY = 0.55;  // of the segmented points

/** The camera's image with the segmented points over it. */
export class CameraPanel {
  #image = null;  // { bitmap, width, height }
  #segments = null;
  #decoding = false;
  #source = 'color';
  #overlay = true;

  constructor(feed, freshness) {
    this.canvas = byId('camera-image');
    // In main memory: thousands of points are written into each image.
    this.context = this.canvas.getContext('2d', { willReadFrequently: true });
    this.freshness = freshness;
    feed.on('color_image', (message) => this.#take(message, 'color'));
    feed.on('depth_image', (message) => this.#take(message, 'depth'));
    feed.on('segmentation', (message) => (this.#segments = message));
    byId('camera-color').addEventListener('click', () => this.choose('color'));
    byId('camera-depth').addEventListener('click', () => this.choose('depth'));
    byId('camera-overlay').addEventListener('click', () => this.toggleOverlay());
    onTheme(() => this.#draw());
    new ResizeObserver(() => this.#draw()).observe(this.canvas);
  }

  /** @param {'color' | 'depth'} source */
  choose(source) {
    this.#source = source;
    this.freshness.camera_kind = `${source}_image`;
    for (const name of ['color', 'depth']) {
      byId(`camera-${name}`).setAttribute('aria-pressed', String(name === source));
    }
  }

  other() {
    this.choose(this.#source === 'color' ? 'depth' : 'color');
  }

  toggleOverlay() {
    this.#overlay = !this.#overlay;
    byId('camera-overlay').setAttribute('aria-pressed', String(this.#overlay));
    this.#draw();
  }

  /** While one image is decoded the next ones pass. */
  async #take(message, source) {
    if (source !== this.#source || this.#decoding) return;
    this.#decoding = true;
    try {
      const blob = new Blob([message.arrays.data], { type: `image/${message.encoding}` });
      const bitmap = await createImageBitmap(blob);
      this.#image?.bitmap.close();
      this.#image = { bitmap, width: message.width, height: message.height };
      const range = source === 'depth'
        ? `${withUnit(message.near_m, 'm')} (bright) to ${withUnit(message.far_m, 'm')}` : '';
      this.#say(range);
      byId('camera-empty').hidden = true;
    } catch (error) {
      this.#say(`An image cannot be decoded: ${error.message}`);
    } finally {
      this.#decoding = false;
    }
    this.#draw();
  }

  #say(text) {
    setText(byId('camera-note'), text);
    byId('camera-note').hidden = text === '';
  }

  #draw() {
    if (!this.#image) return;
    const { bitmap, width, height } = this.#image;
    const [canvas, context] = [this.canvas, this.context];
    const scale = Math.min(1, (canvas.clientWidth * devicePixelRatio) / width || 1);
    const [w, h] = [Math.round(width * scale), Math.round(height * scale)];
    if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
    context.drawImage(bitmap, 0, 0, w, h);
    if (!this.#overlay || !this.#segments) return;
    const image = context.getImageData(0, 0, w, h);
    const { arrays } = this.#segments;
    const to_image = w / this.#segments.width;
    blend(image, arrays.robot_px, to_image, color('segment-robot'));
    blend(image, arrays.object_px, to_image, color('segment-object'));
    context.putImageData(image, 0, 0);
  }
}

/** Colours the pixels of an image. @param {Float32Array | undefined} pixels x and y of each */
function blend({ data, width, height }, pixels, scale, css) {
  if (!pixels) return;
  const rgb = css.match(/\d+/g).map(Number);
  for (let i = 0; i < pixels.length; i += 2) {
    const [x, y] = [Math.floor(pixels[i] * scale), Math.floor(pixels[i + 1] * scale)];
    if (!(x >= 0 && x < width && y >= 0 && y < height)) continue;
    const at = 4 * (y * width + x);
    for (let k = 0; k < 3; ++k) data[at + k] += OPACITY * (rgb[k] - data[at + k]);
  }
}
