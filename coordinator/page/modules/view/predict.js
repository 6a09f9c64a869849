// Predictions of conditions that were not measured: sliders, the curve that follows them, and the probability of a
// statement.

import { PredictionChart } from "../chart/prediction_chart.js";
import { html, useEffect, useMemo, useState } from "../html.js";
import { t } from "../language/language.js";
import { Failure, Pending } from "../part/message.js";
import { NoModel } from "../part/no_model.js";
import { Table } from "../part/table.js";
import * as table from "../prediction_table.js";
import { errorOf, isReport } from "../rest/answers.js";
import { path, predict } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { loadWords, slipWords, speedWords } from "../words/condition.js";
import { rimSpeed } from "../words/group.js";
import {
  channelOf,
  intervalName,
  measuredQuantities,
  quantityName,
  shownQuantities,
  statementOf,
} from "../words/predicted_quantity.js";
import { capital, digits, minus, numberOf, probability, shown, titled } from "../words/quantity.js";
import { reasonWords } from "../words/refusal.js";

/**
 * @typedef {import("../words/predicted_quantity.js").Quantity} Quantity
 * @typedef {{ sign: string, limit: string }} TypedStatement
 * @typedef {Record<(typeof CONDITIONS)[number], (value: number) => string>} ConditionWords
 */

/** So long the sliders stand still before their place is computed [ms]. */
const REST_MS = 350;
/** Runs whose load and speed differ by less are near a condition. */
const NEAR = 0.06;
const CONDITIONS = /** @type {const} */ (["slip", "load", "speed"]);

/** @param {{ study: Study, model: Member }} properties */
export function Predict({ study, model }) {
  const { answer: comparison, error } = useAnswer(model ? path.comparison(model.id) : null);
  const { answer: grid, error: failure } = useAnswer(model ? path.predictionGrid(model.id) : null);
  if (!model) return html`<${NoModel} study=${study} />`;
  if (!comparison) return html`<${Pending} answer=${comparison} error=${error} what="the measured runs" />`;
  const fitted = comparison.rows.filter((row) => row.use === "fit");
  if (fitted.length === 0)
    return html`<p class="empty">No wheel run is fitted, so that nothing tells what a wheel would do.</p>`;
  if (isReport && failure) return html`<p class="empty">This report has no predictions of this model.</p>`;
  if (!grid) return html`<${Pending} answer=${grid} error=${failure} what="the predictions" />`;
  return html`
    <${Calculator}
      key=${model.id}
      study=${study}
      model=${model}
      rows=${comparison.rows}
      fitted=${fitted}
      grid=${grid}
    />
  `;
}

