// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { byId, setText } from './dom.js';
import { duration } from './format.js';

const NOTICE_MS = 6000;
const UPDATE_MS = 200;

/** The line under the header: a lost connection, else a held display, else a notice. */
export class Banner {
  #lost = null;  // { since_ms, retry_at_ms }
  #held = false;
  #notice = null;  // { text, until_ms }

  /** @param {{openNow: () => void, goOn: () => void}} actions */
  constructor(actions) {
    this.actions = actions;
    byId('banner-button').addEventListener('click', () => this.#act());
    setInterval(() => this.update(), UPDATE_MS);
  }

  lost(retry_at_ms) {
    const since_ms = this.#lost?.since_ms ?? performance.now();
    this.#lost = { since_ms, retry_at_ms };
    this.update();
  }

  found() {
    this.#lost = null;
    this.update();
  }

  hold(held) {
    this.#held = held;
    this.update();
  }

  tell(text) {
    this.#notice = { text, until_ms: performance.now() + NOTICE_MS };
    this.update();
  }

  update() {
    const now_ms = performance.now();
    if (this.#notice?.until_ms < now_ms) this.#notice = null;
    const [text, button, state] = this.#content(now_ms);
    byId('banner').hidden = text === '';
    byId('banner').dataset.state = state;
    setText(byId('banner-text'), text);
    setText(byId('banner-button'), button);
  }

  #content(now_ms) {
    if (this.#lost) {
      const wait_s = (this.#lost.retry_at_ms - now_ms) / 1000;
      const next = wait_s > 0.05 ? `Next try in ${duration(wait_s)}.` : 'Trying.';
      const since = duration((now_ms - this.#lost.since_ms) / 1000);
      return [`No connection to palpate-view for ${since}. ${next}`, 'Try now', 'lost'];
    }
    if (this.#notice) return [this.#notice.text, 'Close', 'notice'];
    if (this.#held) return ['The display is held; the system goes on.', 'Go on', 'notice'];
    return ['', '', ''];
  }

  #act() {
    if (this.#lost) this.actions.openNow();
    else if (this.#notice) this.#notice = null;
    else if (this.#held) this.actions.goOn();
    this.update();
  }
}
