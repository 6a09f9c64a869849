// The stages of a sampler as curves: exponent, effective samples, acceptance, evidence.

import { Figure, fileName } from "../chart/figure.js";
import { Plot, STYLE } from "../chart/library.js";
import { html } from "../html.js";
import { t } from "../language/language.js";
import { digits } from "../words/quantity.js";

const CURVES = /** @type {const} */ ([
  { key: "tempering_exponent", title: t`tempering exponent`, note: t`1: the whole likelihood`, type: "log" },
  { key: "ess", title: t`effective samples`, note: t`after the weighting of a stage`, type: "linear" },
  { key: "acceptance", title: t`acceptance rate`, note: t`of the moves of a stage`, type: "linear" },
  { key: "evidence", title: t`ln evidence so far`, note: t`summed over the stages`, type: "linear" },
]);

/** @param {{ stages: Stage[], name: string }} properties */
export function StageCharts({ stages, name }) {
  let evidence = 0;
  const rows = stages.map((stage) => ({ ...stage, evidence: (evidence += stage.log_evidence_increment) }));
  const powers = rows.map((row) => Math.floor(Math.log10(row.tempering_exponent))).filter(Number.isFinite);
  const tens = [...new Set(powers)].map((power) => 10 ** power);
  const step = Math.ceil(rows.length / 6);
  const ticks = rows.map((row) => row.stage).filter((stage) => stage % step === 0);
  return html`
    <div class="figures small">
      ${CURVES.map(
        ({ key, title, note, type }) => html`
          <${Figure}
            key=${key}
            title=${t`${title} by stage`}
            note=${note}
            name=${fileName(name, key)}
            deps=${[stages]}
            rows=${() => rows.map((row) => ({ stage: row.stage, [key]: row[key] }))}
            draw=${(/** @type {number} */ width) =>
              Plot.plot({
                width,
                height: 190,
                marginLeft: 56,
                marginBottom: 40,
                style: STYLE,
                x: { label: t`stage`, labelArrow: "none", labelAnchor: "center", ticks, tickFormat: "d" },
                y: {
                  label: null,
                  type,
                  grid: type === "linear",
                  ticks: type === "log" && tens.length > 1 ? tens : 4,
                  zero: key === "acceptance",
                  ...(type === "log" ? { tickFormat: (/** @type {number} */ v) => digits(v, 1) } : {}),
                },
                marks: [
                  Plot.line(rows, { x: "stage", y: key, stroke: "var(--series-0)" }),
                  Plot.dot(rows, { x: "stage", y: key, r: 2.5, fill: "var(--series-0)" }),
                ],
              })}
          />
        `,
      )}
    </div>
  `;
}