/** @param {{ study: Study, model: Member, rows: MeasuredRow[], fitted: MeasuredRow[], grid: table.Grid }} properties */
function Calculator({ study, model, rows, fitted, grid }) {
  const [ranges, reach, isRim] = [table.rangesOf(grid.fitted), table.rangesOf(grid.reach), grid.holds_rim];
  const wheels = [...new Set(fitted.map((row) => row.wheel))];
  const [place, setPlace] = useState(
    /** @type {table.Place} */ ({ ...table.middle(fitted, ranges, isRim), wheel: wheels[0] }),
  );
  const [chosen, setChosen] = useState("drawbar_pull_n");
  const [statement, setStatement] = useState(/** @type {TypedStatement} */ ({ sign: ">", limit: "" }));
  // A model that rolls over terrain, or is not ours, has no grid.
  const isRolling = grid.wheels.length === 0;
  const [isAsked, setAsked] = useState(!isRolling && !isReport);
  const between = useMemo(() => table.tableOf(grid, place.wheel), [grid, place.wheel]);
  const limit = numberOf(statement.limit);
  // What the last answer at rest has; a model that rolls has no grid, so that only this tells which statements can be
  // asked.
  const [predicted, setPredicted] = useState(/** @type {Quantity[]} */ ([]));
  const quantities = measuredQuantities(predicted.length > 0 ? predicted : shownQuantities(grid), rows);
  const found = quantities.find((q) => q.name === chosen) ?? quantities[0];
  const rest = useAtRest(
    isAsked ? model.id : null,
    place,
    grid.slips,
    isRim,
    statementOf(found, statement.sign, limit),
    isRolling,
    setPredicted,
  );
  const source = rest.table ?? between;
  const points = useMemo(
    () => (source && found ? table.curve(source, found.name, place) : []),
    [source, found?.name, place],
  );
  const spread = table.atSlip(points, place.slip);
  const here = spread && { ...spread, slip: place.slip };
  const outside = table.beyond(place, ranges);
  const fittedRange = (/** @type {(typeof outside)[number]} */ key) =>
    `${labels[key]} (${words[key](ranges[key][0])}${t` to `}${words[key](ranges[key][1])})`;
  const near = useMemo(
    () => (found && channelOf(found.name) ? nearRuns(rows, place, isRim, channelOf(found.name)) : []),
    [rows, place, found?.name],
  );
  const set = (/** @type {Partial<table.Place>} */ change) => setPlace({ ...place, ...change });
  const labels = { slip: t`slip`, load: t`wheel load`, speed: isRim ? t`speed of the rim` : t`sled speed` };
  const words = { slip: slipWords, load: loadWords, speed: speedWords };
  return html`
    <p class="note">
      What the calibrated models predict for a condition that nobody measured: mean and 90 % of new measurements (by the
      parameters alone where the noise is not known), over all models of the study by their evidence. Straight travel on
      level ground.
    </p>
    <div class="setting">
      <div class="controls">
        ${
          wheels.length > 1 &&
          html`
            <p>
              <label>
                Wheel <select onChange=${(/** @type {SelectEvent} */ e) => set({ wheel: e.currentTarget.value })}>
                  ${wheels.map(
                    (wheel) => html`<option value=${wheel} selected=${wheel === place.wheel}>${wheel}</option>`,
                  )}
                </select>
              </label>
            </p>
          `
        }
        ${CONDITIONS.map(
          (key) =>
            reach[key][1] > reach[key][0] &&
            html`
              <${Slider}
                key=${key}
                id=${`predict-${key}`}
                label=${labels[key]}
                text=${words[key](place[key])}
                value=${place[key]}
                range=${reach[key]}
                isBeyond=${outside.includes(key)}
                move=${(/** @type {number} */ value) => set({ [key]: value })}
              />
            `,
        )}
        <p class=${`reach ${outside.length > 0 ? "beyond" : ""}`} role="status">
          ${
            outside.length === 0
              ? t`Within the fitted range.`
              : t`Beyond the fitted range in ${outside.map(fittedRange).join(", ")}: nothing tells whether the model
                still holds there.`
          }
        </p>
        ${
          quantities.length > 0 &&
          html`
            <p>
              <label>
                Quantity <select
                  onChange=${(/** @type {SelectEvent} */ e) => {
                    setChosen(e.currentTarget.value);
                    setStatement({ ...statement, limit: "" });
                  }}
                >
                  ${quantities.map(
                    ({ name }) =>
                      html`<option value=${name} selected=${name === found?.name}>${quantityName(name)}</option>`,
                  )}
                </select>
              </label>
            </p>
          `
        }
        ${
          found &&
          !isReport &&
          html`
            <${Statement}
              found=${found}
              statement=${statement}
              change=${setStatement}
              answer=${rest.statement}
              isBusy=${rest.isBusy}
              isNumber=${limit !== null}
            />
          `
        }
      </div>
      <div>
        ${
          isRolling &&
          isReport &&
          html`<p class="empty">A prediction of this model takes minutes: the page of the service makes it.</p>`
        }
        ${
          isRolling &&
          !isReport &&
          !isAsked &&
          html`
            <p>
              This model takes minutes for a
              prediction. <button type="button" onClick=${() => setAsked(true)}>Predict here</button>
            </p>
          `
        }
        <${Failure} error=${rest.error} />
        ${
          found &&
          points.length > 1 &&
          html`
            <${PredictionChart}
              quantity=${found}
              points=${points}
              here=${here}
              fitted=${ranges.slip}
              measured=${near}
              name=${study.name}
            />
          `
        }
        ${rest.table && html`<${Refused} source=${rest.table} place=${place} words=${words} />`}
        ${
          isReport &&
          between &&
          points.length < 2 &&
          html`<p class="empty" role="status">The model refuses this load or speed, or one beside it.</p>`
        }
        ${
          points.length < 2 &&
          !rest.table &&
          isAsked &&
          !rest.error &&
          html`<p class="empty" aria-busy="true">The program computes the curves …</p>`
        }
        ${
          source &&
          found &&
          points.length > 1 &&
          html`
            <${Values} source=${source} quantities=${quantities} place=${place} />
            <p class="note" role="status">
              ${
                rest.table
                  ? t`Computed at this condition with ${rest.draws} draws.`
                  : isReport
                    ? t`Interpolated between conditions that were computed with ${grid.draws} draws.`
                    : t`Interpolated between computed conditions; it is computed when the sliders rest.`
              }
            </p>
          `
        }
      </div>
    </div>
  `;
}

