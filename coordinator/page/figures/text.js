// Text in markup, and numbers as text.

/** A text that cannot leave its place in markup. */
export function escape(text) {
  const names = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#39;" };
  return String(text).replace(/[&<>"']/g, (character) => names[character]);
}

/** A pixel with two decimals at most. */
export function px(value) {
  return String(Math.round(value * 100) / 100);
}

/** A number to so many significant digits, without an exponent where it needs none. */
export function digits(value, count = 3) {
  return String(Number(value.toPrecision(count)));
}

/** `2.5e+9` for people: 2.5·10⁹. */
export function power(exponent) {
  const raised = [..."⁰¹²³⁴⁵⁶⁷⁸⁹"];
  const figures = [...String(Math.abs(exponent))].map((figure) => raised[Number(figure)]);
  return `10${exponent < 0 ? "⁻" : ""}${figures.join("")}`;
}

/** `drawbar_pull` as words. */
export function words(name) {
  return name.replaceAll("_", " ");
}
