// What removes a mistake of a table by one click, and takes it back: a row is left out, blank cells take the value
// above, a word gets its meaning.

import { html, useState } from "../html.js";
import { MEANINGS, words as inWords } from "../import_map.js";
import { t, told } from "../language/language.js";

/** @typedef {import("../import_map.js").Skipped} Skipped */

/** The first cells of a row, as they stand in the file. */
const shown = (/** @type {string[]} */ cells) => cells.map((cell) => cell || "–").join(" · ");

/** @param {{ complaint: Complaint, field?: string, onSkip: (row: Skipped) => void }} properties */
export function Mistake({ complaint, field, onSkip }) {
  const { line } = complaint;
  return html`
    <div class="error" data-field=${field}>
      ${told(inWords(complaint))}
      ${
        complaint.fix === "skip" &&
        typeof line === "number" &&
        html`
          <code class="row">${shown(complaint.row)}</code>
          <button type="button" onClick=${() => onSkip({ line, cells: complaint.row })}>Leave out line ${line}</button>
        `
      }
    </div>
  `;
}

/**
 * The rows that are left out, each with a way back, and a way to leave out another.
 * @param {{ skipped: Skipped[], onSkip: (row: Skipped) => void, onTake: (line: number) => void }} properties
 */
export function SkippedRows({ skipped, onSkip, onTake }) {
  const [text, setText] = useState("");
  const line = Number(text);
  const isLine = text.trim() !== "" && Number.isInteger(line) && line > 0;
  const leave = () => {
    onSkip({ line, cells: [] });
    setText("");
  };
  return html`
    ${skipped.map(
      (row) => html`
        <div class="skipped" key=${row.line}>
          <span>
            Left out: line ${row.line} ${row.cells.length > 0 && html`<code class="row">${shown(row.cells)}</code>`}
          </span>
          <button type="button" onClick=${() => onTake(row.line)} aria-label=${t`Undo: take in line ${row.line} again`}>
            Undo
          </button>
        </div>
      `,
    )}
    <div class="actions">
      <label>
        A line that is no
        run <input
          size="5"
          inputmode="numeric"
          aria-invalid=${text !== "" && !isLine}
          value=${text}
          onInput=${(/** @type {FieldEvent} */ e) => setText(e.currentTarget.value)}
        />
      </label>
      <button type="button" disabled=${!isLine} onClick=${leave}>Leave it out</button>
    </div>
  `;
}

/** @param {{ words: string, onUndo: () => void }} properties words: of the quantity */
export const FilledDown = ({ words, onUndo }) => html`
  <div class="skipped">
    <span class="note">Blank cells have the value above.</span>
    <button type="button" onClick=${onUndo} aria-label=${t`Undo: blank cells of ${words} stay blank`}>Undo</button>
  </div>
`;

/**
 * What each word of a column means for its run.
 * @param {{ words: Record<string, string>, onChange: (words: Record<string, string>) => void }} properties
 */
export function Meanings({ words, onChange }) {
  const entries = Object.entries(words);
  if (entries.length === 0) return null;
  return html`
    <div class="meanings">
      ${entries.map(
        ([word, means]) => html`
          <label key=${word}>
            <span>${`“${word}”`}</span>
            <select
              aria-label=${t`meaning of ${word}`}
              aria-invalid=${means === "?"}
              value=${means}
              onChange=${(/** @type {SelectEvent} */ e) => onChange({ ...words, [word]: e.currentTarget.value })}
            >
              ${means === "?" && html`<option value="?" selected>choose</option>`}
              ${MEANINGS.map(
                ([value, label]) => html`<option value=${value} selected=${value === means}>${label}</option>`,
              )}
            </select>
          </label>
        `,
      )}
      <span class="note">Blank cells: the run is fitted.</span>
    </div>
  `;
}
