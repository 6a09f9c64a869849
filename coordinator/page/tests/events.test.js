import assert from "node:assert/strict";
import { test } from "node:test";

import { split } from "../modules/rest/events.js";
import { parameterName } from "../modules/words/quantity.js";

test("a stream is split into whole events, and the rest waits", () => {
  const { events, rest } = split('event: stage\ndata: {"stage":1}\n\n:\n\nevent: status\r\ndata: {"state":"running"}\r\n\r\nevent: sta');
  assert.deepEqual(events, [{ event: "stage", data: { stage: 1 } }, { event: "status", data: { state: "running" } }]);
  assert.equal(rest, "event: sta");
});

test("names of parameters are without their units", () => {
  assert.deepEqual(["friction_angle_deg", "wheel_radius_m.smooth", "n", "janosi_hanamoto.shear_modulus_m", "noise.drawbar_pull_n"].map(parameterName),
    ["friction angle", "wheel radius.smooth", "n", "janosi hanamoto.shear modulus", "noise.drawbar pull"]);
});
