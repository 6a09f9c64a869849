// Names under the places of a picture: on lines of their own where these fit side by side, else slanted, always within
// the picture.

/** A character, and a line [px]. */
const CHARACTER = 5.8;
const LINE = 12;
/** Between a name and the next one, and to the edge of the picture [px]. */
const APART = 6;
/** Maximum number of characters of a slanted name. */
const MAX_CHARACTERS = 36;
/** Angle at which slanted names rise to their place [deg]. */
const SLANT_DEG = 40;
/** Room on both sides of the places, in steps between them. */
export const PADDING = 0.7;

/** @typedef {{ x: number, y: number, width: number, height: number }} Box */

/** Shortens a name to the maximum number of characters: a longer name keeps its ends. */
function shortened(/** @type {string} */ name) {
  return name.length <= MAX_CHARACTERS
    ? name
    : `${name.slice(0, MAX_CHARACTERS / 2)}…${name.slice(1 - MAX_CHARACTERS / 2)}`;
}

/** The width of a text [px]. */
export const textWidth = (/** @type {string} */ text) => CHARACTER * text.length;

/** The places of a number of names along an axis, and their distance [px]. */
export function places(/** @type {number} */ count, /** @type {number} */ left, /** @type {number} */ right) {
  const step = (right - left) / (count - 1 + 2 * PADDING);
  return { step, at: Array.from({ length: count }, (_, k) => left + step * (PADDING + k)) };
}

/**
 * How names are written under their places.
 * @param {{ names: string[][], width: number, left: number, right: number }} picture names: each with its parts, which
 *   may stand on a line each; left, right: the least margins [px]
 * @returns {{ rotate: number, texts: string[], left: number, bottom: number, step: number }} rotate: degrees; texts: a
 *   line for each part where they stand upright; left, bottom: margins that hold them; step: between the places [px]
 */
export function tickLabels({ names, width, left, right }) {
  const upright = places(names.length, left, width - right);
  const widest = (/** @type {string[]} */ parts) => Math.max(...parts.map(textWidth));
  const lines = Math.max(...names.map((parts) => parts.length));
  const fits = names.every(
    (parts, k) =>
      widest(parts) + APART <= upright.step &&
      upright.at[k] - widest(parts) / 2 >= 0 &&
      upright.at[k] + widest(parts) / 2 <= width,
  );
  if (fits)
    return {
      rotate: 0,
      texts: names.map((parts) => parts.join("\n")),
      left,
      bottom: 16 + LINE * lines,
      step: upright.step,
    };
  const slant = (SLANT_DEG * Math.PI) / 180;
  const texts = names.map((parts) => shortened(parts.join(", ")));
  // A place k moves to the right by the share 1 - f_k of what the margin grows by.
  const share = (/** @type {number} */ k) => (PADDING + k) / (names.length - 1 + 2 * PADDING);
  const needed = texts.map(
    (text, k) => (textWidth(text) * Math.cos(slant) + APART - (width - right) * share(k)) / (1 - share(k)),
  );
  const margin = Math.max(left, ...needed);
  const deepest = Math.max(...texts.map((text) => textWidth(text) * Math.sin(slant)));
  return {
    rotate: -SLANT_DEG,
    texts,
    left: margin,
    bottom: 16 + LINE + deepest,
    step: places(names.length, margin, width - right).step,
  };
}
