//! Texts as written by programs and by hand.

use super::{converted, runs};

const MAP: &str = r#"
columns.wheel = { value = "w" }
columns.soil = { value = "s" }
columns.slip = { column = "Schlupf", unit = "%" }
columns.wheel_load_n = { column = "Last", unit = "N" }
columns.sled_speed_m_s = { value = 10, unit = "mm/s" }
columns.sinkage_m = { column = "Einsinkung", unit = "mm" }
"#;

const EXPECTED: &str = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,sinkage_m\nr1,w,s,0.105,100,0.01,5.5\nr2,w,s,0.2,1250.5,0.01,\n";

fn expected() -> String {
    EXPECTED.replace("5.5\n", "0.0055\n")
}

#[test]
fn separators_commas_preambles_and_rows_of_units_are_found() {
    for text in [
        "Schlupf;Last;Einsinkung\n10,5;100;5,5\n20;1.250,5;\n",
        "Prüfstand 3\n12 Versuche; Sand\n\nSchlupf;Last;Einsinkung\n%;N;mm\n\n10,5;100;5,5\n20;1250,5;\n",
        "Schlupf\tLast\tEinsinkung\r\n10,5\t100\t5,5\r\n20\t1250,5\t\r\n",
        "sep=;\nSchlupf;Last;Einsinkung;\n10,5;100;5,5;\n20;1250,5;;\n",
        "# logger 1.2\n# Schlupf|Last|Einsinkung\n10.5|100|5.5\n20|1250.5|\n",
        "Schlupf,Last,Einsinkung\n\"10,5\",100,\"5,5\"\n20,\"1250,5\",\n",
        "\u{feff}Schlupf,Last,Einsinkung\n10.5,100,5.5\n20,1250.5,\n",
    ] {
        assert_eq!(runs("a.csv", text.as_bytes(), MAP), expected(), "{text}");
    }
    let spaces = "Schlupf  Last Einsinkung\n10.5   100  5.5\n20  1250.5 nan\n";
    assert_eq!(
        runs("a.dat", spaces.as_bytes(), &format!("missing = [\"nan\"]{MAP}")),
        expected()
    );
}

#[test]
fn encodings_are_found_and_said() {
    let text = "Schlupf;Last;Einsinkung;Prüfer\n10,5;100;5,5;Jürgen\n20;1250,5;;Zoë\n";
    let western: Vec<u8> = text
        .chars()
        .map(|c| u8::try_from(u32::from(c)).unwrap())
        .collect();
    let result = converted("a.csv", &western, MAP);
    assert_eq!(result.notes.as_deref(), Some("run,Prüfer\nr1,Jürgen\nr2,Zoë\n"));
    assert_eq!(
        result.remarks[0],
        "the file is read as windows-1252, which it does not state"
    );
    let wide: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_eq!(runs("a.csv", &wide, MAP), expected());
}

#[test]
fn rows_and_words_are_left_out_where_the_map_says_so_and_it_is_told() {
    let text = "Schlupf;Last;Einsinkung\n10,5;100;5,5\n# a break\n20;1250,5;n.b.\nMittel;675,25;\n";
    let result = converted(
        "a.csv",
        text.as_bytes(),
        &format!("skip = [5]\nmissing = [\"n.b.\"]{MAP}"),
    );
    assert_eq!(result.runs, Some(expected()));
    assert_eq!(
        result.remarks,
        [
            "comments, left out: lines 3",
            "left out, as the map says: 5",
            "the runs are numbered, r1 and so on: the map has no [columns.run]"
        ]
    );
}

#[test]
fn slip_is_derived_from_rotation_or_from_advance() {
    let map = r#"
        [columns]
        wheel = { value = "w" }
        soil = { value = "s" }
        wheel_load_n = { value = 25, unit = "lbf" }
        sled_speed_m_s = { column = "v", unit = "cm/s" }
        sinkage_m = { formula = "0.125 * r / r - hub" }
        slip = { formula = "FORMULA" }
        [quantities]
        r = { value = 12.5, unit = "cm" }
        n = { column = "n", unit = "rpm" }
        hub = { column = "hub", unit = "in" }
        way = { column = "way", unit = "mm" }
        angle = { column = "turns", unit = "rev" }
    "#;
    // 1 rpm is 0.1047 rad/s, times 0.125 m 13.09 mm/s; a turn of 0.7854 m
    let text = "v,n,hub,way,turns\n1.0,1,4.8,600,1\n1.0,1.2,4.7,550,1\n";
    let field = |map: &str, name: &str| -> Vec<f64> {
        let text = runs("a.csv", text.as_bytes(), map);
        let mut lines = text.lines();
        let column = lines
            .next()
            .unwrap()
            .split(',')
            .position(|column| column == name)
            .unwrap();
        lines
            .map(|line| line.split(',').nth(column).unwrap().parse().unwrap())
            .collect()
    };
    let close =
        |result: &[f64], expected: &[f64]| result.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9);
    let rotation = map.replace("FORMULA", "(n * r - sled_speed_m_s) / max(n * r, sled_speed_m_s)");
    assert!(close(
        &field(&rotation, "slip"),
        &[0.236_056_273_1, 0.363_380_227_6]
    ));
    let advance = map.replace("FORMULA", "1 - way / (angle * r)");
    assert!(close(
        &field(&advance, "slip"),
        &[0.236_056_273_1, 0.299_718_250_4]
    ));
    assert!(close(&field(&advance, "wheel_load_n"), &[111.205_540_382]));
    assert!(close(&field(&advance, "sinkage_m"), &[0.003_08, 0.005_62]));
}
