// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { byId, setText } from '../ui/dom.js';
import { position } from '../ui/format.js';

/** Controls of the recording that is shown; hidden where the data are live. */
export class PlayerBar {
  #state = null;
  #dragging = false;

  constructor(feed, send, freshness) {
    this.send = send;
    this.freshness = freshness;
    this.slider = byId('player-position');
    feed.on('hello', () => this.#take(null));
    feed.on('player', (message) => this.#take(message));
    byId('player-pause').addEventListener('click', () => this.pauseOrGoOn());
    byId('player-rate').addEventListener('change', ({ target }) =>
      this.#play({ rate: Number(target.value) }));
    this.slider.addEventListener('input', () => {
      this.#dragging = true;
      this.#showTime(Number(this.slider.value));
    });
    this.slider.addEventListener('change', () => {
      this.#dragging = false;
      this.#seekTo(Number(this.slider.value));
    });
  }

  isThere() {
    return this.#state !== null;
  }

  pauseOrGoOn() {
    this.#play({ paused: !this.#state.paused });
  }

  seek(step_s) {
    if (this.#state) this.#seekTo(this.#state.position_s + step_s);
  }

  #play(change) {
    const { paused, rate } = { ...this.#state, ...change };
    this.send({ kind: 'play', paused, rate });
  }

  #seekTo(position_s) {
    const within = Math.min(Math.max(position_s, 0), this.#state.duration_s);
    this.send({ kind: 'seek', position_s: within });
  }

  #take(state) {
    this.#state = state;
    byId('player').hidden = state === null;
    this.freshness.paused = state?.paused ?? false;
    if (!state) return;
    const button = byId('player-pause');
    setText(button, state.paused ? 'Play' : 'Pause');
    this.slider.max = state.duration_s;
    const rates = byId('player-rate');
    if ([...rates.options].some((option) => Number(option.value) === state.rate)) {
      rates.value = String(state.rate);
    }
    if (this.#dragging) return;
    this.slider.value = state.position_s;
    this.#showTime(state.position_s);
  }

  #showTime(position_s) {
    const part = this.#state.part ? `${this.#state.part.replaceAll('_', ' ')}, ` : '';
    const text = `${part}${position(position_s)} / ${position(this.#state.duration_s)}`;
    setText(byId('player-time'), text);
    this.slider.setAttribute('aria-valuetext', text);
  }
}
