// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { Sphere, Vector3 } from 'three';
import { byId, setText } from '../ui/dom.js';
import { onTheme } from '../ui/theme.js';
import { Cables } from './cables.js';
import { Cloud } from './cloud.js';
import { ColorBar } from './colorbar.js';
import { Coloring, MODES } from './coloring.js';
import { DrawnCables } from './drawn_cables.js';
import { Floor } from './floor.js';
import { ForceArrows } from './forces.js';
import { Ghost } from './ghost.js';
import { Labels } from './labels.js';
import { Markers } from './markers.js';
import { showLegend } from './legend.js';
import { nodeAt, onClick, pointAt } from './pick.js';
import { Probe } from './probe.js';
import { Robot } from './robot.js';
import { UpperEnd } from './scale.js';
import { Stage } from './stage.js';

const OBSTACLES = ['#scene-tools', '#colorbar', '#legend', '#probe', '#scene-note'];

/** The 3-D view: takes messages, keeps what they hold, and draws it. */
export class SceneView {
  #hash = null;
  #latest = new Map();  // kind -> message not taken in yet
  #truth_hash = null;
  #radius = 0.15;
  #shown = { cloud: true, ghost: true, cables: true };
  #tensions = new UpperEnd(0.1);
  #source = 'live';
  #unseen = false;  // some nodes have no value
  #has = { robot: false, object: false, cables: false, tension: false, fixed: false };
  /** Takes a chosen point of the surface (Vector3, robot frame, m); null: it is probed.
   * @type {((point: Vector3) => void) | null} */
  onSurfacePoint = null;

  constructor(feed, send, contact_colors) {
    this.stage = new Stage(byId('view'));
    this.robot = new Robot();
    this.ghost = new Ghost();
    this.clouds = { robot: new Cloud('cloud', 1.3), object: new Cloud('object', 2) };
    this.fixed = new Cloud('fixed', 6);
    this.markers = new Markers();
    this.cables = new Cables();
    this.drawn_cables = new DrawnCables();
    this.floor = new Floor();
    this.arrows = new ForceArrows(contact_colors);
    this.coloring = new Coloring();
    this.colorbar = new ColorBar();
    this.probe = new Probe(send, () => this.stage.draw());
    this.labels = new Labels(byId('labels'), this.stage, OBSTACLES);
    this.cables.group.visible = false;  // without the robot they say nothing
    this.stage.scene.add(this.floor.group, this.robot.group, this.ghost.group,
      this.clouds.robot.points, this.clouds.object.points, this.fixed.points, this.markers.group,
      this.cables.group, this.arrows.estimated.group, this.arrows.truth.group,
      this.drawn_cables.group, this.probe.dot);
    this.stage.onDrawn = () => this.labels.place();
    onClick(byId('view'), (at) => this.chooseAt(at));
    onTheme(() => {
      this.#showForces();
      this.stage.draw();
    });
    this.#listen(feed);
  }

