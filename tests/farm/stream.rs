//! A recording that is followed, by a service and by a pipe: the parameters of the soil in time, and its change.

use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::Stdio;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::float;
use farm_tests::programs::{call, coordinator, run, worker};
use farm_tests::random::Random;
use farm_tests::service::Service;
use farm_tests::workspace::text;
use serde_json::{Value, json};

/// Number of samples; the soil changes in the middle.
const SAMPLES: usize = 600;
/// The parameters of the calibrated soil, and those after the change.
const SOILS: [&str; 2] = [
    "k_c = 0.0\nk_phi = 6241438.514219137\nn = 1.1181419899594378\nfriction_angle_deg = 27.871432958177856\nwheel_radius_m = \
     0.12851168438594004\n",
    "k_c = 0.0\nk_phi = 20000000.0\nn = 1.0\nfriction_angle_deg = 33.0\nwheel_radius_m = 0.12851168438594004\n",
];
/// `log10_p_ref`, `n` and `friction_angle_deg` of both.
const TRUTHS: [[f64; 3]; 2] = [[4.559, 1.118, 27.87], [5.301, 1.0, 33.0]];
const CHANNELS: [&str; 3] = ["drawbar_pull_n", "torque_n_m", "sinkage_m"];
const NOISE: [f64; 3] = [2.0, 0.25, 0.0008];

fn slip(sample: usize) -> f64 {
    0.2 + 0.15 * (sample as f64 / 40.0).sin()
}

fn load(sample: usize) -> f64 {
    90.0 + 30.0 * (sample as f64 / 63.0).sin()
}

/// Returns the channels of all samples in one soil.
fn simulated(folder: &Path, soil: &str) -> Vec<[f64; 3]> {
    let write = |name: &str, content: &str| {
        let path = folder.join(name);
        std::fs::write(&path, content).expect("a file");
        path.display().to_string()
    };
    let mut runs = format!(
        "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,{},use\n",
        CHANNELS.join(",")
    );
    for i in 0..SAMPLES {
        let _ = writeln!(runs, "r{i},w,s,{},{},0.02,1,1,0.01,fit", slip(i), load(i));
    }
    write("runs.csv", &runs);
    let out = folder.join("out.csv").display().to_string();
    let experiment = write("experiment.toml", &Job::small().experiment);
    let model = write(
        "model.toml",
        "kind = \"quasi_static\"\nshear_velocity_m_s = 0.001\n",
    );
    let parameters = write("parameters.toml", soil);
    run(worker([
        "simulate",
        &experiment,
        "--model",
        &model,
        "--parameters",
        &parameters,
        "--out",
        &out,
    ]))
    .success();
    let table = text(Path::new(&out));
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let titles: Vec<&str> = lines.next().expect("titles").split(',').collect();
    let columns = CHANNELS.map(|name| titles.iter().position(|title| *title == name).expect("a column"));
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            columns.map(|column| cells[column].parse().expect("a number"))
        })
        .collect()
}

/// Returns a recording whose soil changes at 30 s, as lines; the first has the titles.
fn recording() -> Vec<String> {
    let folder = tempfile::tempdir().expect("a folder");
    let [before, after] = SOILS.map(|soil| simulated(folder.path(), soil));
    let mut random = Random::new(5);
    let mut lines = vec![format!(
        "t_s,slip,wheel_load_n,sled_speed_m_s,{}",
        CHANNELS.join(",")
    )];
    for i in 0..SAMPLES {
        let values = if i < SAMPLES / 2 { before[i] } else { after[i] };
        let mut line = format!("{},{},{},0.02", i as f64 / 10.0, slip(i), load(i));
        for (value, sd) in values.iter().zip(NOISE) {
            // The sum of twelve uniform numbers has a variance of one.
            let sum: f64 = (0..12)
                .map(|_| random.below(1 << 30) as f64 / f64::from(1 << 30))
                .sum();
            let _ = write!(line, ",{}", value + sd * (sum - 6.0));
        }
        lines.push(line);
    }
    lines
}

