//! The wire, message by message: what a worker or client in any language may rely on.

use farm_tests::fake_worker::{FakeWorker, evaluated};
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::service::Service;
use serde_json::{Value, json};
use shared::api::{
    CalibrationState, CalibrationStatus, ErrorBody, ErrorDetail, ErrorKind, NewCalibration, Position,
    Progress,
};
use shared::channel::Channel;
use shared::exchange::{ExchangeRequest, ExchangeResponse, Lease, RepeatedAnswer, WorkResult};
use shared::experiment::WheelGeometry;
use shared::model::{
    EffectText, ModelKind, ModelVariant, PlateCondition, RingCondition, RunCondition, SpatialSettings,
};
use shared::outcome::{Fault, Observables, Outcome, ParameterRejection, SimulatedHistory};
use statistics::{Subchain, SubchainEnd};

/// A message has one form: it is written so, and read back to the same.
#[track_caller]
fn golden<T>(message: &T, form: &Value)
where
    T: serde::Serialize + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug,
{
    assert_eq!(&serde_json::to_value(message).expect("JSON"), form);
    assert_eq!(
        &serde_json::from_value::<T>(form.clone()).expect("the message"),
        message
    );
}

/// Keys and kinds of a message, numbers and text redacted: what does not depend on the moment.
fn shape(value: &Value) -> Value {
    match value {
        Value::Object(table) => table.iter().map(|(k, v)| (k.clone(), shape(v))).collect(),
        Value::Array(list) => Value::Array(list.first().map(shape).into_iter().collect()),
        Value::Number(n) if n.is_f64() => "number".into(),
        Value::Number(_) => "whole".into(),
        Value::String(_) => "text".into(),
        other => other.clone(),
    }
}

fn observables() -> Observables {
    Observables {
        drawbar_pull_n: vec![12.5],
        torque_n_m: vec![2.25],
        sinkage_m: vec![0.006],
        lateral_force_n: vec![0.0],
        b_eff_m: vec![0.03],
        contact_length_m: vec![0.05],
        residual_load_n: vec![1e-9],
        nodes_in_contact: vec![16],
        simulated_travel_m: vec![0.0],
        settled_to: vec![0.004],
        d_drawbar_pull_n: vec![-3.5],
        d_torque_n_m: vec![-0.5],
        d_sinkage_m: vec![-0.004],
        d_lateral_force_n: vec![0.0],
        plate_pressure_pa: vec![9000.5],
        shear_stress_pa: vec![5000.5],
        coarse: Some(vec![11.5]),
        histories: vec![SimulatedHistory {
            drawbar_pull_n: vec![12.0, 13.0],
            torque_n_m: vec![2.0, 2.5],
            sinkage_m: vec![0.005, 0.007],
            lateral_force_n: vec![0.0, 0.0],
        }],
    }
}

fn observables_json() -> Value {
    json!({
        "drawbar_pull_n": [12.5], "torque_n_m": [2.25], "sinkage_m": [0.006], "lateral_force_n": [0.0],
        "b_eff_m": [0.03], "contact_length_m": [0.05], "residual_load_n": [1e-9], "nodes_in_contact": [16],
        "simulated_travel_m": [0.0], "settled_to": [0.004], "d_drawbar_pull_n": [-3.5], "d_torque_n_m": [-0.5],
        "d_sinkage_m": [-0.004], "d_lateral_force_n": [0.0], "plate_pressure_pa": [9000.5], "shear_stress_pa": [5000.5],
        "coarse": [11.5],
        "histories": [{"drawbar_pull_n": [12.0, 13.0], "torque_n_m": [2.0, 2.5], "sinkage_m": [0.005, 0.007],
                       "lateral_force_n": [0.0, 0.0]}],
    })
}

