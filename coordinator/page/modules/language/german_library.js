// The library of laws in German, by its English form.

/** @type {Record<string, string>} */
export const LIBRARY = {
  "{0} is tried by every search from now on": "{0} wird ab jetzt bei jeder Suche geprüft",
  "{0} alike": "{0} gleiche",
  "{0} formulas were fitted to the curve. A row is a class: formulas that differ by less than half the curve's standard deviation, named by the simplest. Other classes together have P {1}.":
    "{0} Formeln wurden an die Kurve angepasst. Eine Zeile ist eine Klasse: Formeln, die sich um weniger als die halbe Standardabweichung der Kurve unterscheiden, benannt nach der einfachsten. Andere Klassen zusammen haben P {1}.",
  "Add this formula": "Diese Formel hinzufügen",
  "Add to the library": "In die Bibliothek aufnehmen",
  "counts": "zählt",
  "alike": "gleiche",
  "beyond the range": "jenseits des Bereichs",
  "Formulas of the law": "Formeln des Gesetzes",
  "Formulas that the curve may follow": "Formeln, denen die Kurve folgen kann",
  "held": "bestätigt",
  "Held in {0} of 1 study that counts ({1} nats).": "Bestätigt in {0} von 1 Studie, die zählt ({1} Nat).",
  "Held in {0} of {1} studies that count ({2} nats together).":
    "Bestätigt in {0} von {1} Studien, die zählen (zusammen {2} Nat).",
  "its parameters": "seine Parameter",
  "Library of laws": "Bibliothek der Gesetze",
  "No law has joined the library. A law that a search finds outside the catalogue is added to it under":
    "Noch kein Gesetz steht in der Bibliothek. Ein Gesetz, das eine Suche außerhalb des Katalogs findet, kommt hinein unter",
  ", an effect file by": ", eine Effektdatei durch",
  "; later searches try it.": "; spätere Suchen prüfen es.",
  "Later searches, of other rigs too, try this law beside the catalogue.":
    "Spätere Suchen, auch an anderen Prüfständen, prüfen dieses Gesetz neben dem Katalog.",
  "no: its measurements count elsewhere": "nein: seine Messungen zählen anderswo",
  "No study counts as evidence yet.": "Noch zählt keine Studie als Beleg.",
  "not seen": "nicht gesehen",
  "Remove {0} from the library": "{0} aus der Bibliothek nehmen",
  "Remove from the library": "Aus der Bibliothek nehmen",
  "Studies that tried the law": "Studien, die das Gesetz geprüft haben",
  "The first two differ most at a {0} of {1}{2} ({3} and {4}, {5} sds): a run there would split them.":
    "Die ersten beiden unterscheiden sich am meisten bei {0} = {1}{2} ({3} und {4}, {5} Standardabweichungen): eine Fahrt dort würde sie trennen.",
  "The most probable {0} of them were also fitted to the measurements, through the model; their probabilities are from that.":
    "Die wahrscheinlichsten {0} von ihnen wurden auch an die Messungen angepasst, durch das Modell; ihre Wahrscheinlichkeiten sind daraus.",
  "the law": "das Gesetz",
  "The library": "Die Bibliothek",
  "undecided": "offen",
  "Version {0}, in the library since {1}.": "Version {0}, in der Bibliothek seit {1}.",
  "yes": "ja",
};
