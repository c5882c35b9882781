#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    @foxglove/rosmsg2-serialization 3.1.0 with @foxglove/rosmsg 5.0.5 (npm), default values
#            of ROS 2 sequences
# Behaviour  A message that leaves out a sequence with a default value is written with the length 0
#            and then the default's elements. The library's own reader sees an empty sequence, and
#            its elements as the values of the fields that follow. calculateByteSize counts no
#            elements. There is no error. Arrays of fixed length and single values are right.
# Expected   The length 2 before two elements, as for a sequence that is given. Or no default at
#            all, hence the length 0 without elements.
# Matters    A driver with default gains, limits or offsets publishes a message that every reader
#            misreads, from the first field after the sequence on.
# Needs      npm, node
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

npm install --silent --no-audit --no-fund @foxglove/rosmsg2-serialization@3.1.0 \
  @foxglove/rosmsg@5.0.5 @foxglove/message-definition@0.5.0 @foxglove/cdr@3.5.0 >npm.log 2>&1 || {
  cat npm.log >&2
  exit 1
}

cat >try.mjs <<'JS'
import fs from 'node:fs';
import { parse } from '@foxglove/rosmsg';
import { MessageReader, MessageWriter } from '@foxglove/rosmsg2-serialization';

for (const name of ['rosmsg2-serialization', 'rosmsg', 'cdr']) {
  const about = JSON.parse(fs.readFileSync(`node_modules/@foxglove/${name}/package.json`));
  console.log(name, about.version);
}
const show = (message) => JSON.stringify(
    message, (key, value) => ArrayBuffer.isView(value) ? [...value] : value);

function send(definition, message) {
  const definitions = parse(definition, { ros2: true });
  const writer = new MessageWriter(definitions);
  const bytes = writer.writeMessage(message);
  const read = new MessageReader(definitions).readMessage(bytes);
  console.log(definition.replace('\n', '; '));
  console.log(`  written ${show(message)}, read ${show(read)}`);
  console.log(`  size ${bytes.length}, calculated ${writer.calculateByteSize(message)}`);
}

send('float64[] gains [1.5, 2.5]\nfloat64 limit 12', { gains: [1.5, 2.5] });
send('float64[] gains [1.5, 2.5]\nfloat64 limit 12', {});
send('float64[<=3] gains [1.5, 2.5]\nfloat64 limit 12', {});
send('float64[2] gains [1.5, 2.5]\nfloat64 limit 12', {});
send('string[] names ["ab"]\nint32 count 5', { names: ['ab'] });
send('string[] names ["ab"]\nint32 count 5', {});
JS

node try.mjs | tee seen

cat >expected <<'SEEN'
rosmsg2-serialization 3.1.0
rosmsg 5.0.5
cdr 3.5.0
float64[] gains [1.5, 2.5]; float64 limit 12
  written {"gains":[1.5,2.5]}, read {"gains":[1.5,2.5],"limit":12}
  size 36, calculated 36
float64[] gains [1.5, 2.5]; float64 limit 12
  written {}, read {"gains":[],"limit":1.5}
  size 36, calculated 20
float64[<=3] gains [1.5, 2.5]; float64 limit 12
  written {}, read {"gains":[],"limit":1.5}
  size 36, calculated 20
float64[2] gains [1.5, 2.5]; float64 limit 12
  written {}, read {"gains":[1.5,2.5],"limit":12}
  size 28, calculated 28
string[] names ["ab"]; int32 count 5
  written {"names":["ab"]}, read {"names":["ab"],"count":5}
  size 20, calculated 20
string[] names ["ab"]; int32 count 5
  written {}, read {"names":[],"count":3}
  size 20, calculated 12
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
