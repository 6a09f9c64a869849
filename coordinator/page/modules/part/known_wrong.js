// What stands above the parameters of a model that is off by more than the noise.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { channelName } from "../words/quantity.js";

/** @param {{ model: Member }} properties */
export function KnownWrong({ model }) {
  const channels = model.story?.wrong.channels ?? [];
  const off = channels.filter((c) => c.is_judged && !c.is_within_noise).map((c) => channelName(c.channel));
  if (off.length === 0) return null;
  return html`<p class="note">${t`This model is off by more than the noise: ${[...new Set(off)].join(", ")}.`}</p>`;
}
