// A place for files: they are dropped onto it, or chosen with its button.

import { html, useState } from "../html.js";

/**
 * @typedef {{ texts: Record<string, string>, bytes: Record<string, Uint8Array> }} Read by name; what is no text has
 *   bytes alone
 */

/** Spreadsheets and MATLAB files. */
const BINARY = /\.(xlsx|xlsm|ods|xls|mat)$/i;

/**
 * The texts of files and their bytes: a table may be in another encoding than a browser takes it for.
 * @returns {Promise<Read>}
 */
async function read(/** @type {Iterable<File>} */ files) {
  const entries = await Promise.all(
    [...files].map(async (file) => ({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) })),
  );
  const texts = entries
    .filter(({ name }) => !BINARY.test(name))
    .map(({ name, bytes }) => [name, new TextDecoder().decode(bytes)]);
  return {
    texts: Object.fromEntries(texts),
    bytes: Object.fromEntries(entries.map(({ name, bytes }) => [name, bytes])),
  };
}

/** @param {{ onFiles: (files: Read) => void }} properties */
export function DropZone({ onFiles }) {
  const [isOver, setOver] = useState(false);
  const drop = async (/** @type {DragEvent} */ event) => {
    event.preventDefault();
    setOver(false);
    onFiles(await read(event.dataTransfer?.files ?? []));
  };
  const chosen = async (/** @type {FieldEvent} */ { currentTarget: field }) => {
    onFiles(await read(field.files ?? []));
    field.value = "";
  };
  return html`
    <div
      class=${isOver ? "drop over" : "drop"}
      onDragOver=${(/** @type {Event} */ e) => {
        e.preventDefault();
        setOver(true);
      }}
      onDragLeave=${() => setOver(false)}
      onDrop=${drop}
    >
      <p>
        Drop the files here: <code>job.toml</code>, <code>experiment.toml</code>, <code>runs.csv</code> and whatever
        they name. A table of measurements alone is enough, too: text, .xlsx, .ods or .mat.
      </p>
      <label>
        or choose
        them: <input
          type="file"
          multiple
          accept=".toml,.csv,.txt,.tsv,.dat,.stl,.obj,.xlsx,.xlsm,.ods,.mat"
          onChange=${chosen}
        />
      </label>
    </div>
  `;
}
