// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import {
  Color, DirectionalLight, HemisphereLight, MathUtils, PerspectiveCamera, Scene, Spherical,
  Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { color, onTheme } from '../ui/theme.js';

const FIRST_VIEW = new Vector3(0.74, -0.56, 0.44);  // seen from, robot frame
const MARGIN = 0.98;  // of a fitted view
const WAIT_MS = 5;  // until the end of the last drawing is asked for again
/** A drawing whose end is not told by then is taken for done: the next one must not wait for ever
 * for a browser that has lost it. */
const LONGEST_DRAWING_MS = 1500;

/** Renderer, camera and light. It draws only when something has changed, and only when the last
 * drawing is done: a browser without a graphics card takes longer than the data to come, and would
 * otherwise have no time left for numbers and buttons. */
export class Stage {
  #pending = false;
  #fence = null;  // passed when the last drawing is done
  #drawn_ms = 0;  // when the last drawing began
  #fitted = { center: new Vector3(), radius: 0.15 };
  /** Called before each drawing, to take in what has come since the last one. */
  beforeDrawing = () => {};
  /** Called after each drawing: places of labels depend on the camera. */
  onDrawn = () => {};

  /** @throws {Error} where the browser has no WebGL */
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: 'low-power' });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(32, 1, 0.01, 10);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.draw());
    this.#light();
    onTheme(() => this.#paintBackground());
    this.#paintBackground();
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
    this.#resize();
    this.resetView();
  }

  /** Draws in the next animation frame in which there is time. */
  draw() {
    if (this.#pending) return;
    this.#pending = true;
    requestAnimationFrame(() => this.#drawWhenFree());
  }

  #drawWhenFree() {
    const gl = this.renderer.getContext();
    const is_late = performance.now() - this.#drawn_ms > LONGEST_DRAWING_MS;
    if (this.#fence && !is_late &&
        gl.clientWaitSync(this.#fence, 0, 0) === gl.TIMEOUT_EXPIRED) {
      setTimeout(() => requestAnimationFrame(() => this.#drawWhenFree()), WAIT_MS);
      return;
    }
    gl.deleteSync(this.#fence);
    this.#pending = false;  // before what may fail: a message that cannot be drawn stops no other
    this.#drawn_ms = performance.now();
    this.beforeDrawing();
    this.renderer.render(this.scene, this.camera);
    this.#fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    this.onDrawn();
  }

  /** What resetView() shows, m. */
  fit(center, radius) {
    this.#fitted = { center: center.clone(), radius };
    this.resetView();
  }

  resetView() {
    const { center, radius } = this.#fitted;
    const half_angle = MathUtils.degToRad(this.camera.fov / 2);
    const narrower = Math.min(1, this.camera.aspect);
    const distance = (MARGIN * radius) / (Math.sin(half_angle) * narrower);
    this.camera.position.copy(FIRST_VIEW).setLength(distance).add(center);
    this.camera.near = distance / 50;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(center);
    this.controls.minDistance = 0.2 * radius;
    this.controls.maxDistance = 12 * radius;
    this.controls.update();
    this.draw();
  }

  /** Turns the camera about its target, rad. */
  orbit(azimuth, elevation) {
    const to_z_up = new Vector3();
    const offset = this.camera.position.clone().sub(this.controls.target);
    to_z_up.set(offset.y, offset.z, offset.x);
    const at = new Spherical().setFromVector3(to_z_up);
    at.theta += azimuth;
    at.phi -= elevation;
    at.makeSafe();
    to_z_up.setFromSpherical(at);
    offset.set(to_z_up.z, to_z_up.x, to_z_up.y);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.draw();
  }

  zoom(factor) {
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.draw();
  }

  /** Where a point of the robot frame is drawn, CSS pixels of the canvas; null: behind it. */
  project(point) {
    const at = point.clone().project(this.camera);
    if (at.z > 1) return null;
    const { clientWidth, clientHeight } = this.canvas;
    return { x: (0.5 + at.x / 2) * clientWidth, y: (0.5 - at.y / 2) * clientHeight };
  }

  #light() {
    this.scene.add(new HemisphereLight(0xffffff, 0x9aa4ae, 2.3));
    const lamp = new DirectionalLight(0xffffff, 1.3);
    lamp.position.set(-0.5, 0.8, 1);  // right, above and before the eye
    this.camera.add(lamp);
    this.scene.add(this.camera);
  }

  #paintBackground() {
    this.scene.background = new Color(color('scene'));
    this.draw();
  }

  #resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.draw();
  }
}
