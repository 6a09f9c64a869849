// Sentences of the service in German: phrase by phrase, and only whole: a sentence in two languages is read in none.

import { EFFECTS } from "./german_effects.js";

/**
 * Phrases of the service, as regular expressions, in the order in which they are replaced: what contains others stands
 * first.
 * @type {Record<string, string>}
 */
const PHRASES = {
  // These phrases contain others, so they stand first.
  "search the library for the effect that the model is missing":
    "die Bibliothek nach dem Effekt durchsuchen, der dem Modell fehlt",
  "something is missing or the prior is wrong: ": "etwas fehlt, oder der Prior ist falsch: ",
  "beyond that, nothing that these data can show \\((P [^)]+?) that nothing is missing\\)":
    "darüber hinaus nichts, was diese Daten zeigen können ($1, dass nichts fehlt)",
  "nothing that these data can show \\((P [^)]+?) that nothing is missing\\)":
    "nichts, was diese Daten zeigen können ($1, dass nichts fehlt)",
  "one of (.+?) is missing \\(joint probability ([\\d.]+)\\)":
    "einer von $1 fehlt (zusammen mit Wahrscheinlichkeit $2)",
  "one of (.+?) is missing": "einer von $1 fehlt",
  "nothing detectable is missing": "nichts Nachweisbares fehlt",
  "a law outside the library is missing": "ein Gesetz außerhalb der Bibliothek fehlt",
  "go on with calibration (\\d+) \\((.+)\\), the current model of the study":
    "weiter mit Kalibrierung $1 ($2), dem aktuellen Modell der Studie",
  "(drawbar pull|torque|sinkage|lateral force) is (over|under)-predicted at low (.+?) and (?:over|under)-predicted at high .+?, by about ([\\d.]+ (?:N m|mm|N)) from one end to the other, before the fit compensates \\((p [=<] \\S+) among (\\d+) tests?\\)":
    "$1 ist bei kleinem Wert von $3 $2-predicted und bei großem umgekehrt, um etwa $4 von einem Ende zum anderen, bevor die Anpassung ausgleicht ($5 unter $6 Prüfungen)",
  "(drawbar pull|torque|sinkage|lateral force) is (over|under)-predicted by about ([\\d.]+ (?:N m|mm|N)) in all runs, before the fit compensates \\((p [=<] \\S+) among (\\d+) tests?\\)":
    "$1 ist in allen Fahrten um etwa $3 $2-predicted, bevor die Anpassung ausgleicht ($4 unter $5 Prüfungen)",
  ": shear may be mobilised later than in the model": ": der Schub baut sich vielleicht später auf als im Modell",
  ": shear may be mobilised earlier than in the model": ": der Schub baut sich vielleicht früher auf als im Modell",
  ": the wheel may sink deeper as it slips \\(slip-sinkage\\)":
    ": das Rad sinkt vielleicht tiefer ein, wenn es durchdreht",
  "(drawbar pull|torque|sinkage|lateral force) of run (\\S+) lies ([\\d.]+ (?:N m|mm|N)) above the prediction, ([\\d.]+) of its standard deviations \\((p [=<] \\S+) among (\\d+) residuals\\)":
    "$1 der Fahrt $2 liegt $3 über der Vorhersage, $4 ihrer Standardabweichungen ($5 unter $6 Abweichungen)",
  "(drawbar pull|torque|sinkage|lateral force) of run (\\S+) lies ([\\d.]+ (?:N m|mm|N)) below the prediction, ([\\d.]+) of its standard deviations \\((p [=<] \\S+) among (\\d+) residuals\\)":
    "$1 der Fahrt $2 liegt $3 unter der Vorhersage, $4 ihrer Standardabweichungen ($5 unter $6 Abweichungen)",
  ": a measurement error, or a condition outside the model's validity":
    ": ein Messfehler, oder eine Bedingung außerhalb der Gültigkeit des Modells",
  "; (\\d+) more residuals of this channel are beyond chance":
    "; $1 weitere Abweichungen dieses Kanals gehen über Zufall hinaus",
  " lies at a bound of its prior \\(90 % of the posterior in ([\\d.]+) to ([\\d.]+)\\): the data favour a value that the prior excludes, or an effect is missing":
    " liegt an einer Grenze des Priors (90 % des Posteriors in $1 bis $2): die Daten bevorzugen einen Wert, den der Prior ausschließt, oder ein Effekt fehlt",
  "the density of soil (\\S+) is not stated; ([\\d.]+) kg/m³ is assumed":
    "die Dichte des Bodens $1 ist nicht angegeben; $2 kg/m³ ist angenommen",
  "the length of the bin is not stated; ([\\d.]+) m is assumed":
    "die Länge der Rinne ist nicht angegeben; $1 m ist angenommen",
  "the grousers of wheel (\\S+) are not stated; (\\d+) of ([\\d.]+) mm are assumed":
    "die Stollen des Rades $1 sind nicht angegeben; $2 von $3 mm sind angenommen",
  "it changes nothing at the slips and slip angles of the fitted runs":
    "er ändert nichts bei Schlupf und Schräglaufwinkel der angepassten Fahrten",
  "kept as notes, no columns of runs\\.csv: ": "als Notizen behalten, keine Spalten von runs.csv: ",
  "[Ww]hich wheel\\? Choose its column, or give one name for all rows":
    "Welches Rad? Wählen Sie seine Spalte, oder geben Sie einen Namen für alle Zeilen an",
  "[Ww]hich soil\\? Choose its column, or give one name for all rows":
    "Welcher Boden? Wählen Sie seine Spalte, oder geben Sie einen Namen für alle Zeilen an",
  "(\\d+) fitted runs with (\\d+) measurements, (\\d+) holdout runs":
    "$1 angepasste Fahrten mit $2 Messungen, $3 zurückgehaltene Fahrten",
  "^tmcmc with (\\d+) particles, (\\d+) to (\\d+) moves per stage":
    "tmcmc mit $1 Partikeln, $2 bis $3 Schritte je Stufe",
  "^tmcmc with (\\d+) particles": "tmcmc mit $1 Partikeln",
  "the runs of each of (\\d+) ids in the column (\\S+) share an offset of (\\S+), sd unknown":
    "die Fahrten jeder der $1 Kennungen in der Spalte $2 haben einen gemeinsamen Versatz von $3, dessen Standardabweichung nicht bekannt ist",
  "the runs of each of (\\d+) ids in the column (\\S+) share an error of the soil's stiffness, sd unknown":
    "die Fahrten jeder der $1 Kennungen in der Spalte $2 haben einen gemeinsamen Fehler der Steifigkeit des Bodens, dessen Standardabweichung nicht bekannt ist",
  "[Ww]heel (\\S+) has fewer than three repeats of conditions: offsets of operators cannot be told from effects of the conditions; repeat conditions, some with the same operator and some with another":
    "Rad $1 hat weniger als drei Wiederholungen von Bedingungen: Versätze der Bediener lassen sich nicht von Wirkungen der Bedingungen trennen; wiederholen Sie Bedingungen, manche mit demselben Bediener und manche mit einem anderen",
  "[Hh]ow large is it\\? Choose its column, or give the value that all rows have, with its unit":
    "Wie groß? Wählen Sie die Spalte, oder geben Sie den Wert aller Zeilen mit seiner Einheit an",
  "^A pilot of (\\d+) particles took (\\d+) evaluations": "Ein Vorlauf mit $1 Partikeln brauchte $2 Auswertungen",
  "^(.+) would add to the candidates of a search: ": "$1 brächte einer Suche weitere Kandidaten: ",
  "A fit found the most probable parameters in (\\d+) evaluations; it stopped because no step improves the posterior any more\\. Draws, intervals and evidence below are those of a normal approximation about them: exact where the posterior is normal in the normal scores of the parameters":
    "Eine Anpassung hat die wahrscheinlichsten Parameter in $1 Auswertungen gefunden; sie endete, weil kein Schritt den Posterior mehr verbessert. Ziehungen, Intervalle und Evidenz sind die einer Normalverteilung um sie",
  "^Not interpolated: wheel (\\S+) on soil (\\S+) was fitted at loads of ([\\d.]+) to ([\\d.]+) N alone":
    "Nicht interpoliert: Rad $1 auf Boden $2 wurde nur bei Lasten von $3 bis $4 N angepasst",
  // What the model gets wrong.
  "there is no wheel run to compare the model with": "es gibt keine Fahrt eines Rades zum Vergleich",
  "the model predicts no run: it rejected every final draw":
    "das Modell sagt keine Fahrt voraus: es hat jede letzte Ziehung abgewiesen",
  "nothing beyond the noise on held-out runs": "nichts über dem Rauschen bei zurückgehaltenen Fahrten",
  "nothing beyond the noise on fitted runs": "nichts über dem Rauschen bei angepassten Fahrten",
  "within the noise: ": "im Rauschen: ",
  " on held-out runs cannot be judged: (?:its|their) noise is inferred together with the misfit":
    " bei zurückgehaltenen Fahrten: nicht zu beurteilen, weil das Rauschen mit der Abweichung zusammen geschätzt ist",
  " on fitted runs cannot be judged: (?:its|their) noise is inferred together with the misfit":
    " bei angepassten Fahrten: nicht zu beurteilen, weil das Rauschen mit der Abweichung zusammen geschätzt ist",
  ", and on the (\\d+) of (\\d+) that lie between fitted runs by (.+?) where interpolation has ([\\d.,−-]+ (?:N m|mm|m|kN|N))":
    ", und bei den $1 von $2 zwischen angepassten Fahrten: $3, wo Interpolation $4 hat",
  ", and on (\\d+) of (\\d+) by (.+?) where interpolation has ([\\d.,−-]+ (?:N m|mm|m|kN|N))":
    ", und bei $1 von $2: $3, wo Interpolation $4 hat",
  ", where interpolation between the fitted runs has ([\\d.,−-]+ (?:N m|mm|m|kN|N))":
    ", wo Interpolation zwischen den angepassten Fahrten $1 hat",
  " is off by ": ": Fehler ",
  " on held-out runs": " bei zurückgehaltenen Fahrten",
  " on fitted runs": " bei angepassten Fahrten",
  "([\\d.]+) times the noise": "das $1-Fache des Rauschens",
  ", likewise": ", ebenso",
  "most at a slip angle of ([\\d.−-]+) deg": "am meisten bei einem Schräglaufwinkel von $1°",
  "most at a load of ([\\d.]+)": "am meisten bei einer Last von $1",
  "most at a (?:sled )?speed of ([\\d.]+)": "am meisten bei einer Geschwindigkeit von $1",
  "most at a rim speed of ([\\d.]+)": "am meisten bei einer Umfangsgeschwindigkeit von $1",
  "most at (?:a )?slip (?:of )?([\\d.−-]+)": "am meisten bei Schlupf $1",
  ", beyond the fitted ones": ", jenseits der angepassten",
  ", (over|under)-predicted there": ", dort $1-predicted",
  "over-predicted at low slip and under-predicted at high slip":
    "bei kleinem Schlupf zu hoch und bei großem zu niedrig berechnet",
  "over-predicted at low (wheel load|sled speed|rim speed) and under-predicted at high \\1":
    "bei kleiner $1 zu hoch und bei großer zu niedrig berechnet",
  "under-predicted at low slip and over-predicted at high slip":
    "bei kleinem Schlupf zu niedrig und bei großem zu hoch berechnet",
  "under-predicted at low (wheel load|sled speed|rim speed) and over-predicted at high \\1":
    "bei kleiner $1 zu niedrig und bei großer zu hoch berechnet",
  "over-predicted in (?:every run|all runs)": "in jeder Fahrt zu hoch berechnet",
  "under-predicted in (?:every run|all runs)": "in jeder Fahrt zu niedrig berechnet",
  "over-predicted": "zu hoch berechnet",
  "under-predicted": "zu niedrig berechnet",
  // These phrases say what is missing.
  "this model was not searched": "dieses Modell wurde nicht durchsucht",
  " was missing \\((P [^)]+)\\) and is added": " fehlte ($1) und ist hinzugefügt",
  " \\((P [^)]+)\\) is added": " ($1) ist hinzugefügt",
  " was added by hand": " wurde von Hand hinzugefügt",
  ": held-out error unchanged, das ([\\d.]+)-Fache des Rauschens":
    ": der Fehler zurückgehaltener Fahrten bleibt beim $1-Fachen des Rauschens",
  ": held-out error from ([\\d.]+) to das ([\\d.]+)-Fache des Rauschens":
    ": Fehler zurückgehaltener Fahrten vom $1- auf das $2-Fache des Rauschens",
  "named, but the error on unseen runs is das": "benannt, aber der Fehler bei ungesehenen Fahrten ist das",
  " in place of (\\S+) cannot be excluded": " an Stelle von $1 ist nicht auszuschließen",
  " in the place of ": " an Stelle von ",
  "nothing detectable with these data: no effect of the library beats (.+?) by more than ([\\d.]+) nats":
    "mit diesen Daten ist nichts nachweisbar: kein Effekt der Bibliothek ist um mehr als $2 Nat besser als $1",
  "nothing further is detectable": "weiter ist nichts nachweisbar",
  "less probable: ": "weniger wahrscheinlich: ",
  "a law outside the library": "ein Gesetz außerhalb der Bibliothek",
  "not judged for want of data on the rig: 1 effect$": "ohne Angaben zum Prüfstand nicht beurteilt: 1 Effekt",
  "not judged for want of data on the rig: (\\d+) effects?": "ohne Angaben zum Prüfstand nicht beurteilt: $1 Effekte",
  "not judged for want of data on the rig: ": "ohne Angaben zum Prüfstand nicht beurteilt: ",
  "not judged: (\\d+) effects?, of whose cause this model shows nothing":
    "nicht beurteilt: $1 Effekte, deren Ursache dieses Modell nicht abbildet",
  "these data cannot distinguish them": "diese Daten können sie nicht unterscheiden",
  ": the prior is wrong, or an effect is missing": ": der Prior ist falsch, oder ein Effekt fehlt",
  " is missing: ": " fehlt: ",
  " is missing": " fehlt",
  "\\(probability ([>\\d. ]+), ([\\d.]+) nats over (.+?)(; most probably with [^)]+)?\\)":
    "(Wahrscheinlichkeit $1, $2 Nat über $3$4)",
  "; most probably with ": "; am wahrscheinlichsten mit ",
  "the best fit \\((.+?)\\) puts (\\S+) ([\\d.]+) sds of its prior above the middle, so ":
    "die beste Anpassung ($1) setzt $2 um $3 Standardabweichungen seines Priors über die Mitte; darum ",
  "the best fit \\((.+?)\\) puts (\\S+) ([\\d.]+) sds of its prior below the middle, so ":
    "die beste Anpassung ($1) setzt $2 um $3 Standardabweichungen seines Priors unter die Mitte; darum ",
  "the effect is not named: something else may act that it imitates":
    "wird der Effekt nicht benannt: es mag etwas anderes wirken, das er nachahmt",
  "the probabilities tell little; widen that prior and search again":
    "sagen die Wahrscheinlichkeiten wenig; weiten Sie diesen Prior und suchen Sie erneut",
  "if you expect such a strength, state a wider prior under \\[discovery\\.priors\\]":
    "wenn Sie eine solche Stärke erwarten, geben Sie unter [discovery.priors] einen weiteren Prior an",
  "what remains is largest in (drawbar pull|torque|sinkage|lateral force) \\(([\\d.]+) noise sds over (\\d+) values; measured less predicted (falls|rises) with (wheel load|slip|sled speed|slip angle)\\)":
    "der Rest ist am größten: $1 ($2 Standardabweichungen des Rauschens über $3 Werte; gemessen minus berechnet $4 mit $5)",
  "what remains is largest in (drawbar pull|torque|sinkage|lateral force) \\(([\\d.]+) noise sds over (\\d+) values\\)":
    "der Rest ist am größten: $1 ($2 Standardabweichungen des Rauschens über $3 Werte)",
  "undecided": "unentschieden",
  // What to do next.
  "predict with the posterior: its errors are within the noise":
    "mit dem Posterior vorhersagen: seine Fehler liegen im Rauschen",
  "predict with the posterior: the model explains the runs to within the noise":
    "mit dem Posterior vorhersagen: das Modell erklärt die Fahrten bis auf das Rauschen",
  "predict with the posterior, within the errors above: these data show no more":
    "mit dem Posterior vorhersagen, innerhalb der obigen Fehler: mehr zeigen diese Daten nicht",
  "^add (\\S+) on wheel (\\S+) and calibrate again": "$1 am Rad $2 hinzufügen und neu kalibrieren",
  "^add (\\S+) and calibrate again": "$1 hinzufügen und neu kalibrieren",
  "^try (\\S+) and calibrate again": "$1 versuchen und neu kalibrieren",
  "^(?:add|try) the law that was found, (\\S+), and calibrate again":
    "das gefundene Gesetz $1 hinzufügen und neu kalibrieren",
  "widen the prior of (\\S+) in the job \\(one from a posterior by a larger transfer\\), and calibrate and search again":
    "den Prior von $1 im Job weiten (einen aus einem Posterior durch größeres transfer), neu kalibrieren und suchen",
  ", which tells the (\\d+) open explanations apart, and add the rows":
    "; das unterscheidet die $1 offenen Erklärungen; dann die Zeilen hinzufügen",
  ", which tells (.+?) apart, and add the rows": "; das unterscheidet $1; dann die Zeilen hinzufügen",
  ", which tells (.+?) apart, and add the row to calibration (\\d+), which is then searched again":
    "; das unterscheidet $1; dann die Zeile zu Kalibrierung $2 hinzufügen, die danach erneut durchsucht wird",
  "run the wheel at ": "das Rad fahren bei ",
  "slip ([\\d.−-]+) under ([\\d.]+) N at ([\\d.]+) mm/s": "Schlupf $1 unter $2 N mit $3 mm/s",
  " would tell": " würde es entscheiden",
  ", then ": ", dann ",
  "^state ": "angeben: ",
  "the density of soil (\\S+?)(?=[,: ]| and |$)": "die Dichte des Bodens $1",
  "the grousers of wheel (\\S+) \\(none for a smooth rim\\)": "die Stollen des Rades $1 (keine bei glattem Umfang)",
  "the length of the bin": "die Länge der Rinne",
  ": the search then judges 1 further effect$": "; die Suche beurteilt dann 1 weiteren Effekt",
  ": the search then judges (\\d+) further effects?": "; die Suche beurteilt dann $1 weitere Effekte",
  "^measure (.+): they would show 1 further effect$": "messen: $1; das würde 1 weiteren Effekt zeigen",
  "^measure (.+): they would show (\\d+) further effects": "messen: $1; das würde $2 weitere Effekte zeigen",
  "they would show ": "sie würden zeigen: ",
  "in the experiment: ": "im Experiment: ",
  "; then the search judges ": "; dann beurteilt die Suche ",
  "make a ring-shear test in the same soil: friction angle, cohesion and the displacement that mobilises them":
    "einen Ringscherversuch im selben Boden machen: Reibungswinkel, Kohäsion und der Weg, der sie aufbaut",
  "its result goes under ": "das Ergebnis gehört unter ",
  "\\(grouser_count = 0: a smooth rim\\)": "(grouser_count = 0: glatter Umfang)",
  " under (?=\\[)": " unter ",
  // The diagnosis.
  "the (\\d+) residuals are ([\\d.]+) times as large as expected from the assumed errors \\(chi-square (\\S+) with ([\\d.]+) degrees of freedom, (p [=<] [^)]+)\\)":
    "die $1 Abweichungen sind das $2-Fache dessen, was die angenommenen Fehler erwarten lassen (Chi-Quadrat $3 bei $4 Freiheitsgraden, $5)",
  ": slightly more than the assumed errors explain": ": etwas mehr, als die angenommenen Fehler erklären",
  ": more than the assumed errors explain": ": mehr, als die angenommenen Fehler erklären",
  ": less than expected, the assumed errors may be too large":
    ": weniger als erwartet, die angenommenen Fehler sind vielleicht zu groß",
  ": the assumed errors explain the misfit": ": die angenommenen Fehler erklären die Abweichungen",
  "the data determine (.+?) least: ([\\d.]+) % of its prior standard deviation remains":
    "die Daten bestimmen $1 am wenigsten: $2 % der Standardabweichung des Priors bleiben",
  "the data say almost nothing about (.+?): (\\d+) % of the prior standard deviation remains in their worst combination, (\\d+) % in their best":
    "die Daten sagen fast nichts über $1: in der schlechtesten Kombination bleiben $2 % der Standardabweichung des Priors, in der besten $3 %",
  "drawbar pull and torque show the same trend": "Zugkraft und Drehmoment zeigen denselben Trend",
  "all fitted data: ": "alle angepassten Daten: ",
  "the data contradict the prior as a whole \\(squared distance ([\\d.]+) where ([\\d.]+) is expected, (p [=<] \\S+) among (\\d+) tests?\\)":
    "die Daten widersprechen dem Prior im Ganzen (Abstandsquadrat $1, erwartet $2, $3 unter $4 Prüfungen)",
  "the data pull (\\S+) into the tail of its prior \\((p [=<] \\S+) among (\\d+) tests?\\)":
    "die Daten ziehen $1 an den Rand seines Priors ($2 unter $3 Prüfungen)",
  "interpolation between the fitted measurements predicts (drawbar pull|torque|sinkage|lateral force) better than the model: ([\\d.]+ \\S+(?: m)?) against ([\\d.]+ \\S+(?: m)?) on (\\d+) measurements of held-out runs, where the noise is ([\\d.]+ \\S+(?: m)?): the model misses something that the measurements show":
    "Interpolation zwischen den angepassten Messungen sagt besser voraus als das Modell ($1): $2 statt $3 bei $4 Messungen zurückgehaltener Fahrten, bei einem Rauschen von $5: dem Modell fehlt etwas, das die Messungen zeigen",
  // What the account says of the errors.
  "The sampler reached equilibrium in each of its (\\d+) stages, so its draws represent the posterior":
    "Der Sampler hat in jeder seiner $1 Stufen das Gleichgewicht erreicht; seine Ziehungen stehen für den Posterior",
  "On the (\\d+) fitted runs the calibrated model has a root mean square error of ":
    "Bei den $1 angepassten Fahrten hat das kalibrierte Modell einen quadratisch gemittelten Fehler von ",
  "On the (\\d+) holdout runs, not used in the fit, it is ":
    "Bei den $1 zurückgehaltenen Fahrten, die nicht angepasst wurden, beträgt er ",
  "The 90\\s% predictive intervals contain ": "Die 90-%-Intervalle der Vorhersage enthalten ",
  "(\\d+) of (\\d+) fitted measurements \\((\\d+) to (\\d+) expected\\)":
    "$1 von $2 angepassten Messungen ($3 bis $4 erwartet)",
  "(\\d+) of (\\d+) holdout measurements \\((\\d+) to (\\d+) expected\\)":
    "$1 von $2 zurückgehaltenen Messungen ($3 bis $4 erwartet)",
  "Interpolating the fitted measurements over the conditions that vary, without physics, has an error of ":
    "Interpolation der angepassten Messungen über die Bedingungen, ohne Physik, hat einen Fehler von ",
  "Interpolating the fitted measurements in slip, without physics, has an error of ":
    "Interpolation der angepassten Messungen über den Schlupf, ohne Physik, hat einen Fehler von ",
  " where it applies": ", wo sie möglich ist",
  " \\((\\d+) measurements between the fitted conditions, (\\d+) beyond them\\)":
    " ($1 Messungen zwischen den angepassten Bedingungen, $2 jenseits davon)",
  "; there the model ": "; dort ist das Modell ",
  "does better in ": "besser in ",
  "does worse in ": "schlechter in ",
  "differs by no more than chance in ": "nur durch Zufall verschieden in ",
  " \\(([\\d.]+) times the error\\)": " (das $1-Fache des Fehlers)",
  "The wheels are smooth rims: no grousers are declared": "Die Räder sind glatt: es sind keine Stollen angegeben",
  "([\\d.]+ (?:N m|N|mm)) in (?=drawbar pull|torque|sinkage|lateral force)": "$1 in ",
  // These are names.
  "drawbar pull": "Zugkraft",
  "(?<![\\w.-])torque(?![\\w-]|\\.\\w)": "Drehmoment",
  "(?<![\\w.-])sinkage(?![\\w-]|\\.\\w)": "Einsinkung",
  "lateral force": "Seitenkraft",
  "wheel load": "Radlast",
  "slip angle": "Schräglaufwinkel",
  "sled speed": "Schlittengeschwindigkeit",
  "rim speed": "Umfangsgeschwindigkeit",
  "(?<![\\w.-])slip(?![\\w-]|\\.\\w)": "Schlupf",
  "(?<=berechnet )falls(?= )": "fällt",
  "(?<=berechnet )rises(?= )": "steigt",
  " with (?=[a-z]+_)": " mit ",
  "(?<=[\\w)°]) and (?=[\\w(])": " und ",
};

