//! Raw recordings: files without titles, with jittered times, joined on time, with conditions in their names, and ROS bags.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt::Write;

use import::{Converted, Files, SourceFile, convert_all, files_of, guess};

use super::{complaints, converted};

const BAG: &[u8] = include_bytes!("files/run.bag");
const ZERO: &[u8] = include_bytes!("files/zero.bag");
/// The first time of the kinematics and the bag `[s]`.
const BEGIN_S: f64 = 1_637_060_000.0;

/// Returns the kinematics of a run of 3 s without titles: position [mm], speed [mm/s], angle [deg], depth [mm], time of the logger [ms], time of the
/// computer [s]. Steps of 2 to 15 ms; the wheel stands for 0.5 s, then sinks by 4 mm/s; `zero` is the reading of the depth at rest.
fn kinematics(zero: f64) -> String {
    let (mut text, mut t_ms, mut k) = (String::new(), 0_u32, 0_u32);
    while t_ms <= 3000 {
        let t_s = f64::from(t_ms) / 1000.0;
        let moved_s = (t_s - 0.5).max(0.0);
        let speed = if t_s < 0.5 { 0.0 } else { 10.0 };
        let (x, z) = (10.0 * moved_s, zero + 4.0 * moved_s);
        let _ = writeln!(
            text,
            "{x:.4}\t{speed}\t15\t{z:.4}\t{}\t{:.6}",
            t_ms + 7,
            BEGIN_S + t_s
        );
        t_ms += [15, 2, 14, 9, 13, 5][k as usize % 6];
        k += 1;
    }
    text
}

const MAP: &str = r#"
titles = 0

[recording]
time = "E"
time_unit = "ms"

[columns]
wheel = { value = "w" }
soil = { value = "s" }
slip = { value = 20, unit = "%" }
wheel_load_n = { value = 150, unit = "N" }
sled_speed_m_s = { value = 10, unit = "mm/s" }
sinkage_m = { column = "D", unit = "mm", zero_line = 1 }

[quantities]
v = { column = "B", unit = "mm/s" }
"#;

/// Converts files by their names.
fn all(files: &[(&str, &[u8])], runs: &[&str], map: &str) -> Converted {
    let by_name: BTreeMap<&str, &[u8]> = files.iter().copied().collect();
    let open = |name: &str| {
        let bytes = by_name.get(name).map(|bytes| Cow::Borrowed(*bytes));
        bytes.ok_or_else(|| "there is no such file".to_owned())
    };
    let names: Vec<String> = runs.iter().map(|&name| name.to_owned()).collect();
    let files = Files {
        names: &names,
        open: &open,
        is_own: true,
    };
    convert_all(files, ("map.toml", map), "runs")
}

fn messages(converted: &Converted) -> String {
    let messages: Vec<String> = converted.complaints.iter().map(ToString::to_string).collect();
    messages.join("\n")
}

/// Returns the cells of runs.csv below a title.
#[track_caller]
fn column(converted: &Converted, title: &str) -> Vec<String> {
    let text = converted.runs.as_deref();
    let text = text.unwrap_or_else(|| panic!("{}", messages(converted)));
    let mut lines = text.lines().map(|line| line.split(','));
    let at = lines
        .next()
        .and_then(|mut titles| titles.position(|name| name == title));
    let at = at.unwrap_or_else(|| panic!("no {title} in\n{text}"));
    lines
        .map(|mut cells| cells.nth(at).unwrap_or_default().to_owned())
        .collect()
}

#[track_caller]
fn assert_near(value: &str, expected: f64, tolerance: f64) {
    let value: f64 = value.parse().expect("a number");
    assert!((value - expected).abs() < tolerance, "{value}, {expected}");
}

