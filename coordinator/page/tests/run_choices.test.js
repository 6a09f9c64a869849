import assert from "node:assert/strict";
import { test } from "node:test";

import { read, write } from "../modules/run_choices.js";

const TEXT = `# measured in March
run,wheel,soil,slip,wheel_load_n,sled_speed_m_s
a,w,s,0.1,60,0.01
"b, c",w,s,0.2,60,0.01
d,w,s,0.3,60,0.01
`;

/** The text with one run changed. */
const changed = (text, name, to) => {
  const file = read(text);
  return write({ ...file, runs: file.runs.map((run) => (run.run === name ? { ...run, ...to } : run)) });
};

test("a file without choices is written as it was read", () => assert.equal(write(read(TEXT)), TEXT));

test("a run is held out with a reason, which is read back", () => {
  const text = changed(TEXT, "d", { use: "holdout", reason: "second day;\nwet" });
  assert.equal(
    text,
    `# measured in March
run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,use
a,w,s,0.1,60,0.01,fit
"b, c",w,s,0.2,60,0.01,fit
# held out: second day; wet; run: d
d,w,s,0.3,60,0.01,holdout
`,
  );
  assert.deepEqual(
    read(text).runs.map(({ run, use, reason }) => [run, use, reason]),
    [
      ["a", "fit", ""],
      ["b, c", "fit", ""],
      ["d", "holdout", "second day; wet"],
    ],
  );
  assert.equal(write(read(text)), text);
});

test("an excluded run becomes a comment with its reason, and comes back as it was", () => {
  const text = changed(TEXT, "b, c", { use: "excluded", reason: "the load cell slipped" });
  assert.match(text, /^# excluded: the load cell slipped; run: "b, c",w,s,0\.2,60,0\.01$/m);
  assert.deepEqual(
    read(text).runs.map(({ run, use }) => [run, use]),
    [
      ["a", "fit"],
      ["b, c", "excluded"],
      ["d", "fit"],
    ],
  );
  assert.equal(changed(text, "b, c", { use: "fit", reason: "" }), TEXT);
});
