// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { byId, element, replaceIfChanged, setText } from '../ui/dom.js';
import { number, round } from '../ui/format.js';
import { cssGradient } from './colormap.js';
import { MODES } from './coloring.js';
import { niceTicks } from './scale.js';

const TICKS = 5;

/** The scale of the robot's colours with numbers and unit. */
export class ColorBar {
  constructor() {
    this.node = byId('colorbar');
    byId('colorbar-strip').style.background = cssGradient('viridis', 'to top');
  }

  /** @param {ReturnType<import('./coloring.js').Coloring['current']>} range */
  show(mode, range) {
    const { title, unit, factor } = MODES[mode];
    this.node.hidden = false;
    const [low, high] = [factor * range.low, factor * range.high];
    setText(byId('colorbar-title'), `${title} (${unit})`);
    this.node.setAttribute('aria-label',
      `${title} from ${number(low)} to ${number(high)} ${unit}`);
    const is_one = high - low < 1e-6 * high;
    const ticks = is_one ? [high] : niceTicks(low, high, TICKS);
    replaceIfChanged(byId('colorbar-ticks'), ...ticks.map((tick) => {
      const share = is_one ? 0.5 : (tick - low) / (high - low);
      return element('span', { style: `bottom: ${(100 * share).toFixed(2)}%` }, round(tick));
    }));
  }

  hide() {
    this.node.hidden = true;
  }
}
