// Sentences of the page in German, by their English form.

/** @type {Record<string, string>} */
export const SENTENCES = {
  " Add calibrates a further model with the effect; this one stays as it is, and what was added can be taken back.":
    " Hinzufügen kalibriert ein weiteres Modell mit dem Effekt; dieses bleibt, wie es ist, und was hinzugefügt wurde, lässt sich zurücknehmen.",
  " An estimate below 0 is 0 within its error, and is drawn as 0.":
    " Eine Schätzung unter 0 ist innerhalb ihres Fehlers 0 und wird als 0 gezeichnet.",
  "(job.toml, experiment.toml, runs.csv), or a table of measurements alone, or":
    "(job.toml, experiment.toml, runs.csv), oder nur eine Tabelle von Messungen, oder",
  ", most of them in one region ({0} by chance)": ", die meisten in einem Gebiet ({0} durch Zufall)",
  ". It stays in this browser and is sent to this service alone.":
    ". Es bleibt in diesem Browser und wird nur an diesen Dienst gesendet.",
  "0 nats within the error of the estimate, {0}": "0 Nat innerhalb des Fehlers der Schätzung, {0}",
  "A fit goes from step to step and has no stages; its result is in the other views.":
    "Eine Anpassung geht von Schritt zu Schritt und hat keine Stufen; ihr Ergebnis steht in den anderen Ansichten.",
  "A fit goes from step to step; its result comes with its end.":
    "Eine Anpassung geht von Schritt zu Schritt; ihr Ergebnis kommt an ihrem Ende.",
  "A fit has a point and no draws: there is no density to draw.":
    "Eine Anpassung hat einen Punkt und keine Ziehungen: es gibt keine Dichte zu zeichnen.",
  "a job file (job.toml): it names the model, the priors and the sampler":
    "eine Jobdatei (job.toml): sie nennt Modell, Priors und Sampler",
  "A line breaks where the runs changed: errors over different runs do not compare.":
    "Eine Linie bricht ab, wo sich die Fahrten geändert haben: Fehler über verschiedene Fahrten sind nicht vergleichbar.",
  "A search fits each candidate effect; its result is in the view Missing effect.":
    "Eine Suche passt jeden möglichen Effekt an; ihr Ergebnis steht unter „Was fehlt“.",
  "a stage did not reach equilibrium: allow more moves":
    "eine Stufe hat das Gleichgewicht nicht erreicht: erlauben Sie mehr Schritte",
  "A study calibrates a wheel–soil model against the runs of a test rig, shows where the model fails and says which effect it misses.":
    "Eine Studie kalibriert ein Rad-Boden-Modell an den Fahrten eines Prüfstands, zeigt, wo das Modell versagt, und sagt, welcher Effekt ihm fehlt.",
  "a table in other columns than runs.csv has": "eine Tabelle mit anderen Spalten als runs.csv",
  "All may stay blank. Some effects need the density or the length of the bin; runs are proposed within the limits.":
    "Alles darf leer bleiben. Manche Effekte brauchen die Dichte oder die Länge der Rinne; Fahrten werden innerhalb der Grenzen vorgeschlagen.",
  "Among what is fitted so far; the end weighs classes and laws as well.":
    "Unter dem, was bisher angepasst ist; am Ende werden auch Klassen und Gesetze gewogen.",
  "an effect is missing that the library does not have": "ein Effekt fehlt, den die Bibliothek nicht hat",
  "and whatever they name. A table of measurements alone is enough, too: text, .xlsx, .ods or .mat.":
    "und alles, was sie nennen. Eine Tabelle von Messungen allein genügt auch: Text, .xlsx, .ods oder .mat.",
  "Beyond the draws: the dashed curves extrapolate. {0}":
    "Jenseits der Ziehungen: die gestrichelten Kurven extrapolieren. {0}",
  "Cancel for good? Its stages so far stay, and it cannot go on.":
    "Endgültig abbrechen? Die bisherigen Stufen bleiben, und sie kann nicht fortgesetzt werden.",
  "fits formulas of a law outside the library": "passt Formeln eines Gesetzes außerhalb der Bibliothek an",
  "Weighed with an assumed value, and therefore never named":
    "Mit einem angenommenen Wert gewogen, und darum nie benannt",
  "Cannot be judged, as the experiment is described": "Nicht zu beurteilen, wie das Experiment beschrieben ist",
  "Choose for each quantity the column of {0} and its unit. Blank fields stay unmeasured.":
    "Wählen Sie für jede Größe die Spalte von {0} und ihre Einheit. Leere Felder bleiben ungemessen.",
  "Commands run in the folder of this report.": "Befehle laufen im Ordner dieses Berichts.",
  "Contraction: 1 less the sd after the fit over that before; 0: the data tell nothing. Prior conflict: probability of a posterior so far out if the prior is right.":
    "Verengung: 1 minus Standardabweichung nach der Anpassung durch die davor; 0: die Daten sagen nichts. Widerspruch zum Prior: Wahrscheinlichkeit eines so weit entfernten Posteriors, wenn der Prior stimmt.",
  "Delete {0} with all its results, for good?": "{0} mit allen Ergebnissen endgültig löschen?",
  "Do the assumed errors explain the residuals?": "Erklären die angenommenen Fehler die Abweichungen?",
  "Does it predict runs that it has not seen?": "Sagt es Fahrten voraus, die es nicht gesehen hat?",
  "Does it predict runs that it has not seen? No run was held out.":
    "Sagt es Fahrten voraus, die es nicht gesehen hat? Keine Fahrt wurde zurückgehalten.",
  "dotted line: reference value, where one was measured": "gepunktet: Referenzwert, wo einer gemessen wurde",
  "each stage reached equilibrium: the draws represent the posterior":
    "jede Stufe hat das Gleichgewicht erreicht: die Ziehungen stehen für den Posterior",
  "Error sd: noise, discrepancy and shared errors together. Information: the prior's spread of a prediction over it; below 1 a row tells less than the prior.":
    "Fehler-Std.: Rauschen, Diskrepanz und gemeinsame Fehler zusammen. Information: die Streuung einer Vorhersage nach dem Prior durch sie; unter 1 sagt eine Zeile weniger als der Prior.",
  "Errors are of the held-out runs, which are never fitted":
    "Die Fehler sind die der zurückgehaltenen Fahrten, die nie angepasst werden",
  "Errors are root mean squares of prediction minus measurement of the current model; 1 × noise is as good as the measurements allow.":
    "Fehler sind quadratische Mittel von Vorhersage minus Messung des aktuellen Modells; 1 × Rauschen ist so gut, wie die Messungen erlauben.",
  "exchanges effects that the data hardly tell apart": "tauscht Effekte, die die Daten kaum unterscheiden",
  "From repeats of a condition alone, without a model of the contact.":
    "Nur aus Wiederholungen einer Bedingung, ohne ein Modell des Kontakts.",
  "grey: the first stage, close to the prior": "grau: die erste Stufe, nahe am Prior",
  "Held-out runs are never fitted: they show how well the model predicts. An excluded run stays in the file as a comment with its reason.":
    "Zurückgehaltene Fahrten werden nie angepasst: sie zeigen, wie gut das Modell vorhersagt. Eine ausgeschlossene Fahrt bleibt mit ihrem Grund als Kommentar in der Datei.",
  "In brackets: at the posterior mean. Error of the curves: from the model, at draws that are left out of the fit.":
    "In Klammern: beim Mittel des Posteriors. Fehler der Kurven: gegen das Modell, an Ziehungen, die bei der Anpassung ausgelassen wurden.",
  "Information of a run at a rim speed of {0}": "Information einer Fahrt bei einer Umfangsgeschwindigkeit von {0}",
  "It refused {0} of {1} draws from the prior{2}.": "Es hat {0} von {1} Ziehungen aus dem Prior abgelehnt{2}.",
  "leaves out effects of the best combinations": "lässt Effekte der besten Verbindungen aus",
  "limits of {0}: two numbers, the smaller first": "Grenzen von {0}: zwei Zahlen, die kleinere zuerst",
  "Mahalanobis distance {0} from the posterior mean; 99 % of the draws lie within {1}.":
    "Mahalanobis-Abstand {0} vom Mittel des Posteriors; 99 % der Ziehungen liegen innerhalb von {1}.",
  "Measured less computed; the grey band is one sd, the mean over the runs, of all errors that the calibration assumes or infers: noise, scatter of the soil and discrepancy, as in the diagnosis.":
    "Gemessen minus berechnet; das graue Band ist eine Standardabweichung, im Mittel über die Fahrten, aller Fehler, die die Kalibrierung annimmt oder schätzt: Rauschen, Streuung des Bodens und Diskrepanz, wie in der Diagnose.",
  "Measured less computed; the grey band is one sd, the mean over the runs, of the noise alone.":
    "Gemessen minus berechnet; das graue Band ist eine Standardabweichung des Rauschens allein, im Mittel über die Fahrten.",
  "The line is the trend that the diagnosis tests, where it is beyond chance (p below 0.01 among all tests).":
    "Die Linie ist der Trend, den die Diagnose prüft, wo er über Zufall hinausgeht (p unter 0,01 unter allen Prüfungen).",
  "Errors that residuals count in": "Fehler, in denen Abweichungen zählen",
  "all errors": "alle Fehler",
  "the noise alone": "das Rauschen allein",
  "No calibration of this study is finished yet.": "Noch ist keine Kalibrierung dieser Studie fertig.",
  "No run within reach of the rig would change these probabilities by much.":
    "Keine Fahrt in Reichweite des Prüfstands würde diese Wahrscheinlichkeiten viel ändern.",
  "No runs are held out: errors are of each condition, predicted from the others by weighting the draws, exact enough to rank models alone":
    "Keine Fahrten sind zurückgehalten: die Fehler sind die jeder Bedingung, aus den anderen vorhergesagt durch Gewichtung der Ziehungen, genau genug nur für eine Rangfolge",
  "No worker computes for this service. Start one on any machine that reaches it:":
    "Kein Rechner arbeitet für diesen Dienst. Starten Sie einen auf einer Maschine, die ihn erreicht:",
  "No worker computes for this service: start one.": "Kein Rechner arbeitet für diesen Dienst: starten Sie einen.",
  "Nobody has asked yet what this model is missing.": "Noch hat niemand gefragt, was diesem Modell fehlt.",
  "not in {0}: something is missing, or the noise is understated":
    "nicht in {0}: etwas fehlt, oder das Rauschen ist zu klein angegeben",
  "Nothing is finished yet: the story begins with the first calibration.":
    "Noch ist nichts fertig: das Ergebnis beginnt mit der ersten Kalibrierung.",
  "nothing is missing that these data can show": "nichts fehlt, was diese Daten zeigen können",
  "Of the current models. Errors are root mean squares. Parameters: mean ± sd of the posterior; the difference is over the larger of the two sds.":
    "Von den aktuellen Modellen. Fehler sind quadratische Mittel. Parameter: Mittel ± Standardabweichung des Posteriors; der Unterschied ist durch die größere der beiden Standardabweichungen geteilt.",
  "one of {0} effects is missing, and the data do not tell which":
    "einer von {0} Effekten fehlt, und die Daten sagen nicht, welcher",
  "one soil: runs.csv has {0}, and an experiment has one": "ein Boden: runs.csv hat {0}, und ein Experiment hat einen",
  "One worker computed all {0} results, so that none was compared with another's.":
    "Ein Rechner hat alle {0} Ergebnisse gerechnet, darum wurde keines mit dem eines anderen verglichen.",
  "Point at an explanation: its predictions appear over the data before anything is computed; a click on its name keeps them.":
    "Zeigen Sie auf eine Erklärung: ihre Vorhersagen erscheinen über den Daten, bevor etwas gerechnet wird; ein Klick auf den Namen hält sie fest.",
  "Probabilities are among all laws outside of the library. Those listed have at least 95 % together.":
    "Die Wahrscheinlichkeiten gelten unter allen Gesetzen außerhalb der Bibliothek. Die aufgeführten haben zusammen mindestens 95 %.",
  "Probabilities compare these {0} models alone, from equal prior odds. {1}. Noise sds: error over the noise; a model that is right has about 1. p of chi-square: how often noise alone leaves so large residuals of the fitted runs; if that of the most probable model is below 0.01, the answer is “none of these”.":
    "Die Wahrscheinlichkeiten vergleichen nur diese {0} Modelle, von gleichen Prior-Chancen aus. {1}. × Rauschen: Fehler durch Rauschen; ein richtiges Modell hat etwa 1. p von Chi-Quadrat: wie oft Rauschen allein so große Abweichungen der angepassten Fahrten lässt; liegt es beim wahrscheinlichsten Modell unter 0,01, ist die Antwort „keines von diesen“.",
  "regions of {0} % of the posterior; rank correlation {1}": "Gebiete von {0} % des Posteriors; Rangkorrelation {1}",
  "Residuals of every run and channel, in sds of the noise alone":
    "Abweichungen jeder Fahrt und jedes Kanals, in Standardabweichungen des Rauschens allein",
  "Residuals of every run and channel, in sds of noise, scatter of the soil and discrepancy":
    "Abweichungen jeder Fahrt und jedes Kanals, in Standardabweichungen von Rauschen, Streuung des Bodens und Diskrepanz",
  "Root mean square errors in the unit of each channel. Held-out runs are never fitted.":
    "Quadratische Mittel der Fehler in der Einheit jedes Kanals. Zurückgehaltene Fahrten werden nie angepasst.",
  "Runs: {0} fitted, {1} held out, {2} excluded": "Fahrten: {0} angepasst, {1} zurückgehalten, {2} ausgeschlossen",
  "search for a missing effect and report it": "einen fehlenden Effekt suchen und melden",
  "Signs are measurements (hollow: held out, never fitted), lines the mean of the posterior at the measured conditions, bands its 90 % interval of a measurement; between conditions they bend smoothly, without being computed. Point at a run, or drag over a region: it lights up in every picture.":
    "Zeichen sind Messungen (hohl: zurückgehalten, nie angepasst), Linien das Mittel des Posteriors bei den gemessenen Bedingungen, Bänder sein 90-%-Intervall einer Messung; zwischen den Bedingungen laufen sie glatt, ohne berechnet zu sein. Zeigen Sie auf eine Fahrt oder ziehen Sie über einen Bereich: sie leuchtet in jedem Bild auf.",
  "Strong lines: the model at the setting of the sliders. Faint lines and bands: the mean of the posterior and its 90 % interval of a measurement. A slider spans the central 99 % of the draws of its parameter. The lines come from a {0} polynomial for each run and channel, fitted to {1} draws of the posterior with their outputs.":
    "Kräftige Linien: das Modell bei der Stellung der Regler. Blasse Linien und Bänder: das Mittel des Posteriors und sein 90-%-Intervall einer Messung. Ein Regler umfasst die mittleren 99 % der Ziehungen seines Parameters. Die Linien sind ein Polynom ({0}) für jede Fahrt und jeden Kanal, angepasst an {1} Ziehungen des Posteriors mit ihren Ausgaben.",
  "tests a law on conditions that are left out": "prüft ein Gesetz an ausgelassenen Bedingungen",
  "tests the leading explanations on conditions that are left out":
    "prüft die führenden Erklärungen an ausgelassenen Bedingungen",
  "Tests without a rolling wheel that would tell": "Versuche ohne rollendes Rad, die entscheiden würden",
  "The calibration ended before its first stage.": "Die Kalibrierung endete vor ihrer ersten Stufe.",
  "The calibration has too few draws with outputs for a response surface.":
    "Die Kalibrierung hat zu wenige Ziehungen mit Ausgaben für eine Antwortfläche.",
  "The first stage draws from the prior; pictures come with its end.":
    "Die erste Stufe zieht aus dem Prior; Bilder kommen an ihrem Ende.",
  "the end cannot be estimated yet": "das Ende lässt sich noch nicht abschätzen",
  "the fitted runs are within the noise; hold some out to know":
    "die angepassten Fahrten liegen im Rauschen; halten Sie einige zurück, um es zu wissen",
  "The ledger has a line for each finished calibration with a posterior; none is finished yet.":
    "Das Fehlerbuch hat eine Zeile für jede fertige Kalibrierung mit Posterior; noch ist keine fertig.",
  "The model accepted every draw from the prior ({0}).": "Das Modell hat jede Ziehung aus dem Prior angenommen ({0}).",
  "the model explains the runs to within the noise": "das Modell erklärt die Fahrten bis auf das Rauschen",
  "the model was not searched for a missing effect": "nach einem fehlenden Effekt wurde nicht gesucht",
  "The noise is the standard deviation of one measurement. Where the field is blank, it is inferred with the model; a misfit then counts as noise.":
    "Das Rauschen ist die Standardabweichung einer Messung. Wo das Feld leer ist, wird es mit dem Modell geschätzt; eine Abweichung zählt dann als Rauschen.",
  "the others follow, as they do among the draws": "die anderen folgen, wie unter den Ziehungen",
  "The program is at work on {0}; the numbers appear here as they come.":
    "Das Programm arbeitet an {0}; die Zahlen erscheinen hier, sobald sie kommen.",
  "The result is a function of job, seed and model version alone: the same three give the same numbers, bit for bit.":
    "Das Ergebnis hängt nur von Job, Startwert und Modellversion ab: dieselben drei geben dieselben Zahlen, Bit für Bit.",
  "The runs are there. This is what they do not tell; experiment.toml and job.toml are written from it, and you can edit them.":
    "Die Fahrten sind da. Dies sagen sie nicht; experiment.toml und job.toml werden daraus geschrieben, und Sie können sie bearbeiten.",
  "The stronger the colour of a run, the more it tells about which explanation holds (a sure answer to a yes or no is worth {0} nats). Numbers: the runs to make, each chosen given those before it.{1}":
    "Je kräftiger die Farbe einer Fahrt, desto mehr sagt sie darüber, welche Erklärung zutrifft (eine sichere Antwort auf ja oder nein ist {0} Nat wert). Zahlen: die Fahrten, die zu machen sind, jede gewählt nach denen vor ihr.{1}",
  "The study goes on without it, and without what followed from it.":
    "Die Studie geht ohne dies weiter, und ohne was daraus folgte.",
  "These data cannot tell forms of one class apart. Probabilities are among the forms, each of which has the same prior.":
    "Formen einer Klasse können diese Daten nicht unterscheiden. Die Wahrscheinlichkeiten gelten unter den Formen, die alle denselben Prior haben.",
  "these runs are held out already: choose runs that are fitted":
    "diese Fahrten sind schon zurückgehalten: wählen Sie angepasste Fahrten",
  "This model is off by more than the noise: {0}.": "Dieses Modell irrt um mehr als das Rauschen: {0}.",
  "they tell little of {0}: its uncertainty is about that of the prior":
    "sie sagen wenig über {0}: seine Unsicherheit ist etwa die des Priors",
  "they tell little of {0}: their uncertainties are about those of the priors":
    "sie sagen wenig über {0}: ihre Unsicherheiten sind etwa die der Priors",
  "The study is paused before its first calibration has finished.":
    "Die Studie ist angehalten, bevor ihre erste Kalibrierung fertig wurde.",
  "has the button that resumes it.": "hat den Knopf, der sie fortsetzt.",
  "too weak to be seen with these data at usual strength":
    "in üblicher Stärke zu schwach, um in diesen Daten sichtbar zu sein",
  "trend: {0} {1} from one end to the other, before the fit compensates":
    "Trend: {0} {1} von einem Ende zum anderen, bevor die Anpassung ausgleicht",
  "tries effects beside a law outside the library": "versucht Effekte neben einem Gesetz außerhalb der Bibliothek",
  "tries effects in the place of those of the model": "versucht Effekte anstelle derer des Modells",
  "tries the model without each of its effects": "versucht das Modell ohne jeden seiner Effekte",
  "whether something is missing is undecided": "ob etwas fehlt, ist nicht entschieden",
  "Without grousers, leave their fields blank.": "Ohne Stollen bleiben deren Felder leer.",
  "{0} cannot be judged: the noise is inferred with the misfit":
    "{0} nicht zu beurteilen: das Rauschen wird mit der Abweichung geschätzt",
  "{0} depends on {1} ({2}), {3} nats over the model as it is.":
    "{0} hängt von {1} ab ({2}), {3} Nat über dem Modell, wie es ist.",
  "{0} evaluations/s; {1} rejected by the model": "{0} Auswertungen/s; {1} vom Modell abgelehnt",
  "{0} lie at a bound of the prior: look whether it is meant":
    "{0} liegen an einer Grenze des Priors: prüfen Sie, ob das so gemeint ist",
  "{0} lies at a bound of the prior: look whether it is meant":
    "{0} liegt an einer Grenze des Priors: prüfen Sie, ob das so gemeint ist",
  "{0} of models that are no longer the current one": "{0} zu Modellen, die nicht mehr aktuell sind",
  "{0} of wheel {1}: a number greater than 0": "{0} des Rades {1}: eine Zahl größer als 0",
  "{0} sds of all errors, {1} of the noise alone: measured above computed":
    "{0} Standardabweichungen aller Fehler, {1} des Rauschens allein: gemessen über berechnet",
  "{0} sds of all errors, {1} of the noise alone: measured below computed":
    "{0} Standardabweichungen aller Fehler, {1} des Rauschens allein: gemessen unter berechnet",
  "{0} workers computed {1} results; {2} were computed twice and agreed.":
    "{0} Rechner haben {1} Ergebnisse gerechnet; {2} wurden zweimal gerechnet und stimmten überein.",
  "{0}, the experiment of {1}: it describes wheel, soil and noise":
    "{0}, das Experiment von {1}: es beschreibt Rad, Boden und Rauschen",
  "×/÷: the job has the decimal logarithm of the parameter; one sd is this factor.":
    "×/÷: Der Job hat den dekadischen Logarithmus des Parameters; eine Standardabweichung ist dieser Faktor.",
  "The calibration failed, so that there is nothing to show.":
    "Die Kalibrierung ist fehlgeschlagen, deshalb gibt es nichts zu zeigen.",
  "The story": "Das Ergebnis",
  "says why, and what to do.": "sagt, warum, und was zu tun ist.",
  "The study was cancelled before a calibration had finished.":
    "Die Studie wurde abgebrochen, bevor eine Kalibrierung fertig war.",
  "{0}; more is missing": "{0}; es fehlt noch mehr",
  "{0}; what else is missing is undecided": "{0}; was sonst noch fehlt, ist unentschieden",
  "dot above: held out": "Punkt darüber: zurückgehalten",
  "Take back this calibration": "Diese Kalibrierung zurücknehmen",
  "Take back what was added last": "Zuletzt Hinzugefügtes zurücknehmen",
  "Errors, interpolation and intervals, in sentences": "Fehler, Interpolation und Intervalle in Sätzen",
  "What was assumed, and what is doubtful": "Was angenommen wurde, und was zweifelhaft ist",
  "computed at a single condition": "bei einer einzelnen Bedingung berechnet",
  "interpolation and extrapolation, held out: {0} {1}": "Inter- und Extrapolation, zurückgehalten: {0} {1}",
  "no trend of the fitted runs beyond chance": "kein Trend der angepassten Fahrten, der über Zufall hinausgeht",
  "No decision has been asked for.": "Es wurde noch keine Entscheidung angefragt.",
  "only with errors that are inferred from the residuals themselves, up to {0} times the noise: {1}":
    "nur mit Fehlern, die aus den Abweichungen selbst geschätzt sind, bis zum {0}-Fachen des Rauschens: {1}",
  "No decision has been asked for. Name the options, such as two wheels or three ways up a slope, and the loss of each: the answer says which is best, how sure that is, and what one more run is worth. The example below compares climbing a slope with staying.":
    "Es wurde noch keine Entscheidung angefragt. Nennen Sie die Möglichkeiten, etwa zwei Räder oder drei Wege einen Hang hinauf, und den Verlust einer jeden: die Antwort sagt, welche die beste ist, wie sicher das ist und was eine weitere Fahrt wert ist. Das Beispiel unten vergleicht den Aufstieg mit dem Bleiben.",
  ": the dashed curves are what it would predict for the fitted runs, from the search's fit. Nothing has been computed anew.":
    ": die gestrichelten Kurven sind, was es für die angepassten Fahrten vorhersagen würde, nach der Anpassung der Suche. Nichts wurde neu gerechnet.",
  "Nats: log evidence over that of the model as it is. Bold lines: the classes of explanations that have 95 % of the probability together; these data cannot tell the members of a class apart. Half of the prior probability is on “nothing is missing”.{0}":
    "Nat: logarithmische Evidenz über der des Modells, wie es ist. Fette Zeilen: die Klassen von Erklärungen, die zusammen 95 % der Wahrscheinlichkeit haben; die Mitglieder einer Klasse können diese Daten nicht unterscheiden. Die Hälfte der Prior-Wahrscheinlichkeit liegt auf „nichts fehlt“.{0}",
  "Current, corrected: the current model and what it misses at the fitted conditions, interpolated.":
    "Aktuell, korrigiert: das aktuelle Modell und, interpoliert, was ihm bei den angepassten Bedingungen fehlt.",
  "Held-out runs, with their number: in levels, each condition is one that was fitted, though perhaps not together with the others; between levels, a condition lies between fitted ones; beyond, it lies outside of what was fitted, or no fitted run has the wheel or the soil; not steady, the recording shows that the wheel still sinks.":
    "Zurückgehaltene Fahrten mit ihrer Anzahl: auf Stufen, jede Bedingung wurde angepasst, wenn auch vielleicht nicht zusammen mit den anderen; zwischen Stufen, eine Bedingung liegt zwischen angepassten; jenseits, sie liegt außerhalb des Angepassten, oder keine angepasste Fahrt hat das Rad oder den Boden; nicht stationär, nach der Aufzeichnung sinkt das Rad noch ein.",
  "in levels": "auf Stufen",
  "between levels": "zwischen Stufen",
  "beyond": "jenseits",
  "not steady": "nicht stationär",
  "All, combined: the corrected models and the measurements alone together, weighed by how well each predicts left-out levels of the fitted runs.":
    "Alle, kombiniert: die korrigierten Modelle und die Messungen allein zusammen, gewichtet danach, wie gut jedes ausgelassene Stufen der angepassten Fahrten vorhersagt.",
  "Interpolation: the fitted measurements without any model, extrapolated beyond them, on the runs where that is possible.":
    "Interpolation: die angepassten Messungen ohne ein Modell, jenseits davon extrapoliert, bei den Fahrten, wo das möglich ist.",
};