#[test]
fn a_file_without_marker_is_one_run_and_its_zero_is_that_of_a_line() {
    let map = MAP.replace("time_unit = \"ms\"", "time_unit = \"ms\"\nwindow_s = [2.0, 2.5]");
    let result = converted("raw/smooth_3.txt", kinematics(-32.5).as_bytes(), &map);
    assert_eq!(column(&result, "run"), ["smooth_3"]);
    // Mean of 4 mm/s (t − 0.5 s) from 2.0 to 2.5 s.
    assert_near(&column(&result, "sinkage_m")[0], 0.007, 2e-5);
    let named = map.replace("[columns]", "[columns]\nrun = { value = \"trial 7\" }");
    let named = converted("raw/smooth_3.txt", kinematics(0.0).as_bytes(), &named);
    assert_eq!(column(&named, "run"), ["trial 7"]);
    let wrong = MAP.replace("zero_line = 1", "zero_line = 100000");
    let wrong = complaints("raw.txt", kinematics(0.0).as_bytes(), &wrong);
    assert_eq!(wrong, ["raw.txt: line 100000 of zero_line is no row of data"]);
}

#[test]
fn jittered_steps_become_a_history_at_equal_steps() {
    let map = MAP.replace("time_unit = \"ms\"", "time_unit = \"ms\"\nhistories = true");
    let result = converted("raw.txt", kinematics(-32.5).as_bytes(), &map);
    assert_eq!(column(&result, "history"), ["runs-raw.csv"]);
    assert!(
        result
            .remarks
            .contains(&"steps of 0.002 to 0.015 s become equal steps of 0.013 s, in 1 histories".into()),
        "{:?}",
        result.remarks
    );
    let history = &result.histories["runs-raw.csv"];
    let rows: Vec<(f64, f64)> = history
        .lines()
        .skip(1)
        .filter_map(|line| line.split_once(','))
        .map(|(t, z)| (t.parse().unwrap(), z.parse().unwrap()))
        .collect();
    assert_eq!(rows.len(), 230);
    for (k, (t_s, sinkage_m)) in rows.iter().enumerate() {
        assert!((t_s - 0.013 * (k + 1) as f64).abs() < 1e-9, "{t_s}");
        // The mean of a straight line over a step is its value in the middle.
        let expected = (0.004 * (t_s - 0.0065 - 0.5)).max(0.0);
        assert!(
            (sinkage_m - expected).abs() < 3e-5,
            "{t_s}: {sinkage_m}, {expected}"
        );
    }
    let mut files = result.histories.clone();
    files.insert("runs.csv".into(), result.runs.clone().unwrap());
    let toml = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.1\n[soil.s]\n[noise]\nsinkage_m = 0.001\n[protocol]\nmeasured_transient_s = 1.0\nlowpass_hz = 0.0\n";
    let files = shared::file::FileSet {
        toml: toml.into(),
        files,
    };
    shared::experiment::Experiment::parse("experiment.toml", &files).unwrap();
    let stated = map.replace("histories = true", "histories = true\nstep_s = 0.1");
    let stated = converted("raw.txt", kinematics(0.0).as_bytes(), &stated);
    assert!(stated.histories["runs-raw.csv"].starts_with("t_s,sinkage_m\n0.1,0\n0.2,0\n"));
    let fine = map.replace("histories = true", "histories = true\nstep_s = 0.001");
    let fine = complaints("raw.txt", kinematics(0.0).as_bytes(), &fine).join("\n");
    assert!(
        fine.ends_with("step_s 0.001 s must be at least 0.013 s, the usual step of the recording"),
        "{fine}"
    );
}

#[test]
fn a_gap_of_a_recording_is_no_part_of_a_history() {
    let map = MAP.replace("time_unit = \"ms\"", "time_unit = \"ms\"\nhistories = true");
    let text = kinematics(0.0);
    let lines: Vec<&str> = text.lines().collect();
    let with_gap = [&lines[..100], &lines[115..]].concat().join("\n");
    let said = complaints("raw.txt", with_gap.as_bytes(), &map).join("\n");
    assert!(said.starts_with("raw.txt line 10"), "{said}");
    assert!(
        said.contains("run \"raw\": sinkage has no values between 0.956 and 0.969 s that lie at most five steps of 0.013 s apart"),
        "{said}"
    );
    let wider = map.replace("histories = true", "histories = true\nstep_s = 0.05");
    assert_eq!(complaints("raw.txt", with_gap.as_bytes(), &wider), [""; 0]);
}

