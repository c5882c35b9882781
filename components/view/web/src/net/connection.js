// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { decodeMessage } from './message.js';

const FIRST_WAIT_MS = 250;
const LONGEST_WAIT_MS = 5000;
/** A server that accepts and then says nothing. */
const HELLO_WITHIN_MS = 5000;

/** Where the page's own server listens; a token in the page's address is passed on. */
export function liveUrl(location) {
  const url = new URL('live', location.href);
  url.protocol = location.protocol === 'https:' ? 'wss:' : 'ws:';
  url.search = location.search;
  url.hash = '';
  return url.href;
}

/** The WebSocket to the server. It is opened again, with growing waits, each time it is lost. */
export class Connection {
  #socket = null;
  #wait_ms = FIRST_WAIT_MS;
  #timer = 0;

  /**
   * @param {string} url
   * @param {{onMessage: (message: object) => void,
   *          onState: (state: {open: boolean, retry_at_ms?: number}) => void}} handlers
   */
  constructor(url, handlers) {
    this.url = url;
    this.handlers = handlers;
  }

  open() {
    clearTimeout(this.#timer);
    const socket = new WebSocket(this.url);
    this.#socket = socket;
    socket.binaryType = 'arraybuffer';
    this.#timer = setTimeout(() => socket.close(), HELLO_WITHIN_MS);
    socket.onmessage = ({ data }) => this.#take(data);
    socket.onclose = () => this.#lose(socket);
  }

  /** Tries at once instead of after the wait. */
  openNow() {
    if (this.#socket?.readyState === WebSocket.CLOSED) this.open();
  }

  /** @returns {boolean} false where there is no connection */
  send(message) {
    if (this.#socket?.readyState !== WebSocket.OPEN) return false;
    this.#socket.send(JSON.stringify(message));
    return true;
  }

  #take(data) {
    let message;
    try {
      message = decodeMessage(data);
    } catch (error) {
      message = { kind: 'unreadable', reason: error.message };
    }
    if (message.kind === 'hello') {
      clearTimeout(this.#timer);
      this.#wait_ms = FIRST_WAIT_MS;
      this.handlers.onState({ open: true });
    }
    this.handlers.onMessage(message);
  }

  #lose(socket) {
    if (socket !== this.#socket) return;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.open(), this.#wait_ms);
    this.handlers.onState({ open: false, retry_at_ms: performance.now() + this.#wait_ms });
    this.#wait_ms = Math.min(2 * this.#wait_ms, LONGEST_WAIT_MS);
  }
}