fn asked(service: &Service, id: i64, body: &Value) -> Value {
    let answer = service
        .client
        .post(&format!("/v1/calibrations/{id}/stream"), body);
    assert_eq!(answer.status, 200, "{}", answer.body);
    serde_json::from_str(&answer.body).expect("JSON")
}

#[test]
fn a_change_of_the_soil_in_a_recording_is_found_with_its_time() {
    let service = Service::start(&["--local-workers", "2"]);
    let id = service.submit(&Job::small().sampler(400, [2, 8], 1));
    service.wait_for(id, "finished");
    let lines = recording();
    let followed = asked(&service, id, &json!({"recording": lines.join("\n")}));
    let changes = followed["changes"].as_array().expect("changes");
    assert_eq!(changes.len(), 1, "{changes:?}");
    assert!((29.0..=31.0).contains(&float(&changes[0]["t_s"])), "{changes:?}");
    assert!(float(&changes[0]["found_s"]) < 35.0, "{changes:?}");
    let times = followed["times"].as_array().expect("times");
    assert_eq!(times.len(), SAMPLES / 10);
    for (at, truth) in [(29, TRUTHS[0]), (59, TRUTHS[1])] {
        for (parameter, truth) in times[at]["parameters"]
            .as_array()
            .expect("parameters")
            .iter()
            .zip(truth)
        {
            let [low, high] = [0, 1].map(|end| float(&parameter["interval"][end]));
            // An interval of 90 % may miss by a part of its width.
            let width = high - low;
            assert!(
                (low - width..=high + width).contains(&truth),
                "{at}: {parameter} {truth}"
            );
        }
    }
    for noise in followed["noise"].as_array().expect("noise") {
        assert!(float(&noise["correlated_samples"]) < 2.5, "{noise}");
    }
    // What is said of a time rests on the samples until then alone.
    let half = asked(&service, id, &json!({"recording": lines[..=300].join("\n")}));
    assert_eq!(half["times"].as_array().expect("times")[..], times[..30]);

    let one = asked(
        &service,
        id,
        &json!({"recording": lines.join("\n"), "parameters": ["friction_angle_deg"]}),
    );
    assert_eq!(
        one["times"][9]["parameters"]
            .as_array()
            .expect("parameters")
            .len(),
        1
    );
    for (body, reason) in [
        (json!({"recording": "t_s,slip\n"}), "no measured channel"),
        (
            json!({"recording": lines[0], "parameters": ["friction"]}),
            "friction_angle_deg",
        ),
        (json!({"recording": lines[0], "wheels": "w"}), "wheels"),
    ] {
        let refused = service
            .client
            .post(&format!("/v1/calibrations/{id}/stream"), &body);
        assert!([400, 422].contains(&refused.status), "{}", refused.status);
        assert_contains!(refused.body, reason);
    }
}

#[test]
fn a_pipe_is_answered_while_it_is_open() {
    let folder = tempfile::tempdir().expect("a folder");
    let job = Job::small().write(&folder.path().join("job"));
    let out = folder.path().join("out").display().to_string();
    call("coordinator run {} --out {}", &[&job, &out]).success();
    let lines = recording();
    let mut command = coordinator(["stream", "1", "--out", &out]);
    let mut program = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut input = program.stdin.take().expect("an input");
    let mut output = BufReader::new(program.stdout.take().expect("an output")).lines();
    let mut send = |part: &[String]| {
        input
            .write_all((part.join("\n") + "\n").as_bytes())
            .expect("the pipe is open");
        input.flush().expect("the pipe is open");
    };
    send(&lines[..=101]);
    let mut next = || output.next().expect("a line").expect("text");
    let first = next();
    assert!(first.starts_with("0.9 s  log10_p_ref"), "{first}");
    for _ in 1..10 {
        next();
    }
    send(&lines[102..]);
    drop(input);
    let rest: Vec<String> = output.map(|line| line.expect("text")).collect();
    assert!(program.wait().expect("an end").success());
    assert!(
        rest.iter()
            .any(|line| line.starts_with("CHANGE of the soil at 30")),
        "{rest:#?}"
    );
    assert!(
        rest.iter().any(|line| line == "1 changes of the soil"),
        "{rest:#?}"
    );
}