#[test]
fn a_run_is_where_a_condition_holds() {
    let map = MAP.replace(
        "time_unit = \"ms\"",
        "time_unit = \"ms\"\nwhile = \"v > 0.005\"\nshortest_s = 0.2\nwindow_s = [1.5, 2.0]",
    );
    // One reading is disturbed before the run, one within it.
    let mut disturbed: Vec<String> = kinematics(0.0).lines().map(str::to_owned).collect();
    disturbed[10] = disturbed[10].replace("\t0\t", "\t11\t");
    disturbed[150] = disturbed[150].replace("\t10\t", "\t0\t");
    let run = converted("raw.txt", disturbed.join("\n").as_bytes(), &map);
    assert_eq!(column(&run, "run"), ["raw"]);
    let cut = converted(
        "raw.txt",
        disturbed.join("\n").as_bytes(),
        &map.replace("shortest_s = 0.2\n", "")
            .replace("window_s = [1.5, 2.0]", ""),
    );
    assert_eq!(column(&cut, "run").len(), 3, "each stretch is a run of its own");
    let clean = converted("raw.txt", kinematics(0.0).as_bytes(), &map);
    // The window counts from the beginning of the run: the mean of 4 mm/s t from 1.5 to 2.0 s.
    assert_near(&column(&clean, "sinkage_m")[0], 0.007, 4e-5);
    assert!(
        clean
            .remarks
            .iter()
            .any(|remark| remark.ends_with(" rows lie between runs and are left out")),
        "{:?}",
        clean.remarks
    );
    let text = kinematics(0.0);
    let twice = text.clone()
        + &text
            .replace("\t1637060000.", "\t1637060100.")
            .replace("\t15\t", "\t15.0\t");
    let twice = twice.lines().enumerate().map(|(k, line)| {
        let fields: Vec<&str> = line.split('\t').collect();
        format!(
            "{}\t{}\t{}\t{}\t{}\t{}\n",
            fields[0],
            fields[1],
            fields[2],
            fields[3],
            10 * k,
            fields[5]
        )
    });
    let twice = converted("raw.txt", twice.collect::<String>().as_bytes(), &map);
    assert_eq!(column(&twice, "run"), ["raw-1", "raw-2"]);
    let never = complaints("raw.txt", text.as_bytes(), &map.replace("0.005", "5"));
    assert_eq!(never, ["raw.txt: the condition never marks a run"]);
    let wrong = complaints("raw.txt", text.as_bytes(), &map.replace("v > 0.005", "v"));
    assert!(
        wrong[0].starts_with("map.toml line 5: [recording]: while, as the formula \"if(v, 1, 0)\": "),
        "{wrong:?}"
    );
    let both = map.replace("while", "marker = \"B\"\nwhile");
    let both = complaints("raw.txt", text.as_bytes(), &both);
    assert!(
        both[0].ends_with("a run is told by marker or by while: leave one of them out"),
        "{both:?}"
    );
}

/// Returns the map of many files with conditions in their names.
fn named() -> String {
    MAP.replace(
        "titles = 0",
        "titles = 0\nfile = \"{rim}_s{slip}_v{speed}_{trial}.txt\"",
    )
    .replace("value = \"w\"", "value = \"{rim}\"")
    .replace("value = 20,", "value = \"{slip}\",")
    .replace("value = 10,", "value = \"{speed}\",")
}