const COMPILED = Object.entries(PHRASES).map(
  ([phrase, german]) => /** @type {const} */ ([new RegExp(phrase, "g"), german]),
);

/** Names of the columns of runs.csv, and of what an import computes them from. @type {Record<string, string>} */
const NAMES = {
  "run": "Fahrt",
  "wheel": "Rad",
  "soil": "Boden",
  "slip": "Schlupf",
  "pass": "Überfahrt",
  "operator": "Bediener",
  "recording": "Aufzeichnung",
  "order in time": "zeitliche Reihenfolge",
  "soil preparation": "Aufbereitung des Bodens",
  "session (day or mounting)": "Sitzung (Tag oder Einbau)",
  "taring of the sensors": "Nullung der Sensoren",
  "use (fit or holdout)": "Verwendung (angepasst oder zurückgehalten)",
  "rotational speed of the wheel": "Drehzahl des Rades",
  "radius with which the rig converts slip to rim speed":
    "Radius, mit dem der Prüfstand Schlupf in Umfangsgeschwindigkeit umrechnet",
  "sd of the drawbar pull": "Standardabweichung der Zugkraft",
  "sd of the torque": "Standardabweichung des Drehmoments",
  "sd of the sinkage": "Standardabweichung der Einsinkung",
  "sd of the lateral force": "Standardabweichung der Seitenkraft",
};

