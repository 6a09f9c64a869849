// What the studies that tried a law say together.

import assert from "node:assert/strict";
import { test } from "node:test";

import { evidence } from "../modules/part/library.js";

const law = (studies) => ({
  studies,
  counted: studies.filter((study) => study.counts).length,
  log_bayes_factor: studies.filter((study) => study.counts).reduce((sum, study) => sum + study.nats, 0),
});

test("the study that found a law is no evidence for it", () => {
  const found = { standing: "held", counts: false, nats: 90 };
  assert.equal(evidence(law([found])), "No study counts as evidence yet.");
  const held = { standing: "held", counts: true, nats: 12.5 };
  assert.equal(evidence(law([found, held])), "Held in 1 of 1 study that counts (12.5 nats).");
  const absent = { standing: "not_seen", counts: true, nats: -1.5 };
  assert.equal(evidence(law([found, held, absent])), "Held in 1 of 2 studies that count (11.0 nats together).");
});