#[test]
fn conditions_of_many_files_are_those_of_their_names() {
    let text = kinematics(-12.0);
    let names = [
        "a/smooth_s20_v10_1.txt",
        "a/smooth_s20_v10_2.txt",
        "a/grouser_s-5.5_v25_1.txt",
    ];
    let files = names.map(|name| (name, text.as_bytes()));
    let result = all(&files, &names, &named());
    assert_eq!(
        column(&result, "run"),
        ["smooth_s20_v10_1", "smooth_s20_v10_2", "grouser_s-5.5_v25_1"]
    );
    assert_eq!(column(&result, "wheel"), ["smooth", "smooth", "grouser"]);
    assert_eq!(column(&result, "slip"), ["0.2", "0.2", "-0.055"]);
    assert_eq!(column(&result, "sled_speed_m_s"), ["0.01", "0.01", "0.025"]);
    assert_eq!(
        result.remarks.len(),
        1,
        "what holds for all files is said once: {:?}",
        result.remarks
    );
    let meant = files_of(&named(), &["a/notes.md".into(), "a/smooth_s20_v10_1.txt".into()]);
    assert_eq!(meant, Some(vec!["a/smooth_s20_v10_1.txt".into()]));
    assert_eq!(files_of(MAP, &[]), None);
}

#[test]
fn what_is_wrong_with_many_files_is_said_with_their_names() {
    let text = kinematics(0.0);
    let open = [
        ("x.txt", text.as_bytes()),
        ("smooth_s20_v10_1.txt", text.as_bytes()),
    ];
    let wrong = all(
        &open,
        &["x.txt", "smooth_s20_v10_1.txt", "smooth_s20_v9_1.txt"],
        &named(),
    );
    assert_eq!(
        messages(&wrong),
        "x.txt: the name does not fit `file = \"{rim}_s{slip}_v{speed}_{trial}.txt\"` of the map\nsmooth_s20_v9_1.txt: there is no such file"
    );
    let unknown = all(
        &open[1..],
        &["smooth_s20_v10_1.txt"],
        &named().replace("{speed}\",", "{rate}\","),
    );
    assert!(
        messages(&unknown).starts_with("smooth_s20_v10_1.txt: sled_speed_m_s: \"{rate}\" is no part of the file's name; known are {rim}, {slip}, "),
        "{}",
        messages(&unknown)
    );
    let table = named().replace("[recording]\ntime = \"E\"\ntime_unit = \"ms\"\n", "");
    let table = all(&open, &["x.txt", "smooth_s20_v10_1.txt"], &table);
    assert!(
        messages(&table).contains("2 files must be recordings: the map needs [recording]"),
        "{}",
        messages(&table)
    );
    let same = named().replace("[columns]", "[columns]\nrun = { value = \"one\" }");
    let files = ["a_s1_v1_1.txt", "b_s1_v1_1.txt"];
    let same = all(&files.map(|name| (name, text.as_bytes())), &files, &same);
    assert_eq!(
        messages(&same),
        "b_s1_v1_1.txt: run \"one\" is also one of a_s1_v1_1.txt: give each a name of its own by [columns.run]"
    );
    let many: Vec<String> = (0..30).map(|k| format!("{k}.txt")).collect();
    let many: Vec<&str> = many.iter().map(String::as_str).collect();
    let many = all(&[], &many, MAP);
    assert_eq!(many.complaints.len(), 11);
    assert!(
        messages(&many).ends_with("9.txt: 20 more files are not read, since 10 have mistakes"),
        "{}",
        messages(&many)
    );
}

/// Returns the map of kinematics in a text and forces in a bag, tared by another bag.
fn joined() -> String {
    named()
        .replace(
            "time = \"E\"\ntime_unit = \"ms\"",
            "time = \"F\"\ntime_unit = \"s\"\nwindow_s = [1, 2]",
        )
        .replace(
            "[recording]",
            "[join.force]\nfile = \"{stem}.bag\"\ntime = \"stamp [s]\"\ntime_unit = \"s\"\n\n[recording]",
        )
        .replace(
            "wheel_load_n = { value = 150, unit = \"N\" }",
            "wheel_load_n = { formula = \"-fz\" }\ndrawbar_pull_n = { formula = \"-fy\" }",
        )
        + "fy = { from = \"force\", column = \"force.y [N]\", zero_file = \"{rim}_zero.bag\" }\nfz = { from = \"force\", column = \"force.z [N]\", zero_file = \"{rim}_zero.bag\" }\n"
}

