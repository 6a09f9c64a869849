// A person's table in their own columns and units: the guessed columns are shown, chosen by clicking, and become
// runs.csv.

import { errorOf } from "../rest/answers.js";
import { save } from "../chart/download.js";
import { html, useEffect, useMemo, useState } from "../html.js";
import { byField, mapOf, meaningsOf, proposed, withAgain, without } from "../import_map.js";
import { t, told } from "../language/language.js";
import { guessImport, importTable } from "../rest/routes.js";
import { FilledDown, Meanings, Mistake, SkippedRows } from "./import_fix.js";
import { Failure } from "./message.js";
import { Table } from "./table.js";

/** @typedef {import("../import_map.js").Choice} Choice */

/** Time without a further change after which a change is asked about [ms]. */
const PAUSE_MS = 250;
/** What the rows have where a column is absent. @type {Record<string, string>} */
const ABSENT = { run: t`(numbered)`, slip_angle_deg: t`(0: straight ahead)`, use: t`(all rows are fitted)` };
/** What is shown before a person asks for all columns of runs.csv. */
const USUAL = [
  "run",
  "wheel",
  "soil",
  "slip",
  "wheel_load_n",
  "sled_speed_m_s",
  "slip_angle_deg",
  "drawbar_pull_n",
  "torque_n_m",
  "sinkage_m",
  "lateral_force_n",
  "use",
];

/**
 * @param {{ name: string, bytes: Uint8Array, onFiles: (files: Record<string, string>) => void, onRemove: () => void }}
 *   properties onFiles: runs.csv and its histories
 */