#[test]
fn an_exchange_request_has_one_form() {
    let rejection = ParameterRejection {
        kind: "no_support".into(),
        condition: 3,
        message: "sinkage 0.2 m".into(),
    };
    let result = |lease, outcome| WorkResult {
        lease,
        calibration: 1,
        evaluation: 7,
        seal: "0a1b".into(),
        end: None,
        outcome: Some(outcome),
        repeated: None,
    };
    let stayed = WorkResult {
        lease: 4,
        calibration: 1,
        evaluation: 8,
        seal: "2c3d".into(),
        end: Some(SubchainEnd {
            theta: vec![1.5],
            log_gain: 0.25,
            moves: 20,
            accepted: 0,
            scaled: 17,
            scaled_accepted: 0,
        }),
        outcome: None,
        repeated: Some(RepeatedAnswer {
            torque_n_m: 0.25,
            ..RepeatedAnswer::default()
        }),
    };
    let request = ExchangeRequest {
        worker: "host-1".into(),
        protocol: 1,
        model_version: "1".into(),
        models: [("wheel.py".to_owned(), "command-0a1b".to_owned())].into(),
        queue_job: Some("slurm 12_3".into()),
        threads: 8,
        evaluation_s: Some(0.25),
        results: vec![
            result(4_294_967_297, Outcome::Evaluated(observables())),
            result(2, Outcome::Rejected(rejection)),
            result(
                3,
                Outcome::Fault(Fault {
                    message: "disk full".into(),
                }),
            ),
            stayed,
        ],
        holding: vec![9],
        returned: vec![10, 11],
        started: vec![9],
        received: 11,
        want: 16,
        wait_ms: 20_000,
    };
    golden(
        &request,
        &json!({
            "worker": "host-1", "protocol": 1, "model_version": "1", "models": {"wheel.py": "command-0a1b"},
            "queue_job": "slurm 12_3", "threads": 8, "evaluation_s": 0.25,
            "results": [
                {"lease": 4_294_967_297_u64, "calibration": 1, "evaluation": 7, "seal": "0a1b",
                 "outcome": {"evaluated": observables_json()}},
                {"lease": 2, "calibration": 1, "evaluation": 7, "seal": "0a1b",
                 "outcome": {"rejected": {"kind": "no_support", "condition": 3, "message": "sinkage 0.2 m"}}},
                {"lease": 3, "calibration": 1, "evaluation": 7, "seal": "0a1b", "outcome": {"fault": {"message": "disk full"}}},
                {"lease": 4, "calibration": 1, "evaluation": 8, "seal": "2c3d", "end": {"theta": [1.5], "log_gain": 0.25, "moves": 20,
                 "accepted": 0, "scaled": 17, "scaled_accepted": 0},
                 "repeated": {"drawbar_pull_n": 0.0, "torque_n_m": 0.25, "sinkage_m": 0.0, "lateral_force_n": 0.0,
                              "is_refused": false}},
            ],
            "holding": [9], "returned": [10, 11], "started": [9], "received": 11, "want": 16, "wait_ms": 20_000,
        }),
    );
}

#[test]
fn an_exchange_response_has_one_form() {
    let lease = Lease {
        lease: 5,
        calibration: 1,
        evaluation: 7,
        seal: "0a1b".into(),
        variant: "00ff".into(),
        theta: vec![4.5, 0.1 + 0.2],
        announce: true,
        subchain: Some(Subchain {
            chain: 3,
            step: 2,
            scale: 0.75,
        }),
    };
    let response = ExchangeResponse {
        leases: vec![lease],
        lease_ms: 15_000,
        remaining: 40,
        in_hand: 2,
        workers: 3,
        duplicates: 1,
        refused: Some("another version".into()),
    };
    golden(
        &response,
        &json!({
            "leases": [{"lease": 5, "calibration": 1, "evaluation": 7, "seal": "0a1b", "variant": "00ff", "theta": [4.5, 0.30000000000000004],
                        "announce": true,
                        "subchain": {"chain": 3, "step": 2, "scale": 0.75}}],
            "lease_ms": 15_000, "remaining": 40, "in_hand": 2, "workers": 3, "duplicates": 1, "refused": "another version",
        }),
    );
}