const RUN: &str = "a/smooth_s20_v10_1.txt";

/// Converts a run by a map that joins a bag.
fn join(map: &str) -> Converted {
    let text = kinematics(-12.0);
    let files = [
        (RUN, text.as_bytes()),
        ("a/smooth_s20_v10_1.bag", BAG),
        ("a/smooth_zero.bag", ZERO),
    ];
    all(&files, &[RUN], map)
}

#[test]
fn forces_of_a_bag_join_the_kinematics_of_a_text_on_time() {
    let result = join(&joined());
    assert_near(&column(&result, "wheel_load_n")[0], 150.0, 1e-6);
    // 20 N + 2 N/s t, averaged from 1 to 2 s.
    assert_near(&column(&result, "drawbar_pull_n")[0], 23.0, 0.02);
    assert_near(&column(&result, "sinkage_m")[0], 0.004, 4e-5);
    assert!(
        result.remarks.iter().any(|remark| remark
            == "columns of [join.force] that no entry takes: received [s], force.x [N], torque.x [N m], torque.y [N m], torque.z [N m]"),
        "{:?}",
        result.remarks
    );
    let histories = join(&joined().replace("window_s", "histories = true\nwindow_s"));
    let history = histories.histories.values().next().expect("a history");
    for line in history.lines().skip(1) {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let expected = 20.0 + 2.0 * (cells[0] - 0.0065);
        assert!((cells[1] - expected).abs() < 0.03, "{line}: {expected}");
    }
}

#[test]
fn clocks_that_begin_apart_are_shifted() {
    let apart = joined().replace(
        "time = \"F\"\ntime_unit = \"s\"",
        "time = \"E\"\ntime_unit = \"ms\"",
    );
    let said = messages(&join(&apart));
    assert!(
        said.contains("a/smooth_s20_v10_1.bag, sheet \"/ft_sensor\": [join.force]: its times, 1637059999.9 to 1637060003."),
        "{said}"
    );
    assert!(
        said.contains("have no samples at those of a/smooth_s20_v10_1.txt, 0.007 to 3.00"),
        "{said}"
    );
    // The bag begins 0.1 s before the text.
    let shifted = apart.replace("[join.force]", "[join.force]\nfrom_start = true\noffset_s = -0.1");
    assert_near(&column(&join(&shifted), "drawbar_pull_n")[0], 23.0, 0.02);
    let late = joined().replace("[join.force]", "[join.force]\noffset_s = 1.0");
    let late = join(&late);
    assert!(
        late.remarks
            .iter()
            .any(|remark| remark
                .contains("rows have no values of [join.force]: it has no samples at their times")),
        "{:?}",
        late.remarks
    );
}

#[test]
fn what_is_wrong_with_a_join_is_said() {
    for (change, message) in [
        (
            ("{stem}.bag", "{stem}-2.bag"),
            "a/smooth_s20_v10_1-2.bag: [join.force]: there is no such file",
        ),
        (
            ("{rim}_zero.bag", "{rim}-zero.bag"),
            "a/smooth-zero.bag: [join.force]: there is no such file",
        ),
        (
            ("\"force.y [N]\"", "\"force.w [N]\""),
            "no column has the title \"force.w [N]\"; did you mean \"force.x [N]\"",
        ),
        (
            ("from = \"force\"", "from = \"forces\""),
            "fy: unknown joined file \"forces\"; the nearest known is \"force\"",
        ),
        (
            ("stamp [s]", "stump [s]"),
            "no column has the title \"stump [s]\"; did you mean \"stamp [s]\"",
        ),
        (
            ("file = \"{stem}.bag\"", "file = \"{stem.bag\""),
            "map.toml line 6: [join.force]: file: \"{stem.bag\" has a { without }",
        ),
        (
            (
                "\"force.y [N]\", zero_file",
                "\"force.y [N]\", zero_line = 1, zero_file",
            ),
            "leave one of them out",
        ),
        (
            ("formula = \"-fz\"", "value = 1, unit = \"N\", from = \"force\""),
            "from, zero_line and zero_file belong to a column",
        ),
    ] {
        let map = joined();
        assert!(map.contains(change.0), "{}", change.0);
        let said = messages(&join(&map.replace(change.0, change.1)));
        assert!(said.contains(message), "{message} in\n{said}");
    }
    let text = kinematics(0.0).replace("\t1637060001.", "\t1637060000.");
    let files = [
        (RUN, text.as_bytes()),
        ("a/smooth_s20_v10_1.bag", BAG),
        ("a/smooth_zero.bag", ZERO),
    ];
    let said = messages(&all(&files, &[RUN], &joined()));
    assert!(said.contains("its times do not ascend at 1637060000 s"), "{said}");
}