export function ImportTable({ name, bytes, onFiles, onRemove }) {
  const content = useMemo(() => base64(bytes), [bytes]);
  const [guess, setGuess] = useState(/** @type {Guess | null} */ (null));
  const [choices, setChoices] = useState(/** @type {import("../import_map.js").Choices | null} */ (null));
  const [answer, setAnswer] = useState(/** @type {Converted | null} */ (null));
  const [failure, setFailure] = useState(/** @type {Error | null} */ (null));
  const [isAll, setAll] = useState(false);
  const look = async (/** @type {string | null} */ sheet) => {
    setFailure(null);
    try {
      const found = await guessImport({ name, content_base64: content, sheet });
      setGuess(found);
      setChoices(proposed(found));
    } catch (error) {
      setFailure(errorOf(error));
    }
  };
  useEffect(() => void look(null), [content]);
  const map = guess && choices ? mapOf(guess, choices) : null;
  useEffect(() => {
    if (map === null) return undefined;
    let isOver = false;
    setAnswer(null);
    const timer = setTimeout(async () => {
      try {
        const found = await importTable({ name, content_base64: content, map });
        if (!isOver) setAnswer(found);
      } catch (error) {
        if (!isOver) setFailure(errorOf(error));
      }
    }, PAUSE_MS);
    return () => {
      isOver = true;
      clearTimeout(timer);
    };
  }, [map, content]);
  const heading = html`
    <div class="actions">
      <h2>The columns of ${name}</h2>
      <button type="button" onClick=${onRemove} aria-label=${t`remove ${name}`}>Remove</button>
    </div>
  `;
  if (!guess || !choices)
    return html`
      <div class="card mapping">
        ${heading}
        <${Failure} error=${failure} />
        ${!failure && html`<p class="empty" aria-busy="true">The table is being read.</p>`}
      </div>
    `;
  const isShown = (/** @type {FieldGuess} */ field) =>
    isAll || USUAL.includes(field.name) || choices.fields[field.name].column !== null;
  const fields = guess.fields.filter(isShown);
  const isUsed = Object.values(choices.fields).some((choice) => choice.formula !== "" && choice.column === null);
  const quantities = isUsed ? guess.quantities : [];
  const said = byField(
    answer?.complaints ?? [],
    [...fields, ...quantities].map((field) => field.name),
  );
  const set = (
    /** @type {"fields" | "quantities"} */ kind,
    /** @type {string} */ name,
    /** @type {Partial<Choice>} */ change,
  ) => setChoices({ ...choices, [kind]: { ...choices[kind], [name]: { ...choices[kind][name], ...change } } });
  const skip = (/** @type {import("../import_map.js").Skipped} */ left) => setChoices(without(choices, left));
  const row = (/** @type {FieldGuess | QuantityGuess} */ field, /** @type {"fields" | "quantities"} */ kind) =>
    cells(
      field,
      choices[kind][field.name],
      guess.columns,
      said.of(field.name),
      (change) => set(kind, field.name, change),
      skip,
    );
  const titles = guess.columns.map((column) => column.title);
  const samples = (guess.columns[0]?.sample ?? []).map((_, k) => guess.columns.map((column) => column.sample[k] ?? ""));
  // The rows, where nothing is wrong with the table.
  const notes = answer?.notes;
  const runs = answer?.complaints.length === 0 ? answer.runs : null;
  return html`
    <div class="card mapping">
      ${heading}
      <p>Choose for each quantity the column of ${name} and its unit. Blank fields stay unmeasured.</p>
      <div class="actions">
        ${
          guess.sheets.length > 1 &&
          html`
            <label>
              Sheet <select
                value=${guess.sheet ?? ""}
                onChange=${(/** @type {SelectEvent} */ e) => look(e.currentTarget.value)}
              >
                ${guess.sheets.map(
                  (sheet) =>
                    html`
                      <option value=${sheet} selected=${sheet === (guess.sheet ?? "")}>
                        ${sheet || t`(outside of structs)`}
                      </option>
                    `,
                )}
              </select>
            </label>
          `
        }
        ${
          choices.decimal !== null &&
          html`
            <label>
              Decimal
              mark <select
                value=${choices.decimal}
                onChange=${(/** @type {SelectEvent} */ e) => setChoices({ ...choices, decimal: e.currentTarget.value })}
              >
                ${
                  choices.decimal === "?" &&
                  html`<option value="?" selected>choose: is 1,234 more than a thousand?</option>`
                }
                ${[
                  [",", t`comma: 1,5`],
                  [".", t`point: 1.5`],
                ].map(
                  ([mark, text]) => html`<option value=${mark} selected=${mark === choices.decimal}>${text}</option>`,
                )}
              </select>
            </label>
          `
        }
      </div>
      <${Table} label=${t`First rows of ${name}`} head=${titles} rows=${samples} />
      <${Table}
        label=${t`Columns of ${name}`}
        head=${[t`quantity`, t`column`, t`unit`, t`or the same in all rows`]}
        rows=${[...fields.map((field) => row(field, "fields")), ...quantities.map((field) => row(field, "quantities"))]}
      />
      ${
        !isAll && html`<p><button type="button" onClick=${() => setAll(true)}>Show all columns of runs.csv</button></p>`
      }
      ${said.others.map((complaint) => html`<${Mistake} complaint=${complaint} onSkip=${skip} />`)}
      <${SkippedRows}
        skipped=${choices.skipped}
        onSkip=${skip}
        onTake=${(/** @type {number} */ line) => setChoices(withAgain(choices, line))}
      />
      <${Failure} error=${failure} />
      ${(answer?.remarks ?? []).map((remark) => html`<p class="note">${told(remark)}</p>`)}
      <div class="actions">
        <button
          class="main"
          type="button"
          disabled=${!runs}
          onClick=${() => runs && onFiles({ "runs.csv": runs, ...answer?.histories })}
        >
          ${
            runs
              ? t`Use these ${answer?.run_count} runs`
              : answer === null
                ? t`The table is being judged`
                : t`Use these columns: answer what is marked`
          }
        </button>
        <button type="button" onClick=${() => keep("map.toml", map ?? "")}>Save the map</button>
        ${runs && html`<button type="button" onClick=${() => keep("runs.csv", runs)}>Save runs.csv</button>`}
        ${
          runs &&
          notes &&
          html`<button type="button" onClick=${() => keep("runs-notes.csv", notes)}>Save the notes</button>`
        }
      </div>
    </div>
  `;
}

