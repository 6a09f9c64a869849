//! Proposed maps: stated facts are taken, missing ones become questions.

use import::{Guess, SourceFile, guess};

use super::{complaints, runs};

fn guessed(name: &str, bytes: &[u8]) -> Guess {
    guess(
        &SourceFile {
            name,
            bytes,
            is_own: true,
        },
        None,
    )
    .expect("a table")
}

const GERMAN: &str = "Versuch;Radlast [kN];Schlupf [%];Geschwindigkeit (mm/s);Zugkraft [N];Drehmoment [Ncm];Einsinkung mm;Wetter\n\
A;0,1;20;8;35,2;590;5,6;trocken\nB;0,1;40;8;;660;;trocken\n";

#[test]
fn german_titles_with_units_need_no_more_than_wheel_and_soil() {
    let proposal = guessed("Sand.csv", GERMAN.as_bytes());
    let open: Vec<&str> = proposal
        .fields
        .iter()
        .filter(|field| field.question.is_some())
        .map(|field| field.name.as_str())
        .collect();
    assert_eq!(open, ["wheel", "soil"]);
    assert_eq!(proposal.decimal.as_deref(), Some(","));
    assert!(
        proposal.map.ends_with("# Kept as notes: \"Wetter\"\n"),
        "{}",
        proposal.map
    );
    // The open proposal is refused, and converts the file once its questions are answered.
    let messages = complaints("Sand.csv", GERMAN.as_bytes(), &proposal.map);
    assert_eq!(messages.len(), 2, "{messages:#?}");
    let answered = proposal.map.replace("value = \"?\"", "value = \"x\"");
    assert_eq!(
        runs("Sand.csv", GERMAN.as_bytes(), &answered),
        "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,torque_n_m,sinkage_m\nA,x,x,0.2,100,0.008,35.2,5.9,0.0056\nB,x,x,0.4,100,0.008,,6.6,\n"
    );
}

#[test]
fn a_column_whose_words_mark_held_out_runs_is_proposed_with_what_they_mean() {
    let text = "run;wheel;soil;slip [%];load [N];speed [mm/s];pull [N];Wetter;Bemerkung\na;w;s;20;100;8;1,5;Ada;\nb;w;s;30;100;8;1,7;Bob;Kontrolle\nc;w;s;40;100;8;1,8;Ada;neu aufbereitet\n";
    let proposal = guessed("a.csv", text.as_bytes());
    assert!(
        proposal.map.contains("[columns.use]\ncolumn = \"Bemerkung\"\nwords = { \"Kontrolle\" = \"holdout\", \"neu aufbereitet\" = \"fit\" }   # fit, holdout"),
        "{}",
        proposal.map
    );
    assert!(runs("a.csv", text.as_bytes(), &proposal.map).ends_with(
        "\na,w,s,0.2,100,0.008,1.5,\nb,w,s,0.3,100,0.008,1.7,holdout\nc,w,s,0.4,100,0.008,1.8,fit\n"
    ));
    // A title that marks held-out runs, with words that do not say which is which, becomes a question.
    let marks = text
        .replace("Bemerkung", "Kontrolle")
        .replace(";Kontrolle\nc", ";x\nc");
    let proposal = guessed("a.csv", marks.as_bytes());
    let messages = complaints("a.csv", marks.as_bytes(), &proposal.map);
    assert!(
        messages[0].contains("words: \"neu aufbereitet\" = \"?\" asks for an answer"),
        "{messages:#?}"
    );
    assert!(messages[1].contains("words: \"x\" = \"?\""), "{messages:#?}");
    // If nothing marks held-out runs, the map shows how a column could.
    let quiet = text.replace("Kontrolle", "");
    let proposal = guessed("a.csv", quiet.as_bytes());
    assert!(
        proposal.map.contains(
            "# [columns.use]\n# column = \"Wetter\"\n# words = { \"Ada\" = \"?\", \"Bob\" = \"?\" }"
        ),
        "{}",
        proposal.map
    );
    assert_eq!(complaints("a.csv", quiet.as_bytes(), &proposal.map), [""; 0]);
}

#[test]
fn ids_of_sessions_tarings_and_operators_are_taken_from_english_and_german_titles() {
    for [session, zero, operator] in [
        ["Session", "Zero", "Operator"],
        ["day", "tare", "operator"],
        ["mounting", "taring", "operator"],
        ["Sitzung", "Nullung", "Bediener"],
        ["Messtag", "Tara", "Prüfer"],
        ["Tag", "Nullung", "Prüfer"],
    ] {
        let text = format!(
            "run;wheel;soil;slip [%];load [N];speed [mm/s];pull [N];{operator};{session};{zero}\na;w;s;20;100;8;1,5;Ada;11-16-20;1\nb;w;s;30;100;8;1,7;;11-17-20;\n"
        );
        let proposal = guessed("a.csv", text.as_bytes());
        assert_eq!(
            runs("a.csv", text.as_bytes(), &proposal.map),
            "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,session,zero,operator\na,w,s,0.2,100,0.008,1.5,11-16-20,1,Ada\nb,w,s,0.3,100,0.008,1.7,11-17-20,,\n",
            "{session}"
        );
    }
    // A word of these inside a longer title names another thing.
    let text =
        "run;wheel;soil;slip [%];load [N];speed [mm/s];pull [N];time of day\na;w;s;20;100;8;1,5;noon\n";
    let proposal = guessed("a.csv", text.as_bytes());
    assert!(
        proposal.map.ends_with("# Kept as notes: \"time of day\"\n"),
        "{}",
        proposal.map
    );
}

