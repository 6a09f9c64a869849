// Pictures and numbers as files.

/** What the style sheet gives a picture, which it keeps as a file. */
const STYLED = [
  "fill",
  "stroke",
  "stroke-width",
  "stroke-dasharray",
  "stroke-opacity",
  "fill-opacity",
  "opacity",
  "font-family",
  "font-size",
  "font-weight",
  "color",
  "text-anchor",
];
const PIXELS = 2;

/** Lets the browser save a file. */
export function save(/** @type {string} */ name, /** @type {Blob} */ blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** The width of the border of a file, and the height of its title [px]. */
const BORDER = 8;
const TITLE = 24;

const SVG = "http://www.w3.org/2000/svg";

/** An element of a picture. */
function element(/** @type {string} */ name, /** @type {Record<string, string | number>} */ attributes, text = "") {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  made.textContent = text;
  return made;
}

/** A copy of a picture with its styles inside, at a place of another. */
function styled(/** @type {SVGSVGElement} */ picture, /** @type {{ left: number, top: number }} */ { left, top }) {
  const copy = /** @type {SVGSVGElement} */ (picture.cloneNode(true));
  const originals = [picture, ...picture.querySelectorAll("*")];
  const copies = [copy, ...copy.querySelectorAll("*")];
  originals.forEach((original, k) => {
    const style = getComputedStyle(original);
    for (const name of STYLED) /** @type {SVGElement} */ (copies[k]).setAttribute(name, style.getPropertyValue(name));
  });
  const { width, height } = picture.getBoundingClientRect();
  for (const [key, value] of Object.entries({ x: left, y: top, width, height })) copy.setAttribute(key, String(value));
  return copy;
}

/** What a legend shows, at its place relative to a figure: glyphs, swatches and words. */
function legendOf(/** @type {HTMLElement} */ figure, /** @type {DOMRect} */ frame) {
  const at = (/** @type {Element | Range} */ part) => {
    const box = part.getBoundingClientRect();
    return { left: box.left - frame.left + BORDER, top: box.top - frame.top, width: box.width, height: box.height };
  };
  return [...figure.querySelectorAll(".legend > *")].flatMap((entry) =>
    [...entry.childNodes].flatMap((node) => {
      if (node instanceof SVGSVGElement) return [styled(node, at(node))];
      const style = getComputedStyle(node instanceof Element ? node : entry);
      if (node instanceof HTMLElement && !node.textContent) {
        const { left, top, width, height } = at(node);
        return [element("rect", { x: left, y: top, width, height, fill: style.backgroundColor })];
      }
      const range = document.createRange();
      range.selectNodeContents(node);
      const { left, top, height } = at(range);
      const font = { "font-family": style.fontFamily, "font-size": style.fontSize, fill: style.color };
      return node.textContent?.trim()
        ? [element("text", { x: left, y: top + 0.78 * height, ...font }, node.textContent)]
        : [];
    }),
  );
}

/** A picture with its title, its legend and its styles inside, on the ground of the page. */
function markup(/** @type {HTMLElement} */ figure) {
  const picture = /** @type {SVGSVGElement} */ (figure.querySelector(".plot > svg"));
  const [frame, plot, legend] = [figure, picture, figure.querySelector(".legend")].map((part) =>
    part?.getBoundingClientRect(),
  );
  if (!frame || !plot) throw new Error("there is no picture");
  const body = getComputedStyle(document.body);
  // The title of the page may break; that of a file is one line.
  const shift = plot.top - frame.top - TITLE;
  const [width, height] = [plot.width + 2 * BORDER, (legend ?? plot).bottom - frame.top - shift + BORDER];
  const title = figure.querySelector("figcaption b")?.textContent ?? "";
  const whole = element("svg", { width, height, viewBox: `0 ${shift} ${width} ${height}` });
  whole.append(
    element("rect", { x: 0, y: shift, width, height, fill: body.backgroundColor }),
    element(
      "text",
      {
        x: BORDER,
        y: shift + 0.75 * TITLE,
        "font-family": body.fontFamily,
        "font-size": 15,
        "font-weight": 600,
        fill: body.color,
      },
      title,
    ),
    styled(picture, { left: plot.left - frame.left + BORDER, top: plot.top - frame.top }),
    ...legendOf(figure, frame),
  );
  return { text: new XMLSerializer().serializeToString(whole), width, height };
}

/** A figure as a vector file. */
export const svg = (/** @type {HTMLElement} */ figure) => new Blob([markup(figure).text], { type: "image/svg+xml" });

/**
 * A figure in pixels, two for each of the screen.
 * @param {HTMLElement} figure
 * @returns {Promise<Blob>}
 */
export async function png(figure) {
  const { text, width, height } = markup(figure);
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = PIXELS * width;
  canvas.height = PIXELS * height;
  canvas.getContext("2d")?.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((resolve, reject) =>
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("the browser makes no PNG"))), "image/png"),
  );
}

/** Rows as CSV, columns in the order in which they first appear. */
export function table(/** @type {import("./figure.js").Row[]} */ rows) {
  const columns = [...new Set(rows.flatMap((row) => Object.keys(row)))];
  const cell = (/** @type {unknown} */ value) => {
    const text = value === null || value === undefined ? "" : String(value);
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return (
    [columns, ...rows.map((row) => columns.map((name) => row[name]))]
      .map((line) => line.map(cell).join(","))
      .join("\n") + "\n"
  );
}

/** Rows as a file. */
export const csv = (/** @type {import("./figure.js").Row[]} */ rows) => new Blob([table(rows)], { type: "text/csv" });
