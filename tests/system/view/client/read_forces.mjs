// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0
// usage: node read_forces.mjs PORT
// Subscribes to /forces by Foxglove's own client, and prints what it was told as JSON.
import protocol from "@foxglove/ws-protocol";
import WebSocket from "ws";

const { FoxgloveClient } = protocol;
const port = process.argv[2];
const client = new FoxgloveClient({
  ws: new WebSocket(`ws://127.0.0.1:${port}`, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]),
});
const told = { hasScene: false };

function fail(reason) {
  console.error(reason);
  process.exit(1);
}

// A CDR string: its length with the zero, then its bytes.
function statusOf(data) {
  const text = Buffer.from(data.buffer, data.byteOffset, data.byteLength).toString("latin1");
  return /told by the test/.exec(text)?.[0];
}

setTimeout(() => fail("nothing came for 30 s"), 30000);
client.on("error", (error) => fail(error));
client.on("serverInfo", (info) => {
  told.serverInfo = info;
});
client.on("advertise", (channels) => {
  told.hasScene ||= channels.some((channel) => channel.topic === "/view/robot_scene");
  const forces = channels.find((channel) => channel.topic === "/forces");
  if (forces === undefined) return;
  told.channel = forces;
  told.subscription = client.subscribe(forces.id);
});
client.on("message", ({ subscriptionId, data }) => {
  if (subscriptionId !== told.subscription) fail("a message of another subscription");
  told.status = statusOf(data);
  console.log(JSON.stringify(told));
  process.exit(0);
});
