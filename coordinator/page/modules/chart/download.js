// Pictures and numbers as files.

/** What the style sheet gives a picture, which it keeps as a file. */
const STYLED = ["fill", "stroke", "stroke-width", "stroke-dasharray", "stroke-opacity", "fill-opacity", "opacity", "font-family", "font-size", "color", "text-anchor"];
const PIXELS = 2;

/** Lets the browser save a file. */
export function save(/** @type {string} */ name, /** @type {Blob} */ blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** A picture with its styles inside, on the ground of the page. */
function markup(/** @type {SVGSVGElement} */ picture) {
  const copy = /** @type {SVGSVGElement} */ (picture.cloneNode(true));
  const originals = [picture, ...picture.querySelectorAll("*")];
  const copies = [copy, ...copy.querySelectorAll("*")];
  originals.forEach((original, k) => {
    const style = getComputedStyle(original);
    for (const name of STYLED) /** @type {SVGElement} */ (copies[k]).setAttribute(name, style.getPropertyValue(name));
  });
  const { width, height } = picture.getBoundingClientRect();
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.setAttribute("width", String(width));
  copy.setAttribute("height", String(height));
  copy.style.background = getComputedStyle(document.body).backgroundColor;
  return { text: new XMLSerializer().serializeToString(copy), width, height };
}

/** A picture as a vector file. */
export const svg = (/** @type {SVGSVGElement} */ picture) => new Blob([markup(picture).text], { type: "image/svg+xml" });

/**
 * A picture in pixels, two for each of the screen.
 * @param {SVGSVGElement} picture
 * @returns {Promise<Blob>}
 */
export async function png(picture) {
  const { text, width, height } = markup(picture);
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = PIXELS * width;
  canvas.height = PIXELS * height;
  canvas.getContext("2d")?.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((resolve, reject) =>
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("the browser makes no PNG"))), "image/png"));
}

/** Rows as CSV, columns in the order in which they first appear. */
export function table(/** @type {import("./figure.js").Row[]} */ rows) {
  const columns = [...new Set(rows.flatMap((row) => Object.keys(row)))];
  const cell = (/** @type {unknown} */ value) => {
    const text = value === null || value === undefined ? "" : String(value);
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return [columns, ...rows.map((row) => columns.map((name) => row[name]))].map((line) => line.map(cell).join(",")).join("\n") + "\n";
}

/** Rows as a file. */
export const csv = (/** @type {import("./figure.js").Row[]} */ rows) => new Blob([table(rows)], { type: "text/csv" });
