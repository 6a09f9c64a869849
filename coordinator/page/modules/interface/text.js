// Words of the description: code between back quotes, links to schemas.

import { html } from "../html.js";
import { words } from "./document.js";

/** @param {{ children?: any }} properties */
export const Words = ({ children }) => [children].flat().join("").split("`").map((part, k) => (k % 2 ? html`<code>${part}</code>` : part));

/** @param {{ of: any }} properties */
export const Kind = ({ of }) => words(of).map((part) => (typeof part === "string"
  ? part
  : html`<a href=${`#/schemas/${part.name}`}>${part.name}</a>`));
