// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { byId, element } from './dom.js';

const TURN_RAD = 0.12;
const SEEK_S = 5;

/** Elements that use a key themselves. */
const OWN_KEYS = {
  BUTTON: new Set([' ', 'Enter']),
  SUMMARY: new Set([' ', 'Enter']),
  INPUT: 'all',
  SELECT: 'all',
  TEXTAREA: 'all',
};

/** Keys of the page and what they do, in the order of the list that `?` shows. */
export function startKeys({ view, camera, switchTheme, toggle, pauseOrGoOn, player, new_cables }) {
  const keys = [
    [[' '], 'space', 'hold the display; pause a player', pauseOrGoOn],
    [['1'], '1', 'colour by displacement', () => view?.setMode('displacement')],
    [['2'], '2', 'colour by residual', () => view?.setMode('residual')],
    [['3'], '3', 'colour by stiffness', () => view?.setMode('stiffness')],
    [['c'], 'c', 'measured points', () => toggle('cloud')],
    [['g'], 'g', 'true shape of a virtual robot', () => toggle('ghost')],
    [['l'], 'l', 'cables', () => toggle('cables')],
    [['r'], 'r', 'reset the view', () => view?.stage.resetView()],
    [['ArrowLeft'], '← →', 'turn the view', () => view?.stage.orbit(-TURN_RAD, 0)],
    [['ArrowRight'], '', '', () => view?.stage.orbit(TURN_RAD, 0)],
    [['ArrowUp'], '↑ ↓', 'tilt the view', () => view?.stage.orbit(0, TURN_RAD)],
    [['ArrowDown'], '', '', () => view?.stage.orbit(0, -TURN_RAD)],
    [['+', '='], '+ −', 'zoom', () => view?.stage.zoom(0.88)],
    [['-'], '', '', () => view?.stage.zoom(1 / 0.88)],
    [['p'], 'p', 'choose the point of the surface at the centre (or click it)',
      () => view?.chooseAt({ x: 0, y: 0 })],
    [['u'], 'u', 'robot file: take back the last point of a cable', () => new_cables.undo()],
    [['n'], 'n', 'robot file: next cable', () => new_cables.finish()],
    [['Escape'], 'Esc', 'close', () => view?.closeProbe()],
    [['d'], 'd', 'colour or depth image', () => camera.other()],
    [['s'], 's', 'segments over the image', () => camera.toggleOverlay()],
    [[','], ', .', 'player: 5 s back, 5 s on', () => player.seek(-SEEK_S)],
    [['.'], '', '', () => player.seek(SEEK_S)],
    [['t'], 't', 'light or dark', switchTheme],
    [['?'], '?', 'this list', () => openHelp()],
  ];
  const actions = new Map(keys.flatMap(([names, , , action]) =>
    names.map((name) => [name, action])));
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || byId('help').open) return;
    const own = OWN_KEYS[event.target.tagName];
    if (own === 'all' || own?.has(event.key)) return;
    const action = actions.get(event.key.length === 1 ? event.key.toLowerCase() : event.key);
    if (!action) return;
    event.preventDefault();
    action();
  });
  byId('help-keys').append(...keys.filter(([, shown]) => shown).flatMap(([, shown, text]) =>
    [element('dt', {}, ...shown.split(' ').map((key) => element('kbd', {}, key))),
      element('dd', {}, text)]));
  byId('help-open').addEventListener('click', openHelp);
  byId('help-close').addEventListener('click', () => byId('help').close());
  // Else the hidden button keeps the focus, and the space bar, until the next drawing.
  byId('help').addEventListener('close', () => {
    if (byId('help').contains(document.activeElement)) document.activeElement.blur();
  });
}

function openHelp() {
  byId('help').showModal();
}
