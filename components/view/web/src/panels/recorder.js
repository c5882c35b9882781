// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { byId, setText } from '../ui/dom.js';
import { bytes, duration } from '../ui/format.js';

/** The button that records all topics. Where that may not be it stays readable, and says why. */
export class RecorderButton {
  #state = { recording: false, allowed: false, reason: 'The recorder has not reported yet.' };

  /** @param {(message: object) => boolean} send @param {(text: string) => void} tell */
  constructor(feed, send, tell) {
    this.button = byId('record');
    feed.on('hello', ({ read_only }) => {
      const reason = read_only ? 'This page may only read.' : 'The recorder has not reported yet.';
      this.#take({ recording: false, allowed: false, reason });
    });
    feed.on('recorder', (message) => this.#take(message));
    this.button.addEventListener('click', () => {
      if (this.#state.allowed) send({ kind: 'record', on: !this.#state.recording });
      else tell(`Cannot record. ${this.#state.reason}`);
    });
    this.#take(this.#state);
  }

  #take(state) {
    this.#state = state;
    const { recording, allowed, reason, file, seconds } = state;
    this.button.setAttribute('aria-disabled', String(!allowed));
    this.button.setAttribute('aria-pressed', String(recording));
    setText(byId('record-text'), recording
      ? `${duration(seconds)}, ${bytes(state.bytes)}` : 'Record');
    const why = allowed ? (recording ? `Writes ${file}. Click to end.` : 'Record all topics')
      : reason || 'Not allowed.';
    this.button.title = why;
    this.button.setAttribute('aria-label', recording ? `End the recording ${file}` : 'Record');
    setText(byId('record-reason'), why);
  }
}
