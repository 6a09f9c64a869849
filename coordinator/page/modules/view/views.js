// The views of a study in their order. Each is asked for when it is first shown, so that whoever reads the story does
// not wait for the others.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { Later } from "../part/later.js";

/** @typedef {{ name: string, title: string, load: () => Promise<unknown> }} View */

/** @type {View[]} */
export const VIEWS = [
  { name: "story", title: t`Story`, load: () => import("./story.js").then((module) => module.Story) },
  { name: "compare", title: t`Compare`, load: () => import("./compare.js").then((module) => module.Compare) },
  { name: "failures", title: t`Where it fails`, load: () => import("./failures.js").then((module) => module.Failures) },
  {
    name: "effects",
    title: t`Missing effect`,
    load: () => import("./missing_effect.js").then((module) => module.MissingEffect),
  },
  { name: "posterior", title: t`Posterior`, load: () => import("./posterior.js").then((module) => module.Posterior) },
  { name: "predict", title: t`Predict`, load: () => import("./predict.js").then((module) => module.Predict) },
  { name: "decide", title: t`Decide`, load: () => import("./decide.js").then((module) => module.Decide) },
  { name: "errors", title: t`Error falls`, load: () => import("./errors.js").then((module) => module.Errors) },
  { name: "trust", title: t`How far to trust it`, load: () => import("./trust.js").then((module) => module.Trust) },
  { name: "live", title: t`Live`, load: () => import("./live.js").then((module) => module.Live) },
];

/** @param {{ view: View, [property: string]: unknown }} properties the other properties are those of the view */
export function ShownView({ view, ...properties }) {
  return html`<${Later} key=${view.name} title=${view.title} load=${view.load} ...${properties} />`;
}