#[test]
fn a_variant_has_one_form_and_its_hash_names_it() {
    let wheel = WheelGeometry {
        radius_m: 0.125,
        width_m: 0.112,
        grouser_count: 0,
        grouser_height_m: 0.0,
        grouser_thickness_m: 0.0,
        rig_radius_m: 0.125,
        mesh: None,
        tread: None,
    };
    let condition = RunCondition {
        wheel: "w".into(),
        slip: 0.05,
        wheel_load_n: 60.0,
        sled_speed_m_s: 0.0095,
        slip_angle_deg: 0.0,
        pass: 1,
        repose_angle_deg: None,
        density_kg_m3: None,
        order: None,
    };
    let variant = ModelVariant {
        kind: ModelKind::QuasiStatic,
        spatial: None,
        rolls_grousers: false,
        external: None,
        effects: Vec::new(),
        parameters: vec!["n".into()],
        fixed: [("kappa".to_owned(), 0.0)].into(),
        wheels: [("w".to_owned(), wheel)].into(),
        gravity_m_s2: 9.81,
        bin_length_m: None,
        conditions: vec![condition],
        protocol: Default::default(),
        channels: Vec::new(),
        stiffness_sensitivity: false,
        histories: false,
        plates: Vec::new(),
        probe: Vec::new(),
        low_fidelity: None,
        rings: Vec::new(),
    };
    golden(
        &variant,
        &json!({
            "kind": "quasi_static", "effects": [], "parameters": ["n"], "fixed": {"kappa": 0.0},
            "wheels": {"w": {"radius_m": 0.125, "width_m": 0.112, "grouser_count": 0, "grouser_height_m": 0.0,
                             "grouser_thickness_m": 0.0, "rig_radius_m": 0.125}},
            "gravity_m_s2": 9.81,
            "conditions": [{"wheel": "w", "slip": 0.05, "wheel_load_n": 60.0, "sled_speed_m_s": 0.0095,
                            "slip_angle_deg": 0.0, "pass": 1}],
            "protocol": {"kind": "steady", "measured_transient_s": 40.0, "simulated_transient_force_s": 20.0,
                         "simulated_transient_sinkage_s": 1.0, "lowpass_hz": 0.5},
        }),
    );
    let asked = ModelVariant {
        channels: vec![Channel::DrawbarPull, Channel::Sinkage],
        stiffness_sensitivity: true,
        histories: true,
        plates: vec![PlateCondition {
            plate_radius_m: 0.05,
            sinkage_m: 0.01,
        }],
        rings: vec![RingCondition {
            normal_stress_pa: 2e4,
            shear_displacement_m: 0.012,
        }],
        ..variant.clone()
    };
    let json = serde_json::to_value(&asked).unwrap();
    assert_eq!(json["channels"], json!(["drawbar_pull", "sinkage"]));
    assert_eq!(json["stiffness_sensitivity"], true);
    assert_eq!(json["histories"], true);
    assert_eq!(
        json["plates"],
        json!([{"plate_radius_m": 0.05, "sinkage_m": 0.01}])
    );
    assert_eq!(
        json["rings"],
        json!([{"normal_stress_pa": 2e4, "shear_displacement_m": 0.012}])
    );
    assert_ne!(variant.hash(), asked.hash());
    assert_eq!(variant.hash(), variant.clone().hash());
    let other = ModelVariant {
        gravity_m_s2: 1.62,
        ..variant.clone()
    };
    assert_ne!(variant.hash(), other.hash());
    assert_eq!(variant.hash().len(), 32);

    let rolled = ModelVariant {
        rolls_grousers: true,
        ..variant.clone()
    };
    assert_eq!(serde_json::to_value(&rolled).unwrap()["rolls_grousers"], true);
    assert_ne!(variant.hash(), rolled.hash());

    let effect = EffectText {
        name: "mine".into(),
        text: "name = \"mine\"".into(),
    };
    golden(&effect, &json!({"name": "mine", "text": "name = \"mine\""}));
    let with = ModelVariant {
        effects: vec![effect],
        bin_length_m: Some(1.5),
        ..variant.clone()
    };
    assert_eq!(serde_json::to_value(&with).unwrap()["bin_length_m"], 1.5);
    assert_ne!(variant.hash(), with.hash());
    assert_eq!(variant.model_version("scm"), "scm");
    // printf 'name = "mine"' | sha256sum
    assert_eq!(with.model_version("scm"), "scm+effects.3fd69817");

    let spatial = SpatialSettings::default();
    golden(
        &spatial,
        &json!({"dem_spacing_m": 0.004, "travel_step_m": 0.0005, "displacement": "rim",
                "pressure_direction": "wheel_normal", "footprint": "hull", "vertical": "balance",
                "damping_n_s_m": 2000.0,
                "steady_tolerance": 0.005, "steady_travel_m": 1.0}),
    );
    let rolling = ModelVariant {
        kind: ModelKind::Scm,
        spatial: Some(spatial),
        ..variant.clone()
    };
    assert_ne!(variant.hash(), rolling.hash());
}

