// Model against measurement: every channel at its true conditions, time histories, the table of runs.

import { html, useState } from "../html.js";
import { HistoryCharts } from "../chart/history_chart.js";
import { varying } from "../chart/condition.js";
import { t } from "../language/language.js";
import { AxisPicker, ChannelCharts } from "../part/channel_charts.js";
import { NoModel } from "../part/no_model.js";
import { ParameterFold } from "../part/parameter_fold.js";
import { Pending } from "../part/message.js";
import { RunTable } from "../part/run_table.js";
import { isReport } from "../rest/answers.js";
import { path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { address, replace } from "../route.js";

/** @param {{ study: Study, model: Member, query: Record<string, string> }} properties */
export function Compare({ study, model, query }) {
  const { answer: comparison, error } = useAnswer(model ? path.comparison(model.id) : null);
  const { answer: histories } = useAnswer(model ? path.histories(model.id) : null);
  const [key, setKey] = useState(query.against ?? "slip");
  const choose = (/** @type {string} */ to) => {
    setKey(to);
    if (!isReport) replace(address(["studies", study.id, "compare"], { ...query, against: to }));
  };
  if (!model) return html`<${NoModel} study=${study} />`;
  if (!comparison) return html`<${Pending} answer=${comparison} error=${error} what="the comparison" />`;
  const axes = varying(comparison.rows);
  const axis = axes.find((a) => a.key === key) ?? axes[0];
  const layers = [{ name: t`model`, colour: null, rows: comparison.rows }];
  return html`
    <p class="note">
      Signs are measurements (hollow: held out, never fitted), lines the mean of the posterior at the measured
      conditions, bands its 90 % interval of a measurement; between conditions they bend smoothly, without being
      computed. Point at a run, or drag over a region: it lights up in every picture.
    </p>
    <${AxisPicker} axes=${axes} axis=${axis} choose=${choose} />
    <${ChannelCharts} layers=${layers} axis=${axis} name=${study.name} />
    <${ParameterFold}
      model=${model}
      line=${study.ledger.find((l) => l.calibration === model.id)}
      rows=${comparison.rows}
      axis=${axis}
      name=${study.name}
    />
    ${
      histories &&
      histories.length > 0 &&
      html`
        <h2>Time histories</h2>
        <${FoldedIfMany} isMany=${histories.length > UNFOLDED} title=${t`${histories.length} histories`}>
          <div class="figures">${histories.map((h) => html`<${HistoryCharts} history=${h} name=${study.name} />`)}</div>
        <//>
      `
    }
    <${Folded} title="Table of all runs"><${RunTable} rows=${comparison.rows} /><//>
  `;
}

/** Largest number of histories that are drawn without a click. */
const UNFOLDED = 6;

/** A part that is folded if it has many pictures. */
function FoldedIfMany(
  /** @type {{ isMany: boolean, title: string, children?: unknown }} */ { isMany, title, children },
) {
  return isMany ? html`<${Folded} title=${title}>${children}<//>` : children;
}

/** A part that is made when it is opened first: the table of a thousand runs has ten thousand cells. */
function Folded(/** @type {{ title: string, children?: unknown }} */ { title, children }) {
  const [isOpen, setOpen] = useState(false);
  return html`
    <details onToggle=${(/** @type {DetailsEvent} */ event) => event.currentTarget.open && setOpen(true)}>
      <summary>${title}</summary>
      ${isOpen && children}
    </details>
  `;
}
