// A file of a draft: what it is, its text to be edited, and what the service says about it.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { Failure } from "./message.js";

const KINDS = {
  job: t`the job`,
  experiment: t`the experiment`,
  runs: t`runs`,
  effect: t`an effect`,
  history: t`the recording of a run`,
  readings: t`plate or shear readings`,
  posterior: t`a posterior as a prior`,
  table: t`a table in other columns than runs.csv has`,
  file: t`a file`,
  binary: t`no text that a calibration reads`,
};

/**
 * @param {{ name: string, text: string, kind: string, isUsed: boolean, error: Error | null,
 *   onText: (text: string) => void, onRemove: () => void }} properties
 */
export function FileCard({ name, text, kind, isUsed, error, onText, onRemove }) {
  const lines = text.split("\n").filter(Boolean).length;
  return html`
    <div class="card file" data-file=${name}>
      <div class="actions">
        <b>${name}</b>
        <span class="note">
          ${KINDS[/** @type {keyof typeof KINDS} */ (kind)]}
          ${kind === "binary" ? "" : `, ${lines === 1 ? t`1 line` : t`${lines} lines`}`}
          ${isUsed ? "" : t`; nothing names it, so it is not sent`}
        </span>
        <button type="button" onClick=${onRemove} aria-label=${t`remove ${name}`}>Remove</button>
      </div>
      <${Failure} error=${error} />
      ${
        kind !== "binary" &&
        html`
          <details open=${Boolean(error)}>
            <summary>Text of ${name}</summary>
            <textarea
              aria-label=${t`text of ${name}`}
              spellcheck=${false}
              value=${text}
              onInput=${(/** @type {FieldEvent<HTMLTextAreaElement>} */ e) => onText(e.currentTarget.value)}
            ></textarea>
          </details>
        `
      }
    </div>
  `;
}