#[test]
fn a_unit_that_is_not_stated_is_a_question() {
    let text =
        "run,wheel,soil,slip,load,speed [mm/s],sinkage,torque [kg]\na,w,s,20,100,8,5,1\nb,w,s,30,100,8,6,2\n";
    let proposal = guessed("a.csv", text.as_bytes());
    let questions: Vec<&str> = proposal
        .fields
        .iter()
        .filter_map(|field| field.question.as_deref())
        .collect();
    assert_eq!(
        questions,
        ["slip", "load", "torque [kg]", "sinkage"]
            .map(|title| format!("in which unit is \"{title}\"? The file does not state it"))
    );
    let messages = complaints("a.csv", text.as_bytes(), &proposal.map);
    assert_eq!(messages.len(), 4, "{messages:#?}");
    assert!(
        messages
            .iter()
            .all(|line| line.contains("unit = \"?\" asks for an answer")),
        "{messages:#?}"
    );
}

#[test]
fn slip_from_rotation_is_proposed_with_the_radius_as_a_question() {
    let text = "run;wheel;soil;load [N];speed [mm/s];rotation [rpm];pull [N]\na;w;s;100;8;1;12,5\nb;w;s;100;8;1,2;13,5\n";
    let proposal = guessed("a.csv", text.as_bytes());
    assert!(
        proposal
            .map
            .contains("[columns.slip]\nformula = \"(omega * r - sled_speed_m_s)"),
        "{}",
        proposal.map
    );
    let messages = complaints("a.csv", text.as_bytes(), &proposal.map).join("\n");
    assert!(
        messages.contains("r: value = \"?\" asks for an answer"),
        "{messages}"
    );
    let answered = proposal
        .map
        .replace("value = \"?\"", "value = 125")
        .replace("unit = \"?\"", "unit = \"mm\"");
    assert!(runs("a.csv", text.as_bytes(), &answered).contains("\na,w,s,0.388845018"));
}

#[test]
fn what_can_be_read_in_two_ways_is_asked() {
    let text = "run;wheel;soil;slip [%];load [N];speed [mm/s];pull [N]\na;w;s;20;1,234;8;1,500\nb;w;s;20;1,235;8;1,750\n";
    let proposal = guessed("a.csv", text.as_bytes());
    assert_eq!(proposal.decimal.as_deref(), Some("?"));
    let messages = complaints("a.csv", text.as_bytes(), &proposal.map).join("\n");
    assert!(
        messages.contains("decimal = \"?\" asks for an answer"),
        "{messages}"
    );
    assert!(
        runs(
            "a.csv",
            text.as_bytes(),
            &proposal.map.replace("decimal = \"?\"", "decimal = \",\"")
        )
        .contains("\na,w,s,0.2,1.234,0.008,1.5\n")
    );
}

#[test]
fn names_of_runs_csv_are_taken_as_they_are_and_sheets_are_listed() {
    let text = "# made by hand\nrun,wheel,soil,slip,wheel_load_n,sled_speed_m_s,slip_angle_deg,sinkage_m\na,w,s,0.2,100,0.008,15,0.005\n";
    let proposal = guessed("a.csv", text.as_bytes());
    assert_eq!(
        runs("a.csv", text.as_bytes(), &proposal.map),
        text.split_once('\n').unwrap().1
    );
    let book = guessed("b.xlsx", include_bytes!("files/awkward.xlsx"));
    assert_eq!((book.sheet.as_deref(), book.title_line), (Some("Runs"), 3));
    assert_eq!(book.sheets, ["Runs", "Notes"]);
    assert_eq!(book.columns[4].sample[0], "12,5");
    let variables = guessed("c.mat", include_bytes!("files/vectors-v73.mat"));
    assert_eq!(variables.sheet.as_deref(), Some("data"));
    assert!(
        variables.columns.iter().any(|column| column.title == "sinkage"),
        "{:?}",
        variables.columns
    );
}

#[test]
fn a_component_of_force_is_not_proposed_by_its_letter_alone() {
    let table = b"avg_Fx,avg_Fy,Fz,torque_y,force.z [N],avg_Z,Pull Fx [N]\n1.5,2,3,4,5,6,7\n1,2,3,4,5,6,7\n";
    let guess = guessed("averages.csv", table);
    let of = |name: &str| {
        let field = guess.fields.iter().find(|field| field.name == name);
        field.and_then(|field| field.column.as_deref())
    };
    assert_eq!(of("drawbar_pull_n"), Some("Pull Fx [N]"), "its word says it");
    for name in ["lateral_force_n", "wheel_load_n", "torque_n_m"] {
        assert_eq!(of(name), None, "{name}");
    }
    assert_eq!(
        guess.components,
        ["avg_Fx", "avg_Fy", "Fz", "torque_y", "force.z [N]"]
    );
    assert!(
        guess
            .map
            .contains("nor its sign: \"avg_Fx\", \"avg_Fy\", \"Fz\", \"torque_y\", \"force.z [N]\".\n"),
        "{}",
        guess.map
    );
}
