// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { CableDrafts, LEAST_POINTS } from '../cables/cable_drafts.js';
import { optionsText, robotFileText } from '../cables/cable_texts.js';
import { byId, element, replaceIfChanged, setText } from '../ui/dom.js';
import { place } from '../ui/format.js';

const COPIED_MS = 2000;

const USES = {
  options: 'Put it behind your palpate new-robot MESH ... command, with --force.',
  file: 'Put it into the robot file.',
};

/** What the next click on the body does. */
function nextStep(count) {
  if (count === 0) return 'Click the body where the cable is pulled from: at its fixed end.';
  if (count < LEAST_POINTS) return 'Click the next eyelet, or where the cable is attached.';
  return 'The last point is where the cable is attached. Click to go on from there.';
}

/** Cables that are drawn by clicks on a robot file's body, and the text that makes them cables of
 * the robot. The page writes no file: the text is copied. */
export class NewCablesPanel {
  #drafts = new CableDrafts();
  #hash = null;
  #file_cables = [];
  #form = 'options';
  #copied = 0;  // timer

  /** @param {import('../scene/view.js').SceneView | null} view null: nothing can be drawn
   * @param {(text: string) => void} tell */
  constructor(feed, view, tell) {
    this.view = view;
    this.tell = tell;
    this.panel = byId('new-cables');
    this.name = byId('new-cable-name');
    this.text = byId('new-cables-text');
    feed.on('hello', ({ source }) => this.#open(source === 'robot'));
    feed.on('mesh', ({ hash }) => this.#takeMesh(hash));
    feed.on('cable_paths', ({ arrays }) => this.#takeFileCables(Object.keys(arrays)));
    this.name.addEventListener('input', () => {
      this.#drafts.setName(this.name.value);
      this.#show();
    });
    this.name.addEventListener('change', () => (this.name.value = this.#drafts.current.name));
    byId('new-cable-undo').addEventListener('click', () => this.undo());
    byId('new-cable-finish').addEventListener('click', () => this.finish());
    byId('new-cables-copy').addEventListener('click', () => this.#copy());
    for (const form of Object.keys(USES)) {
      byId(`new-cables-${form}`).addEventListener('click', () => {
        this.#form = form;
        this.#show();
      });
    }
  }

  undo() {
    if (this.panel.hidden) return;
    this.#drafts.undo();
    this.#showAll();
  }

  finish() {
    if (this.panel.hidden) return;
    this.#sayWhyNot(this.#drafts.finish());
    this.#showAll();
  }

  #open(is_robot_file) {
    this.panel.hidden = !is_robot_file;
    if (this.view) this.view.onSurfacePoint = is_robot_file ? (point) => this.#add(point) : null;
    this.#showAll();
  }

  /** What was drawn on another mesh lies beside this one. */
  #takeMesh(hash) {
    if (hash !== this.#hash) {
      this.#drafts.clear();
      this.#file_cables = [];
    }
    this.#hash = hash;
    this.#showAll();
  }

  #takeFileCables(names) {
    if (names.join() === this.#file_cables.join()) return;
    this.#file_cables = names;
    this.#drafts.setTaken(names);
    this.#showAll();
  }

  #add(point) {
    this.#sayWhyNot(this.#drafts.add(point.toArray()));
    this.#showAll();
  }

  #sayWhyNot(reason) {
    if (reason) this.tell(reason);
  }

  #showAll() {
    if (this.panel.hidden) return;
    const { name } = this.#drafts.current;
    if (this.name.value !== name) this.name.value = name;
    this.#show();
  }

  #show() {
    const drafts = this.#drafts;
    const { points_m } = drafts.current;
    this.view?.showDrafts(drafts);
    setText(byId('new-cable-next'), this.view ? nextStep(points_m.length)
      : 'This browser cannot draw in 3-D, so nothing can be clicked.');
    replaceIfChanged(byId('new-cable-points'), ...points_m.map((point_m) =>
      element('li', { 'data-testid': 'new-cable-point' }, `${place(point_m)} mm`)));
    setText(byId('new-cable-reason'), drafts.whyNotName());
    const enable = (id, on) => byId(id).setAttribute('aria-disabled', String(!on));
    enable('new-cable-undo', !drafts.isEmpty);
    enable('new-cable-finish', points_m.length >= LEAST_POINTS && drafts.whyNotName() === '');
    setText(byId('new-cables-list'), this.#listOfCables());
    this.#showText();
  }

  #listOfCables() {
    const words = [];
    if (this.#file_cables.length) words.push(`In the robot file: ${this.#file_cables.join(', ')}.`);
    const names = this.#drafts.finished.map(({ name }) => name);
    if (names.length) words.push(`Drawn: ${names.join(', ')}.`);
    return words.join(' ');
  }

  #showText() {
    const cables = this.#drafts.complete;
    for (const form of Object.keys(USES)) {
      byId(`new-cables-${form}`).setAttribute('aria-checked', String(form === this.#form));
    }
    this.text.value = this.#form === 'options' ? optionsText(cables)
      : robotFileText(cables, this.#file_cables.length > 0);
    byId('new-cables-copy').setAttribute('aria-disabled', String(cables.length === 0));
    setText(byId('new-cables-use'), cables.length ? USES[this.#form]
      : 'Two points make a cable. Its text is then here.');
  }

  async #copy() {
    if (!this.text.value) return this.tell('Nothing to copy: a cable has two points at least.');
    try {
      await navigator.clipboard.writeText(this.text.value);
    } catch {
      // A page that did not come from this machine has no clipboard.
      this.text.select();
      if (!document.execCommand('copy')) return this.tell('The text is selected: press Ctrl-C.');
    }
    clearTimeout(this.#copied);
    setText(byId('new-cables-copy'), 'Copied');
    this.#copied = setTimeout(() => setText(byId('new-cables-copy'), 'Copy'), COPIED_MS);
  }
}