/**
 * The cells of a field: where it comes from, in which unit, and what is wrong with it.
 * @returns {unknown[]}
 */
function cells(
  /** @type {FieldGuess | QuantityGuess} */ field,
  /** @type {Choice} */ choice,
  /** @type {ColumnCard[]} */ columns,
  /** @type {Complaint[]} */ complaints,
  /** @type {(change: Partial<Choice>) => void} */ onChange,
  /** @type {(row: import("../import_map.js").Skipped) => void} */ onSkip,
) {
  const absent =
    ABSENT[field.name] ??
    (choice.formula !== "" ? choice.formula : "is_needed" in field && field.is_needed ? t`(none)` : t`(not measured)`);
  const isOpen = choice.unit === "" && (choice.column !== null || choice.value !== "");
  const words = told(field.words);
  const fillDown = complaints.some((complaint) => complaint.fix === "fill_down")
    ? () => onChange({ fillsDown: true })
    : null;
  const take = (/** @type {string} */ name) => {
    const column = columns.find((card) => card.name === name);
    onChange({
      column: column?.name ?? null,
      fillsDown: false,
      words: field.name === "use" ? meaningsOf(column) : {},
      ...(column ? { unit: field.units.find((unit) => unit === column.unit) ?? "" } : {}),
    });
  };
  return [
    html`
      ${words}
      ${complaints.map((complaint) => html`<${Mistake} complaint=${complaint} field=${field.name} onSkip=${onSkip} />`)}
      ${fillDown && html`<button type="button" onClick=${fillDown}>Blank cells have the value above</button>`}
    `,
    html`
      <div>
        <select
          aria-label=${t`column of ${words}`}
          aria-invalid=${complaints.length > 0}
          value=${choice.column ?? ""}
          onChange=${(/** @type {SelectEvent} */ e) => take(e.currentTarget.value)}
        >
          <option value="" selected=${choice.column === null}>${absent}</option>
          ${columns.map(
            (column) =>
              html`<option value=${column.name} selected=${choice.column === column.name}>${column.title}</option>`,
          )}
        </select>
        ${choice.fillsDown && html`<${FilledDown} words=${words} onUndo=${() => onChange({ fillsDown: false })} />`}
        <${Meanings}
          words=${choice.words}
          onChange=${(/** @type {Record<string, string>} */ words) => onChange({ words })}
        />
      </div>
    `,
    field.units.length === 0 || (choice.formula !== "" && choice.column === null)
      ? ""
      : html`
          <select
            aria-label=${t`unit of ${words}`}
            aria-invalid=${isOpen}
            value=${choice.unit}
            onChange=${(/** @type {SelectEvent} */ e) => onChange({ unit: e.currentTarget.value })}
          >
            <option value="" selected=${choice.unit === ""}>choose</option>
            ${field.units.map(
              (/** @type {string} */ unit) =>
                html`<option value=${unit} selected=${choice.unit === unit}>${unit}</option>`,
            )}
          </select>
        `,
    choice.column !== null || field.name === "run" || choice.formula !== ""
      ? ""
      : html`
          <input
            size="10"
            aria-label=${t`${words} of all rows`}
            value=${choice.value}
            onInput=${(/** @type {FieldEvent} */ e) => onChange({ value: e.currentTarget.value })}
          />
        `,
  ];
}

const keep = (/** @type {string} */ name, /** @type {string} */ text) =>
  save(name, new Blob([text], { type: "text/plain" }));

/** Bytes in base64, in parts, because the number of arguments of a call is limited. */
function base64(/** @type {Uint8Array} */ bytes) {
  const PART = 0x8000;
  let text = "";
  for (let k = 0; k < bytes.length; k += PART) text += String.fromCharCode(...bytes.subarray(k, k + PART));
  return btoa(text);
}
