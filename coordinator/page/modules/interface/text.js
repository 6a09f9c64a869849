// Words of the description: code between back quotes, links to schemas, JSON whose texts have lines.

import { html } from "../html.js";
import { words } from "./document.js";

/** @param {{ children?: unknown }} properties */
export const Words = ({ children }) =>
  [children]
    .flat()
    .join("")
    .split("`")
    .map((part, k) => (k % 2 ? html`<code>${part}</code>` : part));

/** @param {{ of?: JsonSchema }} properties */
export const Kind = ({ of }) =>
  words(of).map((part) =>
    typeof part === "string" ? part : html`<a href=${`#/schemas/${part.name}`}>${part.name}</a>`,
  );

/**
 * JSON in which a line of a text that it holds, as of a file, stands on a line.
 * @param {{ text: string }} properties
 */
export const Json = ({ text }) =>
  text.split(/(?<=\\n)(?!")/).map((line, k) => (k ? html`<span class="line">${line}</span>` : line));
