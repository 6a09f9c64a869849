// The pictures of the page in README and documents: taken again of the same studies, and compared. PICTURE=write puts the
// new ones in their place.
//
// Fonts and their smoothing differ between machines, so two things are compared. The words: the picture carries those that it shows, those
// in charts too, as the text of its file. The layout: both pictures are drawn 160 pixels wide, and a pixel differs where a colour does by more
// than 32 of 255; a serif font changes 8 % of them, another story 10 %.

import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { test } from "node:test";

import { open } from "./browser.js";
import { Service, filesOf } from "./service.js";

const DOCUMENTS = new URL("../../docs/", import.meta.url);
/**
 * The pictures: of the story of which example, in which language, how high, and what is drawn last.
 */
const PICTURES = [
  {
    file: "page.png",
    folder: "examples/hidden-effect",
    locale: "en-GB",
    height: 1020,
    last: ".three ~ .figures .plot svg",
  },
  {
    file: "page-which-model.png",
    folder: "examples/which-model",
    locale: "en-GB",
    height: 1230,
    last: ".three ~ .scroll tbody tr",
  },
  {
    file: "page-german.png",
    folder: "examples/import-german",
    locale: "de-DE",
    height: 800,
    last: ".three ~ .figures .plot svg",
  },
];
/** Most bytes of a picture: a README is read over slow lines too. */
const MOST_BYTES = 200_000;
/** Most of the small pixels that may differ. */
const MOST_SHARE = 0.09;
const WIDTH = 1280;

/** The study of an example as the service ends it by itself. */
async function submitted(service, folder) {
  const texts = Object.fromEntries((await filesOf(folder)).map(({ name, text }) => [name, text]));
  const { "job.toml": job, "experiment.toml": experiment, "runs.csv": runs } = texts;
  const { id } = await service.post("/v1/experiments", { toml: experiment, files: { "runs.csv": runs } });
  const name = folder.split("/").at(-1);
  return (await service.post("/v1/calibrations", { experiment: id, toml: job, files: {}, name })).study;
}

/** Share of the pixels that differ, of two pictures that are drawn small; 1 where their sizes differ. */
const difference = (page, pictures) =>
  page.evaluate(
    async (sources) => {
      const images = await Promise.all(
        sources.map(async (source) => {
          const image = new Image();
          image.src = `data:image/png;base64,${source}`;
          await image.decode();
          return image;
        }),
      );
      const [before, now] = images;
      if (before.width !== now.width || before.height !== now.height) return 1;
      const width = 160,
        height = Math.round((width * now.height) / now.width);
      const [a, b] = images.map((image) => {
        const canvas = Object.assign(document.createElement("canvas"), { width, height });
        const context = canvas.getContext("2d");
        context.imageSmoothingQuality = "high";
        context.drawImage(image, 0, 0, width, height);
        return context.getImageData(0, 0, width, height).data;
      });
      let differing = 0;
      for (let k = 0; k < a.length; k += 4) {
        if ([0, 1, 2].some((c) => Math.abs(a[k + c] - b[k + c]) > 32)) differing += 1;
      }
      return differing / (a.length / 4);
    },
    pictures.map((bytes) => bytes.toString("base64")),
  );

/** What a picture file says of itself: text chunks as the format PNG has them, after the pixels. */
const KEY = "Description\0\0\0\0\0";

/** The picture with a text. */
function withText(/** @type {Buffer} */ png, /** @type {string} */ text) {
  const body = Buffer.from(`iTXt${KEY}${text}`);
  const [length, sum] = [Buffer.alloc(4), Buffer.alloc(4)];
  length.writeUInt32BE(body.length - 4);
  sum.writeUInt32BE(crc32(body));
  const end = png.length - 12;
  return Buffer.concat([png.subarray(0, end), length, body, sum, png.subarray(end)]);
}

/** The text of a picture; empty without one. */
function textOf(/** @type {Buffer} */ png) {
  const at = png.indexOf(`iTXt${KEY}`);
  return at < 0 ? "" : png.subarray(at + 4 + KEY.length, at + 4 + png.readUInt32BE(at - 4)).toString();
}

function crc32(/** @type {Buffer} */ bytes) {
  let sum = ~0;
  for (const byte of bytes) {
    sum ^= byte;
    for (let k = 0; k < 8; k += 1) sum = (sum >>> 1) ^ (sum & 1 ? 0xedb88320 : 0);
  }
  return ~sum >>> 0;
}

/** The words of the page, those of charts too, in the order of the document. */
const wordsOf = (page) => page.evaluate(() => document.body.textContent.replace(/\s+/g, " ").trim());

for (const { file, folder, locale, height, last } of PICTURES) {
  test(`docs/${file} is a picture of the page`, async () => {
    // A service of its own: the page shows the number of the study.
    const service = await Service.start();
    let tab;
    try {
      const study = await submitted(service, folder);
      await service.finished(study);
      tab = await open({ url: service.url, width: WIDTH, height, locale });
      const { page } = tab;
      await page.goto(`${service.url}/#/studies/${study}/story`);
      await page.locator("section.view.story").waitFor();
      // The picture of the headline comes with the rows of its models, the others with the study.
      await page.locator(".headline .model path").first().waitFor({ state: "attached" });
      await page.locator(last).last().waitFor();
      await page.mouse.move(2, 2);
      const taken = withText(await page.screenshot(), await wordsOf(page));
      const place = new URL(file, DOCUMENTS);
      if (process.env.PICTURE === "write") await writeFile(place, taken);
      const kept = await readFile(place);
      assert.ok(kept.length < MOST_BYTES, `docs/${file} has ${kept.length} bytes`);
      const again = "tests/page/run with PICTURE=write takes it again";
      assert.equal(textOf(kept), textOf(taken), `docs/${file} shows other words than the page; ${again}`);
      // A document of its own: the policy of the page forbids pictures as data.
      const blank = await tab.context.newPage();
      const share = await difference(blank, [kept, taken]);
      assert.ok(share < MOST_SHARE, `${(100 * share).toFixed(1)} % of docs/${file} differs from the page; ${again}`);
      // The comparison can fail: the page without its cards is another picture.
      await page
        .addStyleTag({ content: ".headline, .three { display: none }" })
        .catch(() =>
          page.evaluate(() => document.querySelectorAll(".headline, .three").forEach((part) => part.remove())),
        );
      const other = await page.screenshot();
      assert.ok((await difference(blank, [taken, other])) > MOST_SHARE, "a page without its cards passes for the same");
    } finally {
      await tab?.close();
      await service.stop();
    }
  });
}