  /** What comes faster than it is drawn is not worth computing: of each kind the latest is taken
   * in before a drawing. */
  #listen(feed) {
    const handlers = {
      truth_mesh_state: (message) => this.#takeTruth(message),
      mesh_state: (message) => this.#takeShape(message),
      robot_cloud: (message) => this.#takeCloud('robot', message),
      object_cloud: (message) => this.#takeCloud('object', message),
      markers: ({ arrays }) => this.markers.set(arrays, this.#radius, performance.now()),
      cables: ({ cables }) => this.#takeCables(cables),
      cable_paths: ({ arrays }) => {
        this.cables.setPaths(arrays);
        this.#has.cables = Object.keys(arrays).length > 0;
      },
      fixed_nodes: ({ arrays }) => {
        this.fixed.set(arrays.points_m);
        this.#has.fixed = arrays.points_m.length > 0;
      },
      truth_forces: ({ forces }) => this.arrows.setTruth(forces),
      forces: ({ forces }) => this.arrows.setEstimated(forces),
    };
    for (const kind of Object.keys(handlers)) {
      feed.on(kind, (message) => {
        this.#latest.set(kind, message);
        this.stage.draw();
      });
    }
    this.stage.beforeDrawing = () => {
      if (this.#latest.size === 0) return;
      for (const [kind, message] of this.#latest) handlers[kind](message);
      this.#latest.clear();
      this.#showForces();
    };
    feed.on('hello', ({ source }) => {
      this.#source = source;
      this.fixed.points.visible = source === 'robot';
    });
    feed.on('mesh', (message) => this.#takeMesh(message));
    feed.on('truth_mesh', (message) => {
      this.#truth_hash = message.hash;
      this.ghost.setMesh(message.arrays);
    });
    feed.on('probe', (answer) => this.probe.take(answer));
  }

  setMode(mode) {
    if (!this.coloring.has(mode)) return;
    this.coloring.mode = mode;
    this.#paintRobot();
    this.stage.draw();
  }

  /** @param {'cloud' | 'ghost' | 'cables'} part */
  toggle(part) {
    this.#shown[part] = !this.#shown[part];
    this.clouds.robot.points.visible = this.clouds.object.points.visible = this.#shown.cloud;
    this.markers.group.visible = this.#shown.cloud;
    this.ghost.group.visible = this.#shown.ghost;
    this.cables.group.visible = this.#shown.cables && this.robot.mesh !== null;
    this.#showForces();
    this.stage.draw();
    return this.#shown[part];
  }

  /** @param {{x: number, y: number}} at of the canvas, -1 to 1 */
  chooseAt(at) {
    if (this.onSurfacePoint) {
      const point = pointAt(this.stage, this.robot, at);
      if (point) this.onSurfacePoint(point);
      return;
    }
    this.probe.choose(nodeAt(this.stage, this.robot, at), this.robot.surface, this.#radius);
    this.stage.draw();
  }

  /** @param {import('../cables/cable_drafts.js').CableDrafts} drafts */
  showDrafts(drafts) {
    this.drawn_cables.set(drafts, this.#radius);
    this.#showForces();
    this.stage.draw();
  }

  closeProbe() {
    this.probe.close();
    this.stage.draw();
  }

  #takeMesh({ hash, arrays }) {
    const is_new = hash !== this.#hash;
    this.#hash = hash;
    this.robot.setMesh(arrays);
    this.coloring.set('displacement', this.robot.surface.displacements());
    this.coloring.set('residual', null);
    this.coloring.set('stiffness', arrays.stiffness_Pa ?? null);
    if (this.#source === 'robot') this.coloring.mode = 'stiffness';
    if (is_new) this.#fit(arrays.rest_m);
    byId('scene-empty').hidden = true;
    this.cables.group.visible = this.#shown.cables;
    this.#paintRobot();
    this.stage.draw();
  }

  #fit(rest_m) {
    const points = Array.from({ length: rest_m.length / 3 },
      (_, i) => new Vector3().fromArray(rest_m, 3 * i));
    const { center, radius } = new Sphere().setFromPoints(points);
    const lowest = points.reduce((low, { z }) => Math.min(low, z), Infinity);
    this.#radius = radius;
    this.floor.set(center, lowest - 0.002 * radius, radius);
    this.stage.fit(center, radius);
  }

  #takeTruth({ hash, arrays }) {
    if (this.ghost.surface && hash === this.#truth_hash) {
      this.ghost.surface.move(arrays.positions_m);
    }
  }

  /** @param {'robot' | 'object'} what */
  #takeCloud(what, { arrays }) {
    this.clouds[what].set(arrays.points_m);
    this.#has[what] = arrays.points_m.length > 0;
  }

  #takeShape({ hash, status, arrays }) {
    if (hash !== this.#hash) return;  // its mesh is on the way
    this.robot.surface.move(arrays.positions_m);
    this.coloring.set('displacement', this.robot.surface.displacements());
    this.coloring.set('residual', arrays.residual_m ?? null);
    const usable = status === 'ok';
    byId('scene-note').hidden = usable;
    setText(byId('scene-note'), usable ? '' : `Shape not usable: ${status.replaceAll('_', ' ')}`);
    this.probe.follow(this.robot.surface);
    this.#paintRobot();
  }

  #paintRobot() {
    for (const mode of Object.keys(MODES)) {
      const button = byId(`color-${mode}`);
      const has = this.coloring.has(mode);
      button.setAttribute('aria-disabled', String(!has));
      button.title = has ? '' : MODES[mode].absent;
    }
    if (!this.coloring.has(this.coloring.mode)) this.coloring.mode = 'displacement';
    for (const mode of Object.keys(MODES)) {
      byId(`color-${mode}`).setAttribute('aria-checked', String(mode === this.coloring.mode));
    }
    const range = this.coloring.current(performance.now());
    if (!range) return;
    this.robot.paint(range.values, range.low, range.high);
    this.colorbar.show(this.coloring.mode, range);
    this.#unseen = range.known < range.values.length;
  }

  #takeCables(cables) {
    const known = cables.filter(({ tension_N }) => Number.isFinite(tension_N));
    const tensions = new Map(known.map(({ name, tension_N }) => [name, tension_N]));
    this.#tensions.update(Math.max(0, ...tensions.values()), performance.now());
    this.#has.tension = tensions.size > 0;
    this.cables.setTensions(tensions, this.#tensions.value);
  }

  /** An experiment may have no estimates at all. */
  #hasForces() {
    return ['live', 'recording'].includes(this.#source) || this.arrows.hasEstimates();
  }

  #showForces() {
    this.labels.set([...this.arrows.show(this.#radius, performance.now()),
      ...this.drawn_cables.labels()]);
    const ghost = this.#shown.ghost && this.ghost.surface !== null;
    showLegend({
      forces: this.robot.surface !== null && this.#hasForces(),
      truth: this.ghost.surface !== null && !this.arrows.hasKnownLoads(),
      known_loads: this.arrows.hasKnownLoads(),
      ghost,
      markers: this.#shown.cloud ? this.markers.count : 0,
      residual_factor: this.markers.factor,
      cloud: this.#has.robot && this.#shown.cloud,
      objects: this.#has.object && this.#shown.cloud,
      cables: this.#has.cables && this.#shown.cables,
      new_cables: this.drawn_cables.labels().length > 0,
      fixed: this.#has.fixed && this.fixed.points.visible,
      is_file: this.#source === 'robot',
      highest_tension_N: this.#has.tension ? this.#tensions.value : 0,
      grid_m: this.floor.spacing_m,
      metres_per_newton: this.arrows.metresPerNewton(this.#radius),
      unseen: this.#unseen,
    });
  }
}
