// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { byId, element, replaceIfChanged } from '../ui/dom.js';
import { millimetres, round } from '../ui/format.js';

/** What is drawn, and nothing else.
 * @param {{forces: boolean, truth: boolean, known_loads: boolean, cloud: boolean,
 *     objects: boolean, ghost: boolean, markers: number, residual_factor: number,
 *     cables: boolean, is_file: boolean, new_cables: boolean, fixed: boolean,
 *     highest_tension_N: number, grid_m: number, metres_per_newton: number,
 *     unseen: boolean}} what */
export function showLegend(what) {
  const rows = [];
  const add = (mark, text) =>
    rows.push(element('li', {}, element('i', { class: `mark ${mark}` }), text));
  const arrow = millimetres(0.1 * what.metres_per_newton);
  if (what.forces) add('mark-force', `estimated force, 0.1 N = ${arrow}; sleeve: 95 %`);
  if (what.truth) add('mark-truth', 'true force');
  if (what.known_loads) add('mark-truth', `known load, 0.1 N = ${arrow}`);
  if (what.ghost) add('mark-ghost', 'true shape');
  if (what.cloud) add('mark-cloud', 'measured, robot');
  if (what.markers > 0) {
    add('mark-marker', 'marker as measured');
    if (what.residual_factor > 0) {
      add('mark-residual', `from the model to the marker, × ${what.residual_factor}`);
    }
  }
  if (what.objects) add('mark-object', 'measured, other objects');
  if (what.cables) {
    const known = what.highest_tension_N > 0;
    add(known ? 'mark-tension' : 'mark-cable',
      known ? `cable, 0 to ${round(what.highest_tension_N)} N`
        : what.is_file ? 'cable of the robot file' : 'cable, tension unknown');
  }
  if (what.fixed) add('mark-fixed', 'fixed');
  if (what.new_cables) add('mark-new-cable', 'new cable, drawn by clicks');
  if (what.unseen) add('mark-unseen', 'not measured');
  if (what.grid_m > 0) add('mark-grid', `grid ${round(1000 * what.grid_m)} mm`);
  replaceIfChanged(byId('legend'), ...rows);
}
