// Predictions, and what is chosen and checked before a calibration, in German, by their English form.

/** @type {Record<string, string>} */
export const CALCULATOR = {
  "1.24 × radius": "1,24 × Radius",
  "90 % by the parameters alone: the noise is not known":
    "90 % nur nach den Parametern: das Rauschen ist nicht bekannt",
  "90 % of new measurements": "90 % neuer Messungen",
  "90 % of new measurements, or by the parameters alone": "90 % neuer Messungen, oder nur nach den Parametern",
  "A pilot runs …": "Ein Probelauf rechnet …",
  "A prior says what is known before the runs. job.toml takes other forms, too.":
    "Ein Prior sagt, was vor den Fahrten bekannt ist. job.toml nimmt auch andere Formen.",
  "A statement about a new measurement": "Eine Aussage über eine neue Messung",
  "a smooth rim in steady motion: pressure by sinkage, shear by friction; seconds":
    "ein glatter Radkranz in gleichförmiger Bewegung: Druck aus der Einsinkung, Schub aus Reibung; Sekunden",
  "a smooth rim whose pressure peaks ahead of the axle, shear by displacement; seconds":
    "ein glatter Radkranz, dessen Druck vor der Achse am größten ist, Schub aus dem Weg; Sekunden",
  "a wheel with its grousers that rolls over soil and deforms it; a thousand times slower: the most probable parameters alone":
    "ein Rad mit seinen Stollen, das über Boden rollt und ihn verformt; tausendmal langsamer: nur die wahrscheinlichsten Parameter",
  "about {0} %": "etwa {0} %",
  "above or below": "über oder unter",
  "About {0} evaluations of {1} simulations each: {2} on one core, {3} on the {4} cores of the service":
    "Etwa {0} Auswertungen zu je {1} Simulationen: {2} auf einem Kern, {3} auf den {4} Kernen des Dienstes",
  "angle of internal friction [°]": "Winkel der inneren Reibung [°]",
  "As proposed": "Wie vorgeschlagen",
  "at slip {0}": "bei Schlupf {0}",
  "between … and …": "zwischen … und …",
  "between … and …, even in the logarithm": "zwischen … und …, gleichmäßig im Logarithmus",
  "beyond the fitted slips": "außerhalb des angepassten Schlupfs",
  "Beyond the fitted range in {0}: nothing tells whether the model still holds there.":
    "Außerhalb des angepassten Bereichs bei {0}: nichts sagt, ob das Modell dort noch gilt.",
  "by the parameters alone: the noise is not known": "nur nach den Parametern: das Rauschen ist nicht bekannt",
  "Check, with its cost": "Prüfen, mit den Kosten",
  "choose a model": "wählen Sie ein Modell",
  "chosen slip: {0} {1}": "gewählter Schlupf: {0} {1}",
  "Computed at this condition with {0} draws.": "Bei dieser Bedingung gerechnet, mit {0} Ziehungen.",
  "Effects from the start: none; the search tries all of them": "Effekte von Anfang an: keine; die Suche probiert alle",
  "Effects from the start: {0}": "Effekte von Anfang an: {0}",
  "Effects of the catalogue": "Effekte des Katalogs",
  "energy for a metre": "Energie für einen Meter",
  "exponent of the sinkage in the pressure": "Exponent der Einsinkung im Druck",
  "fixed at …": "fest bei …",
  "form of the prior of {0}": "Form des Priors von {0}",
  "Good to know": "Gut zu wissen",
  "greatest": "größter Wert",
  "How probable is {0}": "Wie wahrscheinlich ist {0}",
  "Interpolated between computed conditions; it is computed when the sliders rest.":
    "Zwischen gerechneten Bedingungen interpoliert; gerechnet wird, wenn die Regler ruhen.",
  "is being computed …": "wird gerechnet …",
  "It is computed when it is first asked for, beside the calibrations at work, and kept then.":
    "Es wird bei der ersten Frage gerechnet, neben den laufenden Kalibrierungen, und dann behalten.",
  "k_c / (k_phi 30 mm); one wheel cannot tell k_c from k_phi":
    "k_c / (k_phi 30 mm); ein Rad allein trennt k_c nicht von k_phi",
  "least": "kleinster Wert",
  "limit": "Grenze",
  "log10 of the pressure [Pa] at 10 mm under a plate of 30 mm radius":
    "log10 des Drucks [Pa] bei 10 mm unter einer Platte von 30 mm Radius",
  "mean": "Mittel",
  "mean … and sd …": "Mittel … und Standardabweichung …",
  "measured near this condition": "nahe dieser Bedingung gemessen",
  "Models: several are compared by their evidence": "Modelle: mehrere werden nach ihrer Evidenz verglichen",
  "More than {0} evaluations of {1} simulations each: more than {2} on one core, {3} on the {4} cores of the service":
    "Mehr als {0} Auswertungen zu je {1} Simulationen: mehr als {2} auf einem Kern, {3} auf den {4} Kernen des Dienstes",
  "no text that a calibration reads": "kein Text, den eine Kalibrierung liest",
  "No wheel run is fitted, so that nothing tells what a wheel would do.":
    "Keine Fahrt eines Rades ist angepasst; darum sagt nichts, was ein Rad tun würde.",
  "number {0} of the prior of {1}": "Zahl {0} des Priors von {1}",
  "parameters alone": "nur nach den Parametern",
  "power number": "Leistungszahl",
  "Predict": "Vorhersage",
  "Predict here": "Hier vorhersagen",
  "Predicted {0} by slip": "Vorhersage über dem Schlupf: {0}",
  "Predictions at the chosen condition": "Vorhersagen bei der gewählten Bedingung",
  "prior of {0}": "Prior von {0}",
  "prior of {0}: two numbers above 0, the smaller first": "Prior von {0}: zwei Zahlen über 0, die kleinere zuerst",
  "prior of {0}: two numbers, the smaller first, or a mean and an sd above 0, or one number":
    "Prior von {0}: zwei Zahlen, die kleinere zuerst, oder Mittel und Standardabweichung über 0, oder eine Zahl",
  "Priors": "Priors",
  "Priors of {0} parameters": "Priors von {0} Parametern",
  "Priors: those of dry sands": "Priors: die trockener Sande",
  "pull over load": "Zugkraft durch Last",
  "Quantity": "Größe",
  "radius [m] of the rim with the soil that it carries along":
    "Radius [m] des Radkranzes mit dem Boden, den er mitnimmt",
  "resistive force theory of dry sand, with the grousers; seconds":
    "Theorie der Widerstandskräfte in trockenem Sand, mit den Stollen; Sekunden",
  "slope that the pull balances": "Steigung, die die Zugkraft trägt",
  "speed of the rim": "Umfangsgeschwindigkeit",
  "stiffness of the sand [Pa/m]": "Steifigkeit des Sandes [Pa/m]",
  "that a new measurement says so": "dass eine neue Messung es so zeigt",
  "The cost is not known: {0}.": "Die Kosten sind nicht bekannt: {0}.",
  "the measured runs": "die gemessenen Fahrten",
  "The model refuses every slip from {0} at {1}: {2}. Move the sliders, or choose another model.":
    "Das Modell lehnt jeden Schlupf von {0} bei {1} ab: {2}. Verschieben Sie die Regler, oder wählen Sie ein anderes Modell.",
  "The model refuses slip {0} at {1}: {2}.": "Das Modell lehnt den Schlupf {0} bei {1} ab: {2}.",
  "The model rejected {0} % of its parameter vectors.": "Das Modell hat {0} % der Parametervektoren abgelehnt.",
  "The program computes the curves …": "Das Programm rechnet die Kurven …",
  "The search that may follow is not in it.": "Die Suche, die folgen kann, ist nicht enthalten.",
  "tractive efficiency": "Zugwirkungsgrad",
  "What the calibrated models predict for a condition that nobody measured: mean and 90 % of new measurements (by the parameters alone where the noise is not known), over all models of the study by their evidence. Straight travel on level ground.":
    "Was die kalibrierten Modelle für eine Bedingung vorhersagen, die niemand gemessen hat: Mittel und 90 % neuer Messungen (nur nach den Parametern, wo das Rauschen nicht bekannt ist), über alle Modelle der Studie nach ihrer Evidenz. Geradeausfahrt auf ebenem Boden.",
  "What the job will do": "Was der Job tun wird",
  "Wheel": "Rad",
  "Whole": "Ganzes",
  "wheels {0}": "Räder {0}",
  "Within the fitted range.": "Innerhalb des angepassten Bereichs.",
  "{0} (at {1} of {2} draws)": "{0} (bei {1} von {2} Ziehungen)",
  "{0} fitted runs with {1} measurements, {2} held out": "{0} angepasste Fahrten mit {1} Messungen, {2} zurückgehalten",
  "A prediction of this model takes minutes: the page of the service makes it.":
    "Eine Vorhersage dieses Modells dauert Minuten: Die Seite des Dienstes macht sie.",
  "Interpolated between conditions that were computed with {0} draws.":
    "Zwischen Bedingungen interpoliert, die mit {0} Ziehungen gerechnet sind.",
  "the predictions": "die Vorhersagen",
  "The model refuses this load or speed, or one beside it.":
    "Das Modell lehnt diese Last oder Geschwindigkeit ab, oder eine daneben.",
  "This model takes minutes for a prediction.": "Dieses Modell braucht Minuten für eine Vorhersage.",
  "This report has no predictions of this model.": "Dieser Bericht hat keine Vorhersagen dieses Modells.",
  "A German Excel file": "Eine deutsche Excel-Datei",
  "a table as a rig keeps it, in per cent, kN and mm with decimal commas: its import;":
    "eine Tabelle, wie ein Prüfstand sie führt, in Prozent, kN und mm mit Dezimalkommas: ihr Import;",
  "save the file": "die Datei speichern",
};
