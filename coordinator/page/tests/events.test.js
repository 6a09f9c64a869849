import assert from "node:assert/strict";
import { test } from "node:test";

import { split } from "../modules/rest/events.js";

test("a stream is split into whole events, and the rest waits", () => {
  const { events, rest } = split(
    'event: stage\ndata: {"stage":1}\n\n:\n\nevent: status\r\ndata: {"state":"running"}\r\n\r\nevent: sta',
  );
  assert.deepEqual(events, [
    { event: "stage", data: { stage: 1 } },
    { event: "status", data: { state: "running" } },
  ]);
  assert.equal(rest, "event: sta");
});