#[test]
fn a_status_has_one_form() {
    let status = CalibrationStatus {
        id: 3,
        name: "sand".into(),
        study: 2,
        experiment: 1,
        state: CalibrationState::Running,
        message: None,
        model_kind: Some("quasi_static".into()),
        model_version: Some("1".into()),
        progress: Some(Progress {
            algorithm: "tmcmc".into(),
            position: Position::Sampler {
                stage: 4,
                tempering_exponent: 0.25,
                step: 2,
                acceptance: Some(0.5),
            },
            evaluations: 1000,
            rejected: 10,
            step_done: 30,
            step_size: 60,
            evaluations_per_s: 500.0,
            remaining_s: None,
        }),
    };
    golden(
        &status,
        &json!({
            "id": 3, "name": "sand", "study": 2, "experiment": 1, "state": "running", "message": null,
            "model_kind": "quasi_static", "model_version": "1",
            "progress": {"algorithm": "tmcmc",
                         "position": {"kind": "sampler", "stage": 4, "tempering_exponent": 0.25, "step": 2, "acceptance": 0.5},
                         "evaluations": 1000, "rejected": 10, "step_done": 30, "step_size": 60, "evaluations_per_s": 500.0, "remaining_s": null},
        }),
    );
    let names: Vec<&str> = CalibrationState::ALL.iter().map(|s| s.name()).collect();
    assert_eq!(
        names,
        [
            "queued",
            "running",
            "paused",
            "waiting",
            "finished",
            "failed",
            "cancelled"
        ]
    );
}

#[test]
fn errors_are_a_closed_list() {
    for (kind, word) in [
        (ErrorKind::InvalidBody, "invalid_body"),
        (ErrorKind::UnsupportedMediaType, "unsupported_media_type"),
        (ErrorKind::InvalidFile, "invalid_file"),
        (ErrorKind::NotFound, "not_found"),
        (ErrorKind::Conflict, "conflict"),
        (ErrorKind::TooLarge, "too_large"),
        (ErrorKind::ProtocolMismatch, "protocol_mismatch"),
        (ErrorKind::Busy, "busy"),
        (ErrorKind::Internal, "internal"),
    ] {
        let body = ErrorBody {
            error: ErrorDetail {
                kind,
                message: "what, value, unit, bound".into(),
            },
        };
        golden(
            &body,
            &json!({"error": {"type": word, "message": "what, value, unit, bound"}}),
        );
    }
}