/** What the model refuses, and why: in the place of the curve where no slip is left. */
function Refused(
  /** @type {{ source: table.Table, place: table.Place, words: ConditionWords }} */ { source, place, words },
) {
  const found = table.refused(source);
  if (!found) return null;
  const slips = found.spans
    .map(([from, to]) => (from === to ? slipWords(from) : `${slipWords(from)}${t` to `}${slipWords(to)}`))
    .join(", ");
  const { draws, of, reason } = found.refusal;
  const here = `${words.load(place.load)}, ${words.speed(place.speed)}`;
  const why = t`${reasonWords(reason)} (at ${draws} of ${of} draws)`;
  return found.isWhole
    ? html`
        <p class="empty" role="status">
          ${t`The model refuses every slip from ${slips} at ${here}: ${why}. Move the sliders, or choose another
            model.`}
        </p>
      `
    : html`<p class="note" role="status">${t`The model refuses slip ${slips} at ${here}: ${why}.`}</p>`;
}

/** The curve at a place where the sliders rest, and the probability of a statement there. */
function useAtRest(
  /** @type {number | null} */ id,
  /** @type {table.Place} */ place,
  /** @type {number[]} */ slips,
  /** @type {boolean} */ isRim,
  /** @type {string | null} */ statement,
  /** @type {boolean} */ isRolling,
  /** @type {(quantities: { name: string, unit: string }[]) => void} */ onQuantities,
) {
  const nothing = {
    key: "",
    curve: "",
    table: /** @type {table.Table | null} */ (null),
    statement: /** @type {Schemas["StatementProbability"] | null} */ (null),
    draws: 0,
    error: /** @type {Error | null} */ (null),
  };
  const [state, setState] = useState(nothing);
  const curve = [id, place.wheel, place.load, place.speed].join(" ");
  const key = [curve, place.slip, statement].join(" ");
  useEffect(() => {
    if (id === null) return undefined;
    let isOver = false;
    const timer = setTimeout(() => {
      const { plan, fill, here } = table.curvePlan(place, slips, isRim);
      predict(id, {
        plan,
        statements: statement === null ? [] : [statement],
        ...(isRolling ? { draws: 20 } : {}),
      }).then(
        ({ runs, draws }) => {
          if (isOver) return;
          setState({ key, curve, table: fill(runs), statement: runs[here].statements[0] ?? null, draws, error: null });
          onQuantities(quantitiesOf(runs));
        },
        (error) => isOver || setState({ ...nothing, key, curve, error: errorOf(error) }),
      );
    }, REST_MS);
    return () => {
      isOver = true;
      clearTimeout(timer);
    };
  }, [key]);
  if (state.key === key) return { ...state, isBusy: false };
  // The curve of a load and a speed holds at every slip; a statement does not.
  return state.curve === curve ? { ...state, statement: null, isBusy: true } : { ...nothing, isBusy: true };
}

const quantitiesOf = (/** @type {Schemas["PredictedRun"][]} */ runs) =>
  shownQuantities(runs.find((run) => run.quantities.length > 0) ?? { quantities: [] });

/** Runs that were measured near a condition. */
function nearRuns(
  /** @type {MeasuredRow[]} */ rows,
  /** @type {table.Place} */ { wheel, load, speed },
  /** @type {boolean} */ isRim,
  /** @type {string | null} */ channel,
) {
  const isNear = (/** @type {number} */ a, /** @type {number} */ b) => Math.abs(a - b) <= NEAR * b;
  return rows.filter(
    (row) =>
      row.channel === channel &&
      row.wheel === wheel &&
      isNear(row.wheel_load_n, load) &&
      isNear(isRim ? rimSpeed(row) : row.sled_speed_m_s, speed),
  );
}

