#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    @foxglove/rosmsg2-serialization 3.1.0 (npm), typed arrays of another element type
# Behaviour  A Float32Array for a float64[2] is written as zeros. For a float64[] the length 2 is
#            written without an element, so that all fields behind it are misread. Other typed
#            arrays and integers do the same, unless the element type is the same. There is no
#            error, and calculateByteSize counts the elements. A plain list is right, and so is the
#            writer for ROS 1 of the same authors with all of them.
# Expected   The numbers are converted, as those of a plain list are, or refused.
# Matters    Points of three.js are Float32Array, those of ROS are often float64. A camera matrix or
#            joint positions of this kind arrive as zeros.
# Needs      npm, node
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

npm install --silent --no-audit --no-fund @foxglove/rosmsg2-serialization@3.1.0 \
  @foxglove/rosmsg-serialization@2.0.4 @foxglove/rosmsg@5.0.5 \
  @foxglove/message-definition@0.5.0 @foxglove/cdr@3.5.0 tslib@2.9.1 >npm.log 2>&1 || {
  cat npm.log >&2
  exit 1
}

cat >try.mjs <<'JS'
import fs from 'node:fs';
import { parse } from '@foxglove/rosmsg';
import * as ros1 from '@foxglove/rosmsg-serialization';
import * as ros2 from '@foxglove/rosmsg2-serialization';

for (const name of ['rosmsg2-serialization', 'rosmsg-serialization', 'rosmsg', 'cdr']) {
  const about = JSON.parse(fs.readFileSync(`node_modules/@foxglove/${name}/package.json`));
  console.log(name, about.version);
}

function rewrite({ MessageReader, MessageWriter }, definition, list) {
  const definitions = parse(definition, { ros2: MessageWriter === ros2.MessageWriter });
  const writer = new MessageWriter(definitions);
  const message = { list, end: 7 };
  const bytes = writer.writeMessage(message);
  const size = `size ${bytes.length}, calculated ${writer.calculateByteSize(message)}`;
  let read;
  try {
    const found = new MessageReader(definitions).readMessage(bytes);
    read = `[${[...found.list].join(', ')}], end ${found.end}`;
  } catch (error) {
    read = 'not readable';
  }
  return `${read}; ${size}`;
}

for (const [type, makers] of [
  ['float64[2]', [Array, Float64Array, Float32Array]],
  ['float64[]', [Array, Float64Array, Float32Array]],
  ['float32[2]', [Float32Array, Float64Array]],
  ['uint16[]', [Uint16Array, Uint8Array]],
]) {
  for (const maker of makers) {
    const list = maker.from([1, 2]);
    console.log(`${type} from ${maker.name}`);
    console.log('  ROS 1:', rewrite(ros1, `${type} list\nint32 end`, list));
    console.log('  ROS 2:', rewrite(ros2, `${type} list\nint32 end`, list));
  }
}
JS

node try.mjs | tee seen

cat >expected <<'SEEN'
rosmsg2-serialization 3.1.0
rosmsg-serialization 2.0.4
rosmsg 5.0.5
cdr 3.5.0
float64[2] from Array
  ROS 1: [1, 2], end 7; size 20, calculated 20
  ROS 2: [1, 2], end 7; size 24, calculated 24
float64[2] from Float64Array
  ROS 1: [1, 2], end 7; size 20, calculated 20
  ROS 2: [1, 2], end 7; size 24, calculated 24
float64[2] from Float32Array
  ROS 1: [1, 2], end 7; size 20, calculated 20
  ROS 2: [0, 0], end 7; size 24, calculated 24
float64[] from Array
  ROS 1: [1, 2], end 7; size 24, calculated 24
  ROS 2: [1, 2], end 7; size 32, calculated 32
float64[] from Float64Array
  ROS 1: [1, 2], end 7; size 24, calculated 24
  ROS 2: [1, 2], end 7; size 32, calculated 32
float64[] from Float32Array
  ROS 1: [1, 2], end 7; size 24, calculated 24
  ROS 2: not readable; size 12, calculated 32
float32[2] from Float32Array
  ROS 1: [1, 2], end 7; size 12, calculated 12
  ROS 2: [1, 2], end 7; size 16, calculated 16
float32[2] from Float64Array
  ROS 1: [1, 2], end 7; size 12, calculated 12
  ROS 2: [0, 0], end 7; size 16, calculated 16
uint16[] from Uint16Array
  ROS 1: [1, 2], end 7; size 12, calculated 12
  ROS 2: [1, 2], end 7; size 16, calculated 16
uint16[] from Uint8Array
  ROS 1: [1, 2], end 7; size 12, calculated 12
  ROS 2: not readable; size 12, calculated 16
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