/** Titles and summaries of the examples. @type {Record<string, string>} */
const EXAMPLES = {
  "A hidden effect": "Ein verborgener Effekt",
  "synthetic tests of a smooth wheel: the model misses one effect, which is found, added and checked on held-out runs":
    "künstliche Versuche mit einem glatten Rad: dem Modell fehlt ein Effekt, der gefunden, hinzugefügt und an zurückgehaltenen Fahrten geprüft wird",
  "Measured sand: calibration": "Gemessener Sand: Kalibrierung",
  "single-wheel tests of a smooth and a grousered wheel by Carnegie Mellon University: one calibration of the base model":
    "Einzelradversuche mit einem glatten und einem Stollenrad der Carnegie Mellon University: eine Kalibrierung des Grundmodells",
  "Measured sand: what is missing": "Gemessener Sand: was fehlt",
  "the same tests: a search for the effect that the model misses, which is added and searched again":
    "dieselben Versuche: eine Suche nach dem Effekt, der dem Modell fehlt; er wird hinzugefügt, und dann wird wieder gesucht",
  "Which of three models": "Welches von drei Modellen",
  "synthetic tests of a smooth wheel: three models are calibrated and compared by evidence and on held-out runs":
    "künstliche Versuche mit einem glatten Rad: drei Modelle werden kalibriert und nach Evidenz und an zurückgehaltenen Fahrten verglichen",
};

/** Words that a sentence in German does not have. */
const ENGLISH = new RegExp(
  "(?<![\\w.[-])(the|is|are|of|and|than|as|does|about|among|a|it|where|that|with|by|runs?|from|has|its|no|not|under|to|which|wheel|model|noise|missing|runs|measure|further|effects?|most|load|other|there|least|larger?)(?!\\w|\\.\\w|\\]|-)",
  "i",
);

/**
 * A sentence of the service in German; null where a phrase of it is not known.
 * @param {string} text
 */
export function germanOf(text) {
  if (Object.hasOwn(NAMES, text)) return NAMES[text];
  if (Object.hasOwn(EXAMPLES, text)) return EXAMPLES[text];
  let sentence = text;
  for (const [english, german] of Object.entries(EFFECTS))
    if (sentence.includes(english)) sentence = sentence.replaceAll(english, german);
  for (const [phrase, german] of COMPILED) sentence = sentence.replace(phrase, german);
  return sentence === text || ENGLISH.test(sentence) ? null : sentence;
}