#[test]
fn what_may_be_left_out_of_a_new_calibration_may_and_what_is_unknown_may_not() {
    let short: NewCalibration = serde_json::from_value(json!({"experiment": 1, "toml": ""})).unwrap();
    golden(
        &short,
        &json!({"experiment": 1, "toml": "", "files": {}, "name": null}),
    );
    assert!(
        serde_json::from_value::<NewCalibration>(json!({"experiment": 1, "toml": "", "nam": ""})).is_err()
    );
    assert!(serde_json::from_value::<NewCalibration>(json!({"toml": ""})).is_err());
}

#[test]
fn a_living_coordinator_speaks_these_forms() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "any");
    let mut request = worker.request();
    request["want"] = 1.into();
    let response = worker.exchange(&request);
    assert_eq!(
        shape(&response),
        json!({
            "leases": [{"lease": "whole", "calibration": "whole", "evaluation": "whole", "seal": "text",
                        "variant": "text", "theta": ["number"], "announce": false}],
            "lease_ms": "whole", "remaining": "whole", "in_hand": "whole", "workers": "whole", "duplicates": "whole", "refused": null,
        })
    );
    let lease = &response["leases"][0];
    assert_eq!(
        (&lease["calibration"], &lease["evaluation"]),
        (&json!(id), &json!(0))
    );
    assert!(
        lease["lease"].as_u64() < Some(1 << 53),
        "a double cannot hold {}",
        lease["lease"]
    );
    let hash = lease["variant"].as_str().expect("a hash").to_owned();
    let variant = service.client.json(&format!("/v1/work/variants/{hash}"));
    let typed: ModelVariant = serde_json::from_value(variant).unwrap();
    assert_eq!(typed.hash(), hash);
    assert_eq!(typed.conditions.len(), FIT_RUNS);
    assert_eq!(
        typed.parameters,
        ["log10_p_ref", "n", "friction_angle_deg", "wheel_radius_m"]
    );
    assert_eq!(
        lease["theta"].as_array().map(Vec::len),
        Some(typed.parameters.len())
    );
    // A worker never sees measurements: holdout rows are not even named.
    assert!(!serde_json::to_string(&typed).unwrap().contains("8.4839442"));

    let answer = worker.answer(std::slice::from_ref(lease), |l| evaluated(l, FIT_RUNS));
    assert_eq!(
        (&answer["duplicates"], &answer["leases"]),
        (&json!(0), &json!([]))
    );
    let status: CalibrationStatus = serde_json::from_value(service.status(id)).unwrap();
    assert_eq!(status.state, CalibrationState::Running);
    assert_eq!(status.progress.map(|p| p.evaluations), Some(1));
    let workers = service.client.json("/v1/workers");
    assert_eq!(
        shape(&workers),
        json!({"any": {"model_version": "text", "threads": "whole", "holds": "whole", "completed": "whole", "faults": "whole", "quarantined": null, "silent_ms": "whole"}})
    );
}

#[test]
fn every_error_type_has_its_status() {
    let service = Service::start(&[]);
    service.submit(&Job::small());
    let client = &service.client;
    let mut old = FakeWorker::new(client, "old").request();
    old["protocol"] = 0.into();
    let none = json!({});
    for (status, kind, response) in [
        (400, "invalid_body", client.post_text("/v1/experiments", "{")),
        (
            422,
            "invalid_file",
            client.post("/v1/experiments", &json!({"toml": "wheel = 1"})),
        ),
        (404, "not_found", client.get("/v1/calibrations/5")),
        (409, "conflict", client.post("/v1/calibrations/1/resume", &none)),
        (426, "protocol_mismatch", client.post("/v1/work/exchange", &old)),
    ] {
        assert_eq!(response.status, status, "{}", response.body);
        let body: ErrorBody = serde_json::from_str(&response.body).expect("the form of every error");
        assert_eq!(serde_json::to_value(body.error.kind).expect("a word"), kind);
        assert!(!body.error.message.is_empty());
        assert_eq!(response.header("content-type"), Some("application/json"));
    }
}
