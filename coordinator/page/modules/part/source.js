// Where the measurements of a study come from.

import { html } from "../html.js";

/** @param {{ campaign?: Study["campaign"] }} properties */
export function Source({ campaign }) {
  if (!campaign) return null;
  return html`
    <p class="note">
      Measurements: ${campaign.citation}${campaign.digitised && html`; <strong>${campaign.digitised}</strong>`}
    </p>
  `;
}
