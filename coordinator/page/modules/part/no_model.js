// What stands in a view of a study that has no finished calibration: what to wait for, or that nothing will come.

import { html } from "../html.js";
import { address } from "../route.js";

/** @param {{ study: { id: number, state: string } }} properties */
export function NoModel({ study }) {
  const to = (/** @type {string} */ view) => address(["studies", study.id, view]);
  if (study.state === "failed")
    return html`
      <p class="empty">
        The calibration failed, so that there is nothing to show. <a href=${to("story")}>The story</a> says why, and
        what to do.
      </p>
    `;
  if (study.state === "cancelled")
    return html`<p class="empty">The study was cancelled before a calibration had finished.</p>`;
  if (study.state === "paused")
    return html`
      <p class="empty">
        The study is paused before its first calibration has finished. <a href=${to("live")}>Live</a> has the button
        that resumes it.
      </p>
    `;
  return html`
    <p class="empty">
      No calibration of this study is finished yet. <a href=${to("live")}>Live</a> shows how far it is.
    </p>
  `;
}
