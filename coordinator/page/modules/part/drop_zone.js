// A place for files: they are dropped onto it, or chosen with its button.

import { html, useState } from "../html.js";

/** The texts of files, by name. */
async function read(/** @type {Iterable<File>} */ files) {
  const entries = await Promise.all([...files].map(async (file) => [file.name, await file.text()]));
  return Object.fromEntries(entries);
}

/** @param {{ onFiles: (files: Record<string, string>) => void }} properties */
export function DropZone({ onFiles }) {
  const [isOver, setOver] = useState(false);
  const drop = async (/** @type {DragEvent} */ event) => {
    event.preventDefault();
    setOver(false);
    onFiles(await read(event.dataTransfer?.files ?? []));
  };
  const chosen = async (/** @type {any} */ event) => {
    onFiles(await read(event.target.files));
    event.target.value = "";
  };
  return html`
    <div class=${isOver ? "drop over" : "drop"} onDragOver=${(/** @type {Event} */ e) => { e.preventDefault(); setOver(true); }}
      onDragLeave=${() => setOver(false)} onDrop=${drop}>
      <p>Drop the files here: <code>job.toml</code>, <code>experiment.toml</code>, <code>runs.csv</code> and whatever they name. A table of measurements alone is enough, too.</p>
      <label>or choose them: <input type="file" multiple accept=".toml,.csv,.txt,.tsv,.dat,.stl,.obj" onChange=${chosen} /></label>
    </div>`;
}