/**
 * @param {{ id: string, label: string, text: string, value: number, range: [number, number], isBeyond: boolean, move:
 *   (value: number) => void }} properties
 */
function Slider({ id, label, text, value, range, isBeyond, move }) {
  return html`
    <div class="slider">
      <label for=${id}>${label}</label>
      <span class=${isBeyond ? "value beyond" : "value"} aria-hidden="true">${text}</span>
      <input
        id=${id}
        type="range"
        step="any"
        min=${range[0]}
        max=${range[1]}
        value=${value}
        aria-valuetext=${text}
        onInput=${(/** @type {FieldEvent} */ event) => move(Number(Number(event.currentTarget.value).toPrecision(3)))}
      />
    </div>
  `;
}

/**
 * `P(drawbar pull > 12 N)`: typed in the unit that is shown.
 * @param {{ found: Quantity, statement: TypedStatement, change: (to: TypedStatement) => void, answer:
 *   Schemas["StatementProbability"] | null, isBusy: boolean, isNumber: boolean }} properties
 */
function Statement({ found, statement, change, answer, isBusy, isNumber }) {
  const { unit } = shown(found.unit);
  const isOpen = statement.limit.trim() === "";
  return html`
    <p class="actions" role="group" aria-label="A statement about a new measurement">
      <span class="whole">How probable is ${quantityName(found.name)}</span>
      <select
        aria-label="above or below"
        onChange=${(/** @type {SelectEvent} */ e) => change({ ...statement, sign: e.currentTarget.value })}
      >
        ${[">", "<"].map((sign) => html`<option value=${sign} selected=${sign === statement.sign}>${sign}</option>`)}
      </select>
      <span class="whole">
        <input
          size="5"
          inputmode="decimal"
          aria-label=${titled(t`limit`, unit)}
          aria-invalid=${!isOpen && !isNumber}
          value=${statement.limit}
          onInput=${(/** @type {FieldEvent} */ e) => change({ ...statement, limit: e.currentTarget.value })}
        />${" "}
        ${unit === "1" ? "" : unit}?
      </span>
    </p>
    ${
      !isOpen &&
      isNumber &&
      html`
        <p role="status" class="answer">
          ${
            answer
              ? html`
                  <b>P ${probability(answer.measurement ?? answer.models ?? 0)}</b>${" "}
                  <span class="note">
                    ${
                      answer.measurement === null
                        ? t`by the parameters alone: the noise is not known`
                        : t`that a new measurement says so`
                    }
                  </span>
                `
              : isBusy
                ? html`<span class="note">is being computed …</span>`
                : ""
          }
        </p>
      `
    }
  `;
}

/**
 * Every quantity at the chosen condition.
 * @param {{ source: table.Table, quantities: Quantity[], place: table.Place }} properties
 */
function Values({ source, quantities, place }) {
  const all = quantities.map(({ name, unit }) => ({
    name,
    unit,
    spread: table.atSlip(table.curve(source, name, place), place.slip),
  }));
  const kinds = [...new Set(all.flatMap(({ spread }) => (spread ? [spread.isMeasurement] : [])))];
  const rows = all.map(({ name, unit, spread }) => {
    const { unit: word, scale } = shown(unit);
    const value = (/** @type {number | undefined} */ v) => (v === undefined ? "–" : minus(digits(v * scale)));
    const kind = kinds.length > 1 && spread && !spread.isMeasurement ? ` (${t`parameters alone`})` : "";
    return [
      capital(titled(quantityName(name), word)),
      value(spread?.mean),
      spread ? `${value(spread.low)}${t` to `}${value(spread.high)}${kind}` : "–",
    ];
  });
  return html`
    <${Table}
      label="Predictions at the chosen condition"
      head=${[
        t`at slip ${slipWords(place.slip)}`,
        t`mean`,
        kinds.length > 1 ? t`90 % of new measurements, or by the parameters alone` : intervalName(kinds[0] ?? true),
      ]}
      rows=${rows}
      numbers=${[1, 2]}
    />
  `;
}
