// What effects, freed parameters and settings of the model do, in German, by the English form that the service states.

/** @type {Record<string, string>} */
export const EFFECTS = {
  "a hard layer at some depth stiffens the soil above it":
    "eine harte Schicht in der Tiefe versteift den Boden darüber",
  "a skidding wheel sinks by a law of its own: less than a driving one at first, then more":
    "ein gebremstes Rad sinkt nach einem eigenen Gesetz ein: erst weniger als ein treibendes, dann mehr",
  "a small wheel meets less pressure than a plate at the same sinkage":
    "ein kleines Rad erfährt weniger Druck als eine Platte bei gleicher Einsinkung",
  "a wheel that slides sideways sinks deeper: the sinkage exponent grows with the slip angle":
    "ein seitlich gleitendes Rad sinkt tiefer ein: der Einsinkexponent wächst mit dem Schräglaufwinkel",
  "another share of the pressed soil flows to the border of the footprint":
    "ein anderer Anteil des verdrängten Bodens fließt zum Rand der Aufstandsfläche",
  "at a slip angle the buried side of the wheel pushes soil aside":
    "bei Schräglauf schiebt die eingesunkene Seite des Rades Boden zur Seite",
  "at low speed shear sticks and breaks loose, so that its mean is lower":
    "bei kleiner Geschwindigkeit haftet der Boden und reißt los, darum ist die mittlere Schubspannung kleiner",
  "bearings and seals cost the same torque at any load":
    "Lager und Dichtungen kosten bei jeder Last dasselbe Drehmoment",
  "bearings cost torque in proportion to the load they carry": "Lager kosten Drehmoment im Verhältnis zu ihrer Last",
  "each earlier pass leaves the soil stiffer than its deformation explains":
    "jede frühere Überfahrt hinterlässt den Boden steifer, als seine Verformung erklärt",
  "friction falls with the speed of sliding": "die Reibung fällt mit der Gleitgeschwindigkeit",
  "grousers shear the soil between them and push": "die Stollen scheren den Boden zwischen sich ab und schieben",
  "shear stress builds up quickly at first and then slowly with displacement":
    "die Schubspannung wächst mit dem Scherweg erst schnell, dann langsam",
  "shear stress needs displacement along the rim to build up":
    "die Schubspannung braucht einen Scherweg am Umfang, um sich aufzubauen",
  "soil beside the wheel rubs on its two faces": "der Boden neben dem Rad reibt an dessen Seitenflächen",
  "soil that has flowed carries another share of what settled soil does":
    "geflossener Boden trägt einen anderen Anteil dessen, was gesetzter trägt",
  "soil that is pressed down faster resists more": "Boden, der schneller eingedrückt wird, widersteht stärker",
  "soil yields sideways at both edges, so that they carry nothing":
    "der Boden weicht an beiden Rändern seitlich aus, so dass sie nichts tragen",
  "the buried side of a wheel at an angle pushes soil aside":
    "die eingesunkene Seite eines schräg laufenden Rades schiebt Boden zur Seite",
  "the drawbar force does not read zero when the wheel pulls nothing":
    "die Zugkraft zeigt nicht null, wenn das Rad nichts zieht",
  "the drawbar force sensor's gain is off": "die Verstärkung des Zugkraftsensors stimmt nicht",
  "the ends of the bin confine the soil and stiffen it":
    "die Enden des Kastens schließen den Boden ein und versteifen ihn",
  "the friction angle grows as the pressure falls, by dilatancy":
    "der Reibungswinkel wächst durch Dilatanz, wenn der Druck fällt",
  "the linkage turns drawbar pull into a change of wheel load":
    "das Gestänge macht aus Zugkraft eine Änderung der Radlast",
  "the peak pressure falls with slip": "der größte Druck fällt mit dem Schlupf",
  "the pressure acts along the normal of the rim: the soil resists compaction":
    "der Druck wirkt senkrecht zum Umfang: der Boden widersteht der Verdichtung",
  "the pressure acts upwards: the soil does not resist compaction":
    "der Druck wirkt nach oben: der Boden widersteht der Verdichtung nicht",
  "the pressure falls off less towards the border of the footprint":
    "der Druck fällt zum Rand der Aufstandsfläche weniger ab",
  "the pressure falls off towards the border of the footprint by another power":
    "der Druck fällt zum Rand der Aufstandsfläche mit einem anderen Exponenten ab",
  "the pressure follows Reece's law of the effective width instead of Bekker's":
    "der Druck folgt Reeces Gesetz der wirksamen Breite statt dem von Bekker",
  "the pressure peaks ahead of the axle, the more so with slip":
    "der größte Druck liegt vor der Achse, umso mehr mit Schlupf",
  "the pressure saturates with depth as towards a bearing capacity":
    "der Druck sättigt mit der Tiefe wie gegen eine Tragfähigkeit",
  "the reference velocity of the shear law is another": "die Bezugsgeschwindigkeit des Schergesetzes ist eine andere",
  "the reference velocity of the shear law is not the assumed one":
    "die Bezugsgeschwindigkeit des Schergesetzes ist nicht die angenommene",
  "the rig's ratio of travel to rim speed is off":
    "das Verhältnis von Fahr- zu Umfangsgeschwindigkeit am Prüfstand stimmt nicht",
  "the rim flattens under its load": "der Umfang flacht unter seiner Last ab",
  "the rim pushes a wedge of soil ahead of itself": "der Umfang schiebt einen Bodenkeil vor sich her",
  "the rim slides on the soil before the soil itself shears":
    "der Umfang gleitet auf dem Boden, bevor der Boden selbst schert",
  "the shear displacement belongs to the point of the rim": "der Scherweg gehört zum Punkt des Umfangs",
  "the shear displacement belongs to the soil that is sheared": "der Scherweg gehört zum Boden, der geschert wird",
  "the shear stress does not depend on the slip velocity":
    "die Schubspannung hängt nicht von der Gleitgeschwindigkeit ab",
  "the sinkage exponent grows with slip": "der Einsinkexponent wächst mit dem Schlupf",
  "the sled's guides resist in proportion to speed":
    "die Führungen des Schlittens bremsen im Verhältnis zur Geschwindigkeit",
  "the slipping rim carries soil away and digs itself in":
    "der durchrutschende Umfang trägt Boden fort und gräbt sich ein",
  "the soil beside a wheel at an angle drags on its side, or pushes it on where the rim is fast":
    "der Boden neben einem schräg laufenden Rad bremst dessen Seite, oder schiebt sie an, wo der Umfang schnell ist",
  "the soil grows denser with depth": "der Boden wird mit der Tiefe dichter",
  "the soil has a cohesion other than the job says": "der Boden hat eine andere Kohäsion, als der Job sagt",
  "the soil has another elastic stiffness than the job says":
    "der Boden hat eine andere elastische Steifigkeit, als der Job sagt",
  "the soil holds on to the rim even without normal pressure": "der Boden haftet am Umfang auch ohne Normaldruck",
  "the soil is a terrain in three dimensions that keeps its deformation":
    "der Boden ist ein dreidimensionales Gelände, das seine Verformung behält",
  "the soil springs back behind the axle and pushes the wheel on":
    "der Boden federt hinter der Achse zurück und schiebt das Rad an",
  "the soil stiffens or softens in the course of the campaign":
    "der Boden wird im Lauf der Kampagne steifer oder weicher",
  "the soil's stiffness falls with gravity": "die Steifigkeit des Bodens fällt mit der Schwerkraft",
  "the torque sensor's gain is off": "die Verstärkung des Drehmomentsensors stimmt nicht",
  "the wheel carries more or less than the stated load": "das Rad trägt mehr oder weniger als die angegebene Last",
  "the wheel drives uphill or downhill": "das Rad fährt bergauf oder bergab",
  "the wheel is a smooth cylinder in balance on undisturbed soil":
    "das Rad ist ein glatter Zylinder im Gleichgewicht auf ungestörtem Boden",
  "the wheel's radius differs from the stated one": "der Radius des Rades weicht vom angegebenen ab",
  "the wheel's width differs from the stated one": "die Breite des Rades weicht von der angegebenen ab",
  "the zero of the drawbar force moves in the course of the campaign":
    "der Nullpunkt der Zugkraft wandert im Lauf der Kampagne",
  "the zero of the lateral force moves in the course of the campaign":
    "der Nullpunkt der Seitenkraft wandert im Lauf der Kampagne",
  "the zero of the sinkage lies above or below the undisturbed surface":
    "der Nullpunkt der Einsinkung liegt über oder unter der ungestörten Oberfläche",
  "the zero of the sinkage moves in the course of the campaign":
    "der Nullpunkt der Einsinkung wandert im Lauf der Kampagne",
  "the zero of the torque moves in the course of the campaign":
    "der Nullpunkt des Drehmoments wandert im Lauf der Kampagne",
  "water gives the soil cohesion, friction and stiffness": "Wasser gibt dem Boden Kohäsion, Reibung und Steifigkeit",
  "runs at a slip angle": "Fahrten mit Schräglaufwinkel",
  "runs at a slip angle in drive": "Fahrten mit Schräglaufwinkel im Antrieb",
  "runs at a slip angle in skid": "Fahrten mit Schräglaufwinkel beim Bremsen",
  "runs in drive": "Fahrten im Antrieb",
  "runs in skid": "gebremste Fahrten",
  "runs in drive or in skid": "Fahrten im Antrieb oder gebremst",
  "runs in drive or at a slip angle": "Fahrten im Antrieb oder mit Schräglaufwinkel",
  "runs in skid or at a slip angle": "gebremste Fahrten oder mit Schräglaufwinkel",
};
