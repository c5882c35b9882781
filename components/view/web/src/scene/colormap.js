// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// Scales whose lightness rises evenly, and which people with any colour vision read in the same
// order. Anchors at equal distances, of matplotlib's viridis and cividis (CC0).
const ANCHORS = {
  viridis: [
    0x440154, 0x482475, 0x414487, 0x355f8d, 0x2a788e, 0x21918c, 0x22a884, 0x44bf70, 0x7ad151,
    0xbddf26, 0xfde725,
  ],
  cividis: [
    0x00224e, 0x123570, 0x3b496c, 0x575d6d, 0x707173, 0x8a8678, 0xa59c74, 0xc3b369, 0xe1cc55,
    0xfee838,
  ],
};

/** Red, green, blue from 0 to 255 at t from 0 to 1. */
export function sample(name, t) {
  const anchors = ANCHORS[name];
  const at = Math.min(Math.max(t, 0), 1) * (anchors.length - 1);
  const low = Math.min(Math.floor(at), anchors.length - 2);
  return [16, 8, 0].map((shift) => {
    const [a, b] = [anchors[low], anchors[low + 1]].map((color) => (color >> shift) & 255);
    return Math.round(a + (b - a) * (at - low));
  });
}

export function cssGradient(name, direction) {
  const stops = ANCHORS[name].map((hex) => `#${hex.toString(16).padStart(6, '0')}`);
  return `linear-gradient(${direction}, ${stops.join(', ')})`;
}
