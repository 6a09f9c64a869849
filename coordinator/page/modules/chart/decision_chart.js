// The expected loss of each option with its uncertainty: 90 % of the losses of one run, and the standard error of the
// mean.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { Entry, Figure, fileName } from "./figure.js";
import { Plot, STYLE } from "./library.js";
import { textWidth } from "./tick_labels.js";

/** Height of an option [px]. */
const STEP = 30;
/** The largest share of the width that names take. */
const NAMES = 0.42;
/** Between a name and the picture, and to the edge [px]. */
const MARGIN = 24;
/** Two standard errors to either side. */
const ERRORS = 2;

/** @typedef {Schemas["OptionLoss"]} Option */

/** @param {{ decision: import("../view/decide.js").Decision, name: string }} properties */
export function DecisionChart({ decision, name }) {
  const { options, best } = decision;
  const names = options.map((option) => option.name);
  const title = t`Expected loss of each option`;
  const fill = (/** @type {Option} */ option) => (option.name === best ? "var(--series-1)" : "var(--series-0)");
  const draw = (/** @type {number} */ width) => {
    const left = Math.min(MARGIN + Math.max(...names.map(textWidth)), NAMES * width);
    const maxLength = Math.floor((left - MARGIN) / textWidth("m"));
    const short = (/** @type {string} */ text) =>
      text.length <= maxLength ? text : `${text.slice(0, maxLength - 1)}…`;
    return Plot.plot({
      width,
      height: 56 + STEP * options.length,
      marginLeft: left,
      marginRight: 16,
      marginTop: 8,
      marginBottom: 40,
      style: STYLE,
      x: {
        label: t`loss`,
        labelArrow: "none",
        labelAnchor: "center",
        nice: true,
        grid: true,
        inset: 6,
        ...(width < 500 ? { ticks: 4 } : {}),
      },
      y: { type: "point", domain: names, label: null, tickFormat: short, tickSize: 0, padding: 0.6 },
      marks: [
        Plot.ruleY(options, {
          y: "name",
          x1: (/** @type {Option} */ o) => o.interval[0],
          x2: (/** @type {Option} */ o) => o.interval[1],
          stroke: fill,
          strokeWidth: 2.5,
          strokeOpacity: 0.55,
        }),
        Plot.ruleY(options, {
          y: "name",
          x1: (/** @type {Option} */ o) => o.expected_loss - ERRORS * o.expected_loss_se,
          x2: (/** @type {Option} */ o) => o.expected_loss + ERRORS * o.expected_loss_se,
          stroke: fill,
          strokeWidth: 7,
        }),
        Plot.dot(options, {
          y: "name",
          x: "expected_loss",
          r: 5,
          fill: (/** @type {Option} */ o) => (o.is_feasible ? fill(o) : "var(--paper)"),
          stroke: fill,
          strokeWidth: 2,
        }),
      ],
    });
  };
  const rows = () =>
    options.map((option) => ({
      option: option.name,
      "expected loss": option.expected_loss,
      "standard error": option.expected_loss_se,
      "5 %": option.interval[0],
      "95 %": option.interval[1],
      "keeps constraints": option.is_feasible,
    }));
  return html`
    <${Figure}
      title=${title}
      name=${fileName(name, "decision")}
      deps=${[decision]}
      draw=${draw}
      rows=${rows}
      legend=${html`
        <${Entry} glyph=${html`<circle cx="8" cy="8" r="5" fill="var(--series-0)" />`}>expected loss<//>
        ${
          best &&
          html`
            <${Entry} glyph=${html`<circle cx="8" cy="8" r="5" fill="var(--series-1)" />`}>${t`the best: ${best}`}<//>
          `
        }
        ${
          options.some((option) => !option.is_feasible) &&
          html`
            <${Entry}
              glyph=${html`<circle cx="8" cy="8" r="4" fill="none" stroke="var(--series-0)" stroke-width="2" />`}
            >
              breaks a constraint
            <//>
          `
        }
        <${Entry} glyph=${html`<path d="M0 8h16" stroke="var(--series-0)" stroke-width="2" opacity=".6" />`}>
          90 % of one run
        <//>
        <${Entry} glyph=${html`<path d="M0 8h16" stroke="var(--series-0)" stroke-width="6" />`}>
          two standard errors of the mean, by the number of draws
        <//>
      `}
    />
  `;
}
