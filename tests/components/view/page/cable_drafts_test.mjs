// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0
// Cables that are drawn by clicks, without a page.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';

const CABLES = join(process.env.PALPATE_SOURCE_DIR, 'components/view/web/src/cables');
const { CableDrafts } = await import(join(CABLES, 'cable_drafts.js'));
const { optionsText, robotFileText } = await import(join(CABLES, 'cable_texts.js'));

/** Drafts with these points in the current cable. */
function drawn(...points_m) {
  const drafts = new CableDrafts();
  for (const point_m of points_m) assert.equal(drafts.add(point_m), '');
  return drafts;
}

test('keeps tenths of a millimetre, and no sign of a zero', () => {
  const { points_m } = drawn([0.01234, -0.05678, 1e-5], [-4e-5, 0.1, -0.25]).current;
  assert.deepEqual(points_m, [[0.0123, -0.0568, 0], [0, 0.1, -0.25]]);
  assert.ok(points_m.flat().every((x) => !Object.is(x, -0)));
});

test('two points make a cable, one does not', () => {
  const drafts = drawn([0, 0, 0]);
  assert.deepEqual(drafts.complete, []);
  assert.match(drafts.finish(), /two points at least/);
  drafts.add([0, 0, 0.1]);
  assert.deepEqual(drafts.complete, [{ name: 'cable_1', points_m: [[0, 0, 0], [0, 0, 0.1]] }]);
  assert.equal(drafts.finish(), '');
  assert.deepEqual(drafts.current, { name: 'cable_2', points_m: [] });
});

test('refuses the same point twice in a row, as new-robot does', () => {
  const drafts = drawn([0, 0, 0]);
  assert.match(drafts.add([0, 0, 4e-5]), /same point/);
  assert.equal(drafts.current.points_m.length, 1);
  for (const point_m of [[0, 0, 0.1], [0, 0, 0]]) assert.equal(drafts.add(point_m), '');
});

test('takes points back, over the end of a finished cable, until nothing is left', () => {
  const drafts = drawn([0, 0, 0], [0, 0, 0.1]);
  drafts.setName('up');
  drafts.finish();
  drafts.add([0.1, 0, 0]);
  drafts.undo();
  assert.deepEqual(drafts.finished.map(({ name }) => name), ['up']);
  drafts.undo();
  assert.deepEqual(drafts.current, { name: 'up', points_m: [[0, 0, 0], [0, 0, 0.1]] });
  assert.deepEqual(drafts.finished, []);
  for (let i = 0; i < 3; ++i) drafts.undo();
  assert.ok(drafts.isEmpty);
});

test('takes names that a shell, YAML and a table read as they are, and no other', () => {
  const drafts = drawn([0, 0, 0], [0, 0, 0.1]);
  for (const bad of ['', '$(reboot)', '`reboot`', 'a"b', 'a;b', 'a,b', 'a=b', '-x', 'a\\b', 'a!']) {
    drafts.setName(bad);
    assert.notEqual(drafts.whyNotName(), '', bad);
    assert.deepEqual(drafts.complete, [], bad);
    assert.notEqual(drafts.finish(), '', bad);
  }
  for (const [typed, name] of [['up', 'up'], [' left tip ', 'left_tip'], ['Zug-2', 'Zug-2'],
    ['größe', 'größe'], ['no', 'no']]) {
    drafts.setName(typed);
    assert.equal(drafts.whyNotName(), '');
    assert.equal(drafts.complete[0].name, name);
  }
});

test('refuses the name of another drawn cable, and suggests none that is taken', () => {
  const drafts = drawn([0, 0, 0], [0, 0, 0.1]);
  drafts.setTaken(['cable_1', 'cable_3']);
  assert.equal(drafts.current.name, 'cable_2');
  drafts.finish();
  assert.equal(drafts.current.name, 'cable_4');
  drafts.setName('cable_2');
  assert.match(drafts.whyNotName(), /already/);
});

test('writes options that new-robot takes', () => {
  const up = { name: 'up', points_m: [[0, 0.015, 0.03], [0.1, 0.015, 0.03]] };
  assert.equal(optionsText([up]), '--cable "up=0.0000,0.0150,0.0300; 0.1000,0.0150,0.0300 m"');
  assert.equal(optionsText([up, { ...up, name: 'down' }]).split(' \\\n').length, 2);
  assert.equal(optionsText([]), '');
});

test('writes lines of a robot file, with the key where the file has none', () => {
  const no = { name: 'no', points_m: [[0, 0.015, 0.03], [-0.1, 0.015, 0.03]] };
  const lines = '  - name: "no"\n    path_m:\n' +
    '      - [0.0000, 0.0150, 0.0300]\n      - [-0.1000, 0.0150, 0.0300]\n';
  assert.equal(robotFileText([no], false), `cables:\n${lines}`);
  assert.equal(robotFileText([no], true), lines);
  assert.equal(robotFileText([], false), '');
});
