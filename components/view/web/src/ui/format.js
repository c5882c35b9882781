// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

const DIGITS = 3;
const NONE = '–';
const SMALLEST = 5e-7;  // six decimals are the most that are shown

export const isNumber = (x) => typeof x === 'number' && Number.isFinite(x);

/** Decimals that give a number three significant digits. */
function decimals(x) {
  if (x === 0) return 0;
  const rounded = Number(Math.abs(x).toPrecision(DIGITS));
  return Math.max(0, DIGITS - 1 - Math.floor(Math.log10(rounded)));
}

/** Three significant digits without an exponent, "0.0123", "12.3", "1230". */
export function number(x) {
  if (!isNumber(x)) return NONE;
  if (Math.abs(x) < SMALLEST) return '0';
  const text = Number(x.toPrecision(DIGITS)).toFixed(Math.min(decimals(x), 6));
  return text.replace('-', '−');
}

/** For ends of scales, which are round: no zeros behind. */
export const round = (x) => String(Number(x.toPrecision(DIGITS)));

export function withUnit(x, unit) {
  return isNumber(x) ? `${number(x)} ${unit}` : NONE;
}

/** "0.498 ± 0.072 N": the interval has the decimals of the number. */
export function withInterval(x, half_width, unit) {
  if (!isNumber(x)) return NONE;
  if (!isNumber(half_width)) return `${number(x)} ${unit}`;
  // A number far below its interval has no more decimals than the interval needs.
  const places = Math.min(decimals(Math.max(Math.abs(x), half_width / 10)), 6);
  return `${x.toFixed(places).replace('-', '−')} ± ${half_width.toFixed(places)} ${unit}`;
}

/** Two decimals, for columns of numbers that change. */
export function hundredths(x, unit) {
  if (!isNumber(x)) return NONE;
  return `${x.toFixed(2).replace(/^-0\.00$/, '0.00').replace('-', '−')} ${unit}`;
}

export const millimetres = (m) => withUnit(isNumber(m) ? 1000 * m : NaN, 'mm');
export const milliseconds = (s) => withUnit(isNumber(s) ? 1000 * s : NaN, 'ms');

/** One decimal for places in the robot frame: tenths of a millimetre. */
export function place(position_m) {
  return position_m.map((m) => (1000 * m).toFixed(1).replace(/^-0\.0$/, '0.0').replace('-', '−'))
    .join(', ');
}

export function duration(s) {
  if (!isNumber(s)) return NONE;
  if (s < 9.95) return `${Math.max(s, 0).toFixed(1)} s`;
  if (s < 100) return `${Math.round(s)} s`;
  if (s < 6000) return `${Math.round(s / 60)} min`;
  if (s < 48 * 3600) return `${Math.round(s / 3600)} h`;
  return `${Math.round(s / 86400)} d`;
}

/** "1:05.3" of a recording. */
export function position(s) {
  const minutes = Math.floor(s / 60);
  return `${minutes}:${(s - 60 * minutes).toFixed(1).padStart(4, '0')}`;
}

export function bytes(count) {
  const units = ['B', 'kB', 'MB', 'GB', 'TB'];
  let step = 0;
  while (count >= 1000 && step < units.length - 1) {
    count /= 1000;
    step += 1;
  }
  return `${step ? number(count) : count} ${units[step]}`;
}

/** Seconds between two "*_ns" strings, which are beyond the whole numbers of a double. */
export function secondsBetween(from_ns, to_ns) {
  return Number(BigInt(to_ns) - BigInt(from_ns)) / 1e9;
}
