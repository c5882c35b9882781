// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

const TYPES = { float32: Float32Array, uint32: Uint32Array, uint8: Uint8Array };

/**
 * A message of the server. Text is JSON. Binary is a uint32 (little endian) N, N bytes of JSON, and
 * arrays, whose places the JSON names in `arrays`. They come back as views into the buffer, so a
 * message must be kept or dropped as a whole.
 * @param {string | ArrayBuffer} data
 * @throws {Error} where the message is not what it says
 */
export function decodeMessage(data) {
  if (typeof data === 'string') return JSON.parse(data);
  const header_bytes = new DataView(data).getUint32(0, true);
  const begin = 4 + header_bytes;
  const text = new TextDecoder().decode(new Uint8Array(data, 4, header_bytes));
  const message = JSON.parse(text);
  const arrays = {};
  for (const [name, { type, offset, length }] of Object.entries(message.arrays ?? {})) {
    arrays[name] = new TYPES[type](data, begin + offset, length);
  }
  return { ...message, arrays };
}
