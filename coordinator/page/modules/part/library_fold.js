// The library as a fold, whose content is asked for when it is opened.

import { html, useState } from "../html.js";
import { Later } from "./later.js";

const library = () => import("./library.js").then((module) => module.Library);

export function LibraryFold() {
  const [isOpen, setOpen] = useState(false);
  return html`
    <details
      class="fold"
      onToggle=${(/** @type {{ currentTarget: HTMLDetailsElement }} */ e) => setOpen(e.currentTarget.open)}
    >
      <summary>Library of laws</summary>
      ${isOpen && html`<${Later} title="The library" load=${library} />`}
    </details>
  `;
}