const BAG_MAP: &str = r#"
[recording]
time = "stamp [s]"
time_unit = "s"

[columns]
wheel = { value = "w" }
soil = { value = "s" }
slip = { value = 20, unit = "%" }
wheel_load_n = { formula = "-fz" }
sled_speed_m_s = { value = 10, unit = "mm/s" }
torque_n_m = { column = "torque.y [N m]" }

[quantities]
fz = { column = "force.z [N]", zero_file = "zero.bag" }
"#;

#[test]
fn a_bag_alone_is_a_recording_of_six_axes() {
    let result = all(&[("run.bag", BAG), ("zero.bag", ZERO)], &["run.bag"], BAG_MAP);
    assert_eq!(column(&result, "torque_n_m"), ["0.25"]);
    assert_near(&column(&result, "wheel_load_n")[0], 150.0, 1e-9);
    let source = SourceFile {
        name: "run.bag",
        bytes: BAG,
        is_own: false,
    };
    let proposal = guess(&source, None).expect("a table");
    assert_eq!(proposal.sheet.as_deref(), Some("/ft_sensor"));
    assert_eq!(proposal.components.len(), 6);
    assert_eq!(proposal.columns[0].unit.as_deref(), Some("s"));
    assert_eq!(proposal.columns[7].unit.as_deref(), Some("N m"));
    assert_eq!(proposal.columns[0].sample[0], "1637059999.9");
}

#[test]
fn what_is_wrong_with_a_bag_is_said() {
    let edited = |from: &[u8], to: &[u8]| {
        let mut bytes = BAG.to_vec();
        let places = (0..bytes.len()).filter(|&at| bytes[at..].starts_with(from));
        for at in places.collect::<Vec<_>>() {
            bytes[at..at + to.len()].copy_from_slice(to);
        }
        bytes
    };
    for (bytes, message) in [
        (
            BAG[..BAG.len() / 2].to_vec(),
            "run.bag: the bag ends within a record: copy it again, or run `rosbag reindex`",
        ),
        (
            edited(b"compression=none", b"compression=lz4."),
            "run.bag: the bag is compressed by lz4.: run `rosbag decompress` on it",
        ),
        (
            edited(b"geometry_msgs/WrenchStamped", b"geometry_msgs/TwistedStamp."),
            "run.bag: the bag has no wrench (geometry_msgs/WrenchStamped or geometry_msgs/Wrench); it has geometry_msgs/TwistedStamp., std_msgs/String",
        ),
        (
            b"#ROSBAG V1.2\n and more".to_vec(),
            "run.bag: this is a bag of another format than ROS 1, version 2.0: convert it, as by `rosbags-convert`",
        ),
    ] {
        let said = complaints("run.bag", &bytes, BAG_MAP);
        assert_eq!(said.first().map(String::as_str), Some(message));
    }
    let named = complaints("run.bag", BAG, &format!("sheet = \"/ft\"\n{BAG_MAP}"));
    assert_eq!(named[0], "run.bag: unknown topic \"/ft\"; known are /ft_sensor");
}
