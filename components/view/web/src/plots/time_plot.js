// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import uPlot from 'uplot';
import { niceAbove } from '../scene/scale.js';
import { byId, element, replaceIfChanged } from '../ui/dom.js';
import { isNumber, number } from '../ui/format.js';
import { color, onTheme } from '../ui/theme.js';
import { TimeSeries } from './time_series.js';

const WINDOW_S = 30;
const DRAW_EVERY_MS = 100;

/**
 * A line of a plot. band: columns of its interval's ends; they are then not lines themselves.
 * @typedef {{label: string, color: string, dash?: number[], width?: number,
 *            band?: [number, number], hidden?: boolean, quiet?: boolean}} Line
 */

/** One panel with lines over the last 30 s, and in its title the values now, or where the pointer
 * is. */
export class TimePlot {
  #next_ms = 0;
  #timer = 0;

  /** @param {string} id of the panel @param {Line[]} lines @param {number} least of the scale */
  constructor(id, lines, least) {
    this.lines = lines;
    this.least = least;
    this.panel = byId(id);
    this.body = this.panel.querySelector('.body');
    this.values = this.panel.querySelector('.values');
    this.series = new TimeSeries(lines.length, WINDOW_S);
    this.plot = new uPlot(this.#options(), [[], ...lines.map(() => [])], this.body);
    new ResizeObserver(() => this.#resize()).observe(this.body);
    onTheme(() => this.plot.redraw());
    this.#resize();
  }

  push(stamp_ns, values) {
    this.series.push(stamp_ns, values.map((value) => (isNumber(value) ? value : null)));
    this.#drawSoon();
  }

  #drawSoon() {
    if (this.#timer) return;
    const wait_ms = Math.max(0, this.#next_ms - performance.now());
    this.#timer = setTimeout(() => {
      this.#timer = 0;
      this.#next_ms = performance.now() + DRAW_EVERY_MS;
      this.plot.setData(this.series.table());
      this.#showValues();
    }, wait_ms);
  }

  #showValues() {
    const index = this.plot.cursor.idx ?? this.series.times_s.length - 1;
    replaceIfChanged(this.values, ...this.lines.flatMap((line, i) => {
      const value = this.series.columns[i][index];
      if (line.hidden || (line.quiet && !isNumber(value))) return [];
      return [element('span', { style: `--color: var(--${line.color})` },
        element('i', { class: line.dash ? 'dashed' : '' }),
        line.quiet ? null : `${line.label} `, element('b', {}, number(value ?? NaN)))];
    }));
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.body;
    if (width && height) this.plot.setSize({ width, height });
  }

  #options() {
    const axis = {
      stroke: () => color('muted'),
      grid: { stroke: () => color('plot-grid'), width: 1 },
      ticks: { show: false },
      font: `11px ${getComputedStyle(document.body).fontFamily}`,
    };
    return {
      width: 200,
      height: 100,
      padding: [8, 14, 0, 0],
      legend: { show: false },
      cursor: { y: false, points: { show: false }, drag: { x: false, y: false } },
      scales: {
        x: { time: false, range: () => [-WINDOW_S, 0] },
        y: { range: (_, low, high) => this.#range(low, high) },
      },
      axes: [
        { ...axis, size: 22, gap: 5, values: (_, at) => at.map((s) => (s ? `−${-s} s` : 'now')),
          splits: () => [-30, -20, -10, 0] },
        { ...axis, size: 38, gap: 4, space: 26 },
      ],
      series: [{}, ...this.lines.map((line) => ({
        label: line.label,
        stroke: () => (line.hidden ? 'transparent' : color(line.color)),
        width: line.hidden ? 0 : (line.width ?? 1.5),
        dash: line.dash,
        points: { show: false },
        spanGaps: false,
      }))],
      bands: this.lines.flatMap((line) => (line.band
        ? [{ series: [line.band[1] + 1, line.band[0] + 1], fill: () => veil(color(line.color)) }]
        : [])),
      hooks: { setCursor: [() => this.#showValues()] },
    };
  }

  #range(low, high) {
    const top = Math.max(high ?? 0, this.least);
    const step = niceAbove(top / 4);
    return [Math.min(low ?? 0, 0), step * Math.ceil(top / step)];
  }
}

/** "rgb(r, g, b)" to the same, seen through. */
function veil(css) {
  return css.replace('rgb(', 'rgba(').replace(')', ', 0.2)');
}
