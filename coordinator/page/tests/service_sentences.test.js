import assert from "node:assert/strict";
import { test } from "node:test";

// A browser of a German reader.
globalThis.localStorage = { getItem: (/** @type {string} */ key) => ({ "grouser.language": "de" })[key] ?? null };
const { told } = await import("../modules/language/language.js");
const { clauses, said, sentence } = await import("../modules/words/clauses.js");
const { digits, meanAndSd, probability } = await import("../modules/words/quantity.js");

const plain = (/** @type {string} */ text) => text.replaceAll("\u00a0", " ");

test("sentences of the service are German with decimal commas, whole", () => {
  const wrong =
    "torque is off by 1.58 N m on held-out runs, and on the 6 of 16 that lie between fitted runs by 0.87 N m where interpolation has 0.14 N m: over-predicted at low slip and under-predicted at high slip; within the noise: sinkage 0.31 mm, 0.78 times the noise";
  assert.deepEqual(
    clauses(wrong).map((clause) => plain(sentence(clause))),
    [
      "Drehmoment: Fehler 1,58 N m bei zurückgehaltenen Fahrten, und bei den 6 von 16 zwischen angepassten Fahrten: 0,87 N m, wo Interpolation 0,14 N m hat: bei kleinem Schlupf zu hoch und bei großem zu niedrig berechnet.",
      "Im Rauschen: Einsinkung 0,31 mm, das 0,78-Fache des Rauschens.",
    ],
  );
  for (const [english, german] of [
    [
      "janosi_hanamoto was missing (P > 0.999) and is added: held-out error from 8.3 to 0.83 times the noise",
      "janosi_hanamoto fehlte (P > 0,999) und ist hinzugefügt: Fehler zurückgehaltener Fahrten vom 8,3- auf das 0,83-Fache des Rauschens",
    ],
    [
      "beyond that, nothing that these data can show (P 0.65 that nothing is missing)",
      "darüber hinaus nichts, was diese Daten zeigen können (P 0,65, dass nichts fehlt)",
    ],
    [
      "run the wheel at slip 0.80 under 150 N at 16.0 mm/s, which tells a_b and c_d apart, and add the rows",
      "das Rad fahren bei Schlupf 0,80 unter 150 N mit 16,0 mm/s; das unterscheidet a_b und c_d; dann die Zeilen hinzufügen",
    ],
    [
      "search the library for the effect that the model is missing",
      "die Bibliothek nach dem Effekt durchsuchen, der dem Modell fehlt",
    ],
    [
      "sinkage is off by 0.65 mm, 1.6 times the noise: most at a load of 60 N, over-predicted there",
      "Einsinkung: Fehler 0,65 mm, das 1,6-Fache des Rauschens: am meisten bei einer Last von 60 N, dort zu hoch berechnet",
    ],
    [
      "most at a slip angle of 90 deg, beyond the fitted ones, under-predicted there",
      "am meisten bei einem Schräglaufwinkel von 90°, jenseits der angepassten, dort zu niedrig berechnet",
    ],
    [
      "measure runs in skid: they would show 1 further effect",
      "messen: gebremste Fahrten; das würde 1 weiteren Effekt zeigen",
    ],
    [
      "go on with calibration 3 (which-model (wong_reece)), the current model of the study",
      "weiter mit Kalibrierung 3 (which-model (wong_reece)), dem aktuellen Modell der Studie",
    ],
    ["wheel", "Rad"],
    [
      "sinkage on held-out runs cannot be judged: its noise is inferred together with the misfit",
      "Einsinkung bei zurückgehaltenen Fahrten: nicht zu beurteilen, weil das Rauschen mit der Abweichung zusammen geschätzt ist",
    ],
    [
      "the density of soil s is not stated; 1500 kg/m^3 is assumed",
      "die Dichte des Bodens s ist nicht angegeben; 1500 kg/m³ ist angenommen",
    ],
    [
      "go on with calibration 3 (slip-30 v2.1), the current model of the study",
      "weiter mit Kalibrierung 3 (slip-30 v2.1), dem aktuellen Modell der Studie",
    ],
  ])
    assert.equal(plain(said(english)), german);
});

test("a sentence with a phrase that is not known stays English as a whole", () => {
  const unknown = "sinkage is off by 1.10 mm on held-out runs, because the moon is full";
  assert.equal(told(unknown), unknown);
});

test("numbers have the decimal mark of the language", () => {
  assert.deepEqual(
    [digits(1.58), digits(-0.5, 2), probability(0.951), probability(1)],
    ["1,58", "−0,50", "0,95", "> 0,999"],
  );
  assert.deepEqual(meanAndSd(9.3551, 0.613), { mean: "9,36", sd: "0,61" });
});

test("title and summary of every example are German", async () => {
  const { readFile } = await import("node:fs/promises");
  const source = await readFile(new URL("../../src/example.rs", import.meta.url), "utf8");
  const texts = [...source.matchAll(/(?:title|summary): "([^"]+)"/g)].map(([, text]) => text);
  assert.ok(texts.length >= 8);
  assert.deepEqual(
    texts.filter((text) => told(text) === text),
    [],
  );
});
