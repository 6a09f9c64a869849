// What each parameter does: sliders that move the curves of the model at once, by the response surface of the
// calibration.

import { SurfaceCurves } from "../chart/surface_curves.js";
import { html, useEffect, useMemo, useState } from "../html.js";
import { t } from "../language/language.js";
import { changed, coordinate, meanSetting, predict, rmse, valueAt } from "../response_surface.js";
import { path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { parameterValue, shownParameter } from "../words/parameter.js";
import { channelName, digits, shown, size } from "../words/quantity.js";
import { ChannelCharts } from "./channel_charts.js";
import { Pending } from "./message.js";
import { Table } from "./table.js";

/** @typedef {import("../response_surface.js").ResponseSurface} ResponseSurface */

/**
 * @param {{ model: Member, rows: MeasuredRow[], axis: ConditionAxis, name: string }} properties rows: of the
 *   comparison. axis: the condition that the pictures are drawn against.
 */
export function ParameterSliders({ model, rows, axis, name }) {
  const { answer, error } = useAnswer(path.responseSurface(model.id));
  if (!answer) return html`<${Pending} answer=${answer} error=${error} what="the response surface" />`;
  return html`<${Sliders} surface=${answer} rows=${rows} axis=${axis} name=${name} />`;
}

/**
 * @param {{ surface: ResponseSurface, rows: MeasuredRow[], axis: ConditionAxis, name: string }} properties
 */
function Sliders({ surface, rows, axis, name }) {
  const [setting, setSetting] = useState(meanSetting(surface));
  const [follows, setFollows] = useState(false);
  const curves = useMemo(() => new SurfaceCurves(surface), [surface]);
  const layers = useMemo(() => [{ name: t`posterior mean`, colour: null, rows }], [rows]);
  const prediction = predict(surface, setting);
  useEffect(() => {
    const frame = requestAnimationFrame(() => curves.move(prediction));
    return () => cancelAnimationFrame(frame);
  }, [curves, setting]);
  const move = (/** @type {number} */ k, /** @type {number} */ value) =>
    setSetting(changed(surface, setting, k, value, follows));
  return html`
    <p class="note">
      Strong lines: the model at the setting of the sliders. Faint lines and bands: the mean of the posterior and its 90
      % interval of a measurement. A slider spans the central 99 % of the draws of its parameter. The lines come from
      a ${surface.degree} polynomial for each run and channel, fitted to ${surface.draws} draws of the posterior with
      their outputs.
    </p>
    <div class="setting">
      <div class="controls">
        ${surface.parameters.map(
          (parameter, k) =>
            html`
              <${Slider}
                key=${parameter.name}
                id=${`slider-${surface.calibration}-${k}`}
                parameter=${parameter}
                value=${setting[k]}
                move=${(/** @type {number} */ value) => move(k, value)}
              />
            `,
        )}
        <p class="actions">
          <button type="button" onClick=${() => setSetting(meanSetting(surface))}>Reset to the posterior mean</button>
          <label>
            <input
              type="checkbox"
              checked=${follows}
              onChange=${(/** @type {FieldEvent} */ event) => setFollows(event.currentTarget.checked)}
            /> the
            others follow, as they do among the draws
          </label>
        </p>
        <p class=${`reach ${prediction.isBeyond ? "beyond" : ""}`} role="status">${reachWords(surface, prediction)}</p>
        <${Errors} surface=${surface} rows=${rows} outputs=${prediction.outputs} />
      </div>
      <${ChannelCharts} layers=${layers} axis=${axis} name=${`${name}-sliders`} moving=${curves} small />
    </div>
  `;
}

/**
 * @param {{ id: string, parameter: ResponseSurface["parameters"][number], value: number,
 *   move: (value: number) => void }} properties
 */
function Slider({ id, parameter, value, move }) {
  const text = parameterValue(parameter, value, 4);
  return html`
    <div class="slider">
      <label for=${id}>${shownParameter(parameter).name}</label>
      <span class="value" aria-hidden="true">${text}</span>
      <input
        id=${id}
        type="range"
        step="any"
        min=${coordinate(parameter, parameter.lower)}
        max=${coordinate(parameter, parameter.upper)}
        value=${coordinate(parameter, value)}
        aria-valuetext=${text}
        onInput=${(/** @type {FieldEvent} */ event) => move(valueAt(parameter, Number(event.currentTarget.value)))}
      />
    </div>
  `;
}

/** Where the setting lies among the draws. */
function reachWords(
  /** @type {ResponseSurface} */ surface,
  /** @type {import("../response_surface.js").Prediction} */ { distance, isBeyond },
) {
  const place = t`Mahalanobis distance ${digits(distance, 2)} from the posterior mean; 99 % of the draws lie within
    ${digits(surface.radius, 2)}.`;
  return isBeyond ? t`Beyond the draws: the dashed curves extrapolate. ${place}` : t`Among the draws. ${place}`;
}

/**
 * What the setting is worth against the measurements, and what the surface is worth against the model.
 * @param {{ surface: ResponseSurface, rows: MeasuredRow[], outputs: Map<string, number> }} properties
 */
function Errors({ surface, rows, outputs }) {
  const atMean = useMemo(() => predict(surface, meanSetting(surface)).outputs, [surface]);
  const uses = ["fit", "holdout"].filter((use) => rows.some((row) => row.use === use));
  const table = surface.channels.map(({ channel, unit, rmse: error, rmse_sigma: sigma }) => {
    const { unit: name, scale } = shown(unit);
    const difference = (/** @type {string} */ use) => {
      const own = rows.filter((row) => row.channel === channel && row.use === use);
      const [here, mean] = [outputs, atMean].map((all) => rmse(own, all));
      return here === null || mean === null
        ? "–"
        : html`<span><b>${digits(here * scale)}</b><br />(${digits(mean * scale)})</span>`;
    };
    const inSds = sigma === null || sigma === undefined ? "" : html`<br />${digits(sigma, 2)} noise sds`;
    return [
      html`${channelName(channel)} <span class="whole">[${name}]</span>`,
      ...uses.map(difference),
      html`<span>${size(error, unit, 2)}${inSds}</span>`,
    ];
  });
  const titles = { fit: t`RMSE, fitted runs`, holdout: t`held-out runs` };
  return html`
    <${Table}
      label="Errors at the setting of the sliders"
      rows=${table}
      numbers=${[...uses.map((_, k) => k + 1), uses.length + 1]}
      head=${[t`channel`, ...uses.map((use) => titles[/** @type {"fit" | "holdout"} */ (use)]), t`error of the curves`]}
    />
    <p class="note">
      In brackets: at the posterior mean. Error of the curves: from the model, at draws that are left out of the fit.
    </p>
  `;
}
