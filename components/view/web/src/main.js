// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import './style/app.css';
import { Connection, liveUrl } from './net/connection.js';
import { Feed } from './net/feed.js';
import { CablesPanel } from './panels/cables.js';
import { CalibrationPanel } from './panels/calibration.js';
import { CameraPanel } from './panels/camera.js';
import { ForcesPanel } from './panels/forces.js';
import { NewCablesPanel } from './panels/new_cables.js';
import { PlayerBar } from './panels/player.js';
import { ProcessesPanel } from './panels/processes.js';
import { RecorderButton } from './panels/recorder.js';
import { Verdict } from './panels/verdict.js';
import { Plots } from './plots/plots.js';
import { SceneView } from './scene/view.js';
import { Banner } from './ui/banner.js';
import { ContactColors } from './ui/contact_colors.js';
import { byId, setText } from './ui/dom.js';
import { Freshness } from './ui/freshness.js';
import { startKeys } from './ui/keys.js';
import { startTheme, switchTheme } from './ui/theme.js';

const SOURCES = { live: 'live', recording: 'recording', experiment: 'experiment',
  robot: 'robot file' };
const FIRST_WORDS = { experiment: 'No markers here', robot: 'Undeformed, nothing acts' };
const LINK_EVERY_MS = 500;

startTheme();
const feed = new Feed();
const colors = new ContactColors();
const freshness = new Freshness(feed);
const verdict = new Verdict(feed);
const send = (message) => connection.send(message);
const banner = new Banner({ openNow: () => connection.openNow(), goOn: () => hold(false) });
const camera = new CameraPanel(feed, freshness);
const player = new PlayerBar(feed, send, freshness);
const view = startView();
new ForcesPanel(feed, colors);
new ProcessesPanel(feed);
new CablesPanel(feed);
new CalibrationPanel(feed);
const new_cables = new NewCablesPanel(feed, view, (text) => banner.tell(text));
new RecorderButton(feed, send, (text) => banner.tell(text));
new Plots(feed, colors);

/** Without WebGL the numbers and plots are still worth looking at. */
function startView() {
  try {
    return new SceneView(feed, send, colors);
  } catch (error) {
    setText(byId('scene-empty-text'),
      `This browser cannot draw in 3-D (${error.message}). Numbers and plots work.`);
    return null;
  }
}

function hold(held) {
  feed.held = held;
  freshness.paused = held;
  banner.hold(held);
}

function toggle(part) {
  const shown = view?.toggle(part);
  if (shown !== undefined) byId(`show-${part}`).setAttribute('aria-pressed', String(shown));
}

for (const part of ['cloud', 'ghost', 'cables']) {
  byId(`show-${part}`).addEventListener('click', () => toggle(part));
}
for (const mode of ['displacement', 'residual', 'stiffness']) {
  byId(`color-${mode}`).addEventListener('click', ({ currentTarget }) => {
    if (currentTarget.title) banner.tell(currentTarget.title);
    else view?.setMode(mode);
  });
}
byId('theme').addEventListener('click', switchTheme);
startKeys({
  view, camera, switchTheme, toggle, player, new_cables,
  pauseOrGoOn: () => (player.isThere() ? player.pauseOrGoOn() : hold(!feed.held)),
});

feed.on('hello', ({ source, source_name, version, read_only }) => {
  setText(byId('source'), [SOURCES[source] ?? source, source === 'live' ? '' : source_name]
    .filter(Boolean).join(' '));
  byId('source').dataset.source = document.documentElement.dataset.source = source;
  byId('source').title =
    `palpate ${version}, ${source_name}${read_only ? ', this page may only read' : ''}`;
  const live = source === 'live';
  if (view) {
    setText(byId('scene-empty-text'), live
      ? 'Waiting for the robot, from palpate-force-estimation.'
      : `This ${SOURCES[source] ?? source} has no robot here.`);
  }
  setText(byId('camera-empty'), live ? 'Waiting for images of the camera.'
    : `This ${source} has no images here.`);
  verdict.say(FIRST_WORDS[source] ?? 'Waiting for forces', 'calm');
});
feed.on('mesh', ({ robot }) => {
  setText(byId('robot'), robot.replaceAll('_', ' '));
  document.title = `${robot} – palpate`;
});
feed.on('refused', ({ request, reason }) => banner.tell(`Refused (${request}): ${reason}`));
feed.on('unreadable', ({ reason }) => banner.tell(`A message cannot be read: ${reason}`));

/** What nobody sees need not be sent. */
function subscribe() {
  const seen = !document.hidden;
  send({ kind: 'subscribe', images: seen, clouds: seen });
}
document.addEventListener('visibilitychange', subscribe);
feed.on('hello', () => document.hidden && subscribe());

/** How fast the data come now. */
setInterval(() => {
  const rate_hz = feed.arrivals('mesh_state').rate_hz(performance.now());
  setText(byId('link'), freshness.open && rate_hz > 0 ? `${rate_hz.toFixed(1)} Hz` : '– Hz');
  byId('link').title = 'Shapes of the robot per second';
}, LINK_EVERY_MS);

const connection = new Connection(liveUrl(location), {
  onMessage: (message) => feed.publish(message),
  onState: ({ open, retry_at_ms }) => {
    freshness.open = open;
    document.documentElement.dataset.connected = String(open);
    if (open) {
      banner.found();
    } else {
      banner.lost(retry_at_ms);
      verdict.say('No connection', 'trouble');
    }
    freshness.update();
  },
});
connection.open();
