// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0
// node read_mcap.mjs FILE NODE_MODULES: reads an MCAP file front to back and by its index, checks
// every CRC, decodes every message of a ros2msg schema, and prints one line of JSON for each, then
// one with the totals. Fails at the first thing that is wrong.
import fs from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";

const [file, modules] = process.argv.slice(2);
const require = createRequire(path.join(modules, "none.js"));
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader } = require("@foxglove/rosmsg2-serialization");
const lz4 = require("@foxglove/wasm-lz4");
const zstd = require("@foxglove/wasm-zstd");
await Promise.all([lz4.default?.isLoaded ?? lz4.isLoaded, zstd.default?.isLoaded ?? zstd.isLoaded]);
const decompressHandlers = {
  lz4: (data, size) => (lz4.default ?? lz4)(data, Number(size)),
  zstd: (data, size) => (zstd.default ?? zstd).decompress(data, Number(size)),
};

const bytes = fs.readFileSync(file);
const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(bytes);
let streamed = 0;
for (let record; (record = stream.nextRecord()); ) streamed += record.type === "Message" ? 1 : 0;
if (!stream.done()) throw new Error("the file does not end with a footer and its magic");

const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, size) =>
    new Uint8Array(bytes.subarray(Number(offset), Number(offset) + Number(size))),
};
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const decoders = new Map();
for (const channel of reader.channelsById.values()) {
  const schema = reader.schemasById.get(channel.schemaId);
  if (schema.encoding !== "ros2msg") continue;
  const definition = parse(new TextDecoder().decode(schema.data), { ros2: true });
  decoders.set(channel.id, new MessageReader(definition));
}

// What JSON does not have: large integers, typed arrays, NaN.
const plain = (key, value) => {
  if (typeof value === "bigint") return value.toString();
  if (ArrayBuffer.isView(value)) return Array.from(value, (item) => plain("", item));
  return typeof value === "number" && !Number.isFinite(value) ? String(value) : value;
};
let indexed = 0;
for await (const message of reader.readMessages({ validateCrcs: true })) {
  ++indexed;
  const { topic } = reader.channelsById.get(message.channelId);
  const decoded = decoders.get(message.channelId)?.readMessage(message.data) ?? null;
  console.log(JSON.stringify({ topic, log_time_ns: message.logTime, message: decoded }, plain));
}
const attachments = [];
for await (const attachment of reader.readAttachments({ validateCrcs: true })) {
  attachments.push(attachment.name);
}
if (Number(reader.statistics.messageCount) !== indexed || indexed !== streamed) {
  throw new Error(`${streamed} messages front to back, ${indexed} by the index`);
}
console.log(JSON.stringify({ messages: indexed, attachments }));
