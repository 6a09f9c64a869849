// The parameters of a model: their marginal and joint posteriors, with the priors under them.

import { Figure, fileName } from "../chart/figure.js";
import { Plot, STYLE } from "../chart/library.js";
import { csv, save } from "../chart/download.js";
import { JointPicture, PairPlot } from "../chart/pairs.js";
import { html, useState } from "../html.js";
import { t } from "../language/language.js";
import { Failure, Pending } from "../part/message.js";
import { KnownWrong } from "../part/known_wrong.js";
import { NoModel } from "../part/no_model.js";
import { ParameterTable } from "../part/parameter_table.js";
import { errorOf, isReport } from "../rest/answers.js";
import { get, path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { shownParameter } from "../words/parameter.js";
import { tickWords, titled } from "../words/quantity.js";

/** So many parameters fit into one pair plot. */
const MOST = 6;

/** @param {{ study: Study, model: Member }} properties */
export function Posterior({ study, model }) {
  const { answer, error } = useAnswer(model && path.figures(model.id));
  if (!model) return html`<${NoModel} study=${study} />`;
  const line = [...study.ledger, ...study.point_estimates].find((l) => l.calibration === model.id);
  if (!answer) return html`<${Pending} answer=${answer} error=${error} what="The posterior" />`;
  const marginals = answer.marginals.map((m) => ({ ...m, ...m.parameter }));
  return html`
    <${KnownWrong} model=${model} />
    <${Pictures} key=${model.id} marginals=${marginals} pairs=${answer.posteriors} model=${model} />
    <h2>Parameters</h2>
    <${ParameterTable} marginals=${marginals} line=${line} />
    ${!isReport && html`<${Draws} model=${model} />`}
  `;
}

function Pictures(
  /** @type {{ marginals: Marginal[], pairs: JointPosterior[], model: Member }} */ { marginals, pairs, model },
) {
  const names = marginals.map((m) => m.name);
  const [chosen, setChosen] = useState(/** @type {string[]} */ (names.slice(0, MOST)));
  const [cell, setCell] = useState(/** @type {JointPosterior | null} */ (null));
  if (marginals.length === 0)
    return html`<p class="empty">A fit has a point and no draws: there is no density to draw.</p>`;
  const flip = (/** @type {string} */ name) =>
    setChosen(chosen.includes(name) ? chosen.filter((c) => c !== name) : [...chosen, name].slice(-MOST));
  return html`
    <div class="figures small">${marginals.map((m) => html`<${Marginal} key=${m.name} marginal=${m} />`)}</div>
    <p class="legend">
      <span>filled: posterior</span>
      <span>dashed outline: prior</span>
      <span>line: mode</span>
      <span>dotted line: reference value, where one was measured</span>
    </p>
    <h2>Pairs of parameters</h2>
    ${
      names.length > MOST &&
      html`
        <div class="actions" role="group" aria-label="Parameters in the pair plot">
          ${marginals.map(
            ({ name, unit }) =>
              html`
                <button type="button" aria-pressed=${chosen.includes(name)} onClick=${() => flip(name)}>
                  ${shownParameter({ name, unit }).name}
                </button>
              `,
          )}
        </div>
      `
    }
    <${PairPlot}
      pairs=${pairs}
      marginals=${marginals.filter((m) => chosen.includes(m.name))}
      name=${model.name}
      onCell=${setCell}
    />
    ${
      cell &&
      html`
        <div class="card">
          <${JointPicture} pair=${cell} />
          <button type="button" onClick=${() => setCell(null)}>Close</button>
        </div>
      `
    }
  `;
}

function Marginal(/** @type {{ marginal: Marginal }} */ { marginal }) {
  const { name, unit, isLogarithm, of } = shownParameter(marginal);
  const isLog = marginal.logarithmic || isLogarithm;
  const rows = marginal.grid.map((x, k) => ({
    x: of(x),
    prior: marginal.prior[k],
    posterior: marginal.posterior[k],
  }));
  return html`
    <${Figure}
      title=${t`Posterior of ${name}`}
      name=${fileName("posterior", marginal.name)}
      deps=${[marginal]}
      rows=${() => rows}
      draw=${(/** @type {number} */ width) =>
        Plot.plot({
          width,
          height: 190,
          marginLeft: 14,
          marginRight: 14,
          marginBottom: 40,
          style: STYLE,
          x: {
            type: isLog ? "log" : "linear",
            label: titled(name, unit),
            labelArrow: "none",
            labelAnchor: "center",
            ticks: 5,
            ...(marginal.logarithmic ? {} : { tickFormat: tickWords }),
            grid: true,
          },
          y: { axis: null },
          marks: [
            Plot.areaY(rows, { x: "x", y1: 0, y2: "posterior", fill: "var(--series-0)", fillOpacity: 0.3 }),
            Plot.lineY(rows, { x: "x", y: "posterior", stroke: "var(--series-0)" }),
            Plot.lineY(rows, { x: "x", y: "prior", stroke: "var(--prior)", strokeDasharray: "5 3" }),
            ...(marginal.mode === null ? [] : [Plot.ruleX([of(marginal.mode)], { stroke: "var(--ink)" })]),
            ...(typeof marginal.reference !== "number"
              ? []
              : [
                  Plot.ruleX([of(marginal.reference)], {
                    stroke: "var(--reference)",
                    strokeDasharray: "2 3",
                    strokeWidth: 2,
                  }),
                ]),
            Plot.ruleY([0], { stroke: "var(--rule)" }),
          ],
        })}
    />
  `;
}

function Draws(/** @type {{ model: Member }} */ { model }) {
  const [failure, setFailure] = useState(/** @type {Error | null} */ (null));
  const download = async () => {
    try {
      const { columns, rows } = await get(path.posterior(model.id));
      save("posterior.csv", csv(rows.map((row) => Object.fromEntries(columns.map((c, k) => [c, row[k]])))));
    } catch (error) {
      setFailure(errorOf(error));
    }
  };
  return html`
    <div class="actions"><button type="button" onClick=${download}>Download the draws (posterior.csv)</button></div>
    <${Failure} error=${failure} />
  `;
}
