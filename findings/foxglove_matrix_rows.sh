#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    @foxglove/omgidl-serialization 1.0.3 with @foxglove/omgidl-parser 1.1.0 (npm), arrays
#            of two dimensions
# Behaviour  The reader returns double[2][3] as two rows of three numbers. The writer takes the rows
#            for numbers: it writes two NaN, and two zeros for long[2][2], so 16 and 8 bytes instead
#            of 48 and 16. There is no error. Only a flat list of all numbers is written right. An
#            array of a type that is itself an array does the same.
# Expected   What the reader returns can be written, as it is for arrays of one dimension. The list
#            of known limitations of the package does not name it.
# Matters    A program that reads a message, changes one value and writes it again destroys camera
#            matrices, covariances and inertias. All members behind them are shifted.
# Needs      npm, node
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

npm install --silent --no-audit --no-fund @foxglove/omgidl-serialization@1.0.3 \
  @foxglove/omgidl-parser@1.1.0 @foxglove/message-definition@0.5.0 @foxglove/cdr@3.5.0 \
  >npm.log 2>&1 || {
  cat npm.log >&2
  exit 1
}

cat >try.mjs <<'JS'
import fs from 'node:fs';
import { parseIDL } from '@foxglove/omgidl-parser';
import { MessageReader, MessageWriter } from '@foxglove/omgidl-serialization';

for (const name of ['omgidl-serialization', 'omgidl-parser', 'cdr']) {
  const about = JSON.parse(fs.readFileSync(`node_modules/@foxglove/${name}/package.json`));
  console.log(name, about.version);
}
const show = (message) => JSON.stringify(
    message, (key, value) => ArrayBuffer.isView(value) ? [...value] : value);

// The bytes behind the encapsulation header, of which the last one is the member "end".
function describe(bytes, type) {
  const view = new DataView(bytes.buffer, bytes.byteOffset + 4, bytes.byteLength - 4);
  const size = type === 'double' ? 8 : 4;
  const numbers = [];
  for (let at = 0; at + size < view.byteLength; at += size) {
    numbers.push(type === 'double' ? view.getFloat64(at, true) : view.getInt32(at, true));
  }
  return `${view.byteLength - 1} bytes: ${numbers.join(' ')}`;
}

function rewrite(type, idl, flat) {
  const definitions = parseIDL(idl);
  const writer = new MessageWriter('S', definitions);
  const right = writer.writeMessage({ m: flat, end: 9 });
  const read = new MessageReader('S', definitions).readMessage(right);
  console.log(idl);
  console.log(`  flat: ${describe(right, type)}`);
  console.log(`  read: ${show(read)}`);
  console.log(`  written again: ${describe(writer.writeMessage(read), type)}`);
}

rewrite('double', '@final struct S { double m[3]; octet end; };', [1, 2, 3]);
rewrite('double', '@final struct S { double m[2][3]; octet end; };', [1, 2, 3, 4, 5, 6]);
rewrite('long', '@final struct S { long m[2][2]; octet end; };', [1, 2, 3, 4]);
rewrite('double', 'typedef double Row[3]; @final struct S { Row m[2]; octet end; };',
        [1, 2, 3, 4, 5, 6]);
JS

node try.mjs | tee seen

cat >expected <<'SEEN'
omgidl-serialization 1.0.3
omgidl-parser 1.1.0
cdr 3.5.0
@final struct S { double m[3]; octet end; };
  flat: 24 bytes: 1 2 3
  read: {"m":[1,2,3],"end":9}
  written again: 24 bytes: 1 2 3
@final struct S { double m[2][3]; octet end; };
  flat: 48 bytes: 1 2 3 4 5 6
  read: {"m":[[1,2,3],[4,5,6]],"end":9}
  written again: 16 bytes: NaN NaN
@final struct S { long m[2][2]; octet end; };
  flat: 16 bytes: 1 2 3 4
  read: {"m":[[1,2],[3,4]],"end":9}
  written again: 8 bytes: 0 0
typedef double Row[3]; @final struct S { Row m[2]; octet end; };
  flat: 48 bytes: 1 2 3 4 5 6
  read: {"m":[[1,2,3],[4,5,6]],"end":9}
  written again: 16 bytes: NaN NaN
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
