//! The wire, message by message, as workers and clients in any language rely on it.

use farm_tests::fake_worker::{FakeWorker, evaluated};
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::json::word;
use farm_tests::service::Service;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use shared::api::{CalibrationState, CalibrationStatus, ErrorBody, ErrorKind, NewCalibration, Position};
use shared::channel::Channel;
use shared::exchange::{ExchangeRequest, ExchangeResponse};
use shared::model::{EffectText, ModelKind, ModelVariant, PlateCondition, RingCondition, SpatialSettings};
use shared::outcome::Outcome;

/// Reads a message from its one form, and asserts that it is written in the same form and read back to the same message.
#[track_caller]
fn golden<T>(form: &Value) -> T
where
    T: Serialize + DeserializeOwned + PartialEq + std::fmt::Debug,
{
    let message: T = serde_json::from_value(form.clone()).expect("the message");
    let written = serde_json::to_value(&message).expect("JSON");
    assert_eq!(&written, form);
    assert_eq!(
        serde_json::from_value::<T>(written).expect("the message"),
        message
    );
    message
}

/// Returns the keys of a message with the kinds of their values, which are the same at every time.
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

#[test]
fn an_exchange_request_has_one_form() {
    let observables = json!({
        "drawbar_pull_n": [12.5], "torque_n_m": [2.25], "sinkage_m": [0.006], "lateral_force_n": [0.0],
        "b_eff_m": [0.03], "contact_length_m": [0.05], "residual_load_n": [1e-9], "nodes_in_contact": [16],
        "simulated_travel_m": [0.0], "settled_to": [0.004], "d_drawbar_pull_n": [-3.5], "d_torque_n_m": [-0.5],
        "d_sinkage_m": [-0.004], "d_lateral_force_n": [0.0], "plate_pressure_pa": [9000.5], "shear_stress_pa": [5000.5],
        "histories": [{"drawbar_pull_n": [12.0, 13.0], "torque_n_m": [2.0, 2.5], "sinkage_m": [0.005, 0.007],
                       "lateral_force_n": [0.0, 0.0]}],
    });
    let request: ExchangeRequest = golden(&json!({
        "worker": "host-1", "protocol": 1, "model_version": "1", "models": {"wheel.py": "command-0a1b"},
        "queue_job": "slurm 12_3", "threads": 8, "evaluation_s": 0.25,
        "results": [
            {"lease": 4_294_967_297_u64, "calibration": 1, "evaluation": 7, "seal": "0a1b", "outcome": {"evaluated": observables}},
            {"lease": 2, "calibration": 1, "evaluation": 7, "seal": "0a1b",
             "outcome": {"rejected": {"kind": "no_support", "condition": 3, "message": "sinkage 0.2 m"}}},
            {"lease": 3, "calibration": 1, "evaluation": 7, "seal": "0a1b", "outcome": {"fault": {"message": "disk full"}}},
            {"lease": 4, "calibration": 1, "evaluation": 8, "seal": "2c3d", "outcome": {"fault": {"message": "no memory"}},
             "repeated": {"drawbar_pull_n": 0.0, "torque_n_m": 0.25, "sinkage_m": 0.0, "lateral_force_n": 0.0,
                          "is_refused": false}},
        ],
        "holding": [9], "returned": [10, 11], "started": [9], "received": 11, "want": 16, "wait_ms": 20_000,
    }));
    let outcomes: Vec<_> = request.results.iter().map(|result| &result.outcome).collect();
    let [
        Outcome::Evaluated(seen),
        Outcome::Rejected(rejection),
        Outcome::Fault(fault),
        Outcome::Fault(_),
    ] = outcomes[..]
    else {
        panic!("{outcomes:?}");
    };
    let [pull, torque, sinkage] =
        [Channel::DrawbarPull, Channel::Torque, Channel::Sinkage].map(|c| seen.channel(c)[0]);
    assert_eq!((pull, torque, sinkage), (12.5, 2.25, 0.006));
    assert_eq!((rejection.condition, fault.message.as_str()), (3, "disk full"));
    assert_eq!(
        request.results[3].repeated.map(|repeated| repeated.torque_n_m),
        Some(0.25)
    );
}

#[test]
fn an_exchange_response_has_one_form() {
    let response: ExchangeResponse = golden(&json!({
        "leases": [{"lease": 5, "calibration": 1, "evaluation": 7, "seal": "0a1b", "variant": "00ff", "theta": [4.5, 0.30000000000000004],
                    "announce": true}],
        "lease_ms": 15_000, "remaining": 40, "in_hand": 2, "workers": 3, "duplicates": 1, "refused": "another version",
    }));
    assert_eq!(response.leases[0].theta, [4.5, 0.1 + 0.2]);
}

#[test]
fn a_variant_has_one_form_and_its_hash_names_it() {
    let variant: ModelVariant = golden(&json!({
        "kind": "quasi_static", "effects": [], "parameters": ["n"], "fixed": {"kappa": 0.0},
        "wheels": {"w": {"radius_m": 0.125, "width_m": 0.112, "grouser_count": 0, "grouser_height_m": 0.0,
                         "grouser_thickness_m": 0.0, "rig_radius_m": 0.125}},
        "gravity_m_s2": 9.81,
        "conditions": [{"wheel": "w", "slip": 0.05, "wheel_load_n": 60.0, "sled_speed_m_s": 0.0095,
                        "slip_angle_deg": 0.0, "pass": 1}],
        "protocol": {"kind": "steady", "measured_transient_s": 40.0, "simulated_transient_force_s": 20.0,
                     "simulated_transient_sinkage_s": 1.0, "lowpass_hz": 0.5},
    }));
    let extended = ModelVariant {
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
    let json = serde_json::to_value(&extended).unwrap();
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
    assert_ne!(variant.hash(), extended.hash());
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

    let effect: EffectText = golden(&json!({"name": "mine", "text": "name = \"mine\""}));
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

    let spatial: SpatialSettings = golden(&json!({
        "dem_spacing_m": 0.004, "travel_step_m": 0.0005, "displacement": "rim", "pressure_direction": "wheel_normal",
        "footprint": "hull", "vertical": "balance", "damping_n_s_m": 2000.0, "steady_tolerance": 0.005, "steady_travel_m": 1.0,
    }));
    assert_eq!(spatial, SpatialSettings::default());
    let rolling = ModelVariant {
        kind: ModelKind::Scm,
        spatial: Some(spatial),
        ..variant.clone()
    };
    assert_ne!(variant.hash(), rolling.hash());
}

#[test]
fn a_status_has_one_form() {
    let status: CalibrationStatus = golden(&json!({
        "id": 3, "name": "sand", "study": 2, "experiment": 1, "state": "running", "message": null,
        "model_kind": "quasi_static", "model_version": "1",
        "progress": {"algorithm": "tmcmc",
                     "position": {"kind": "sampler", "stage": 4, "tempering_exponent": 0.25, "step": 2, "acceptance": 0.5},
                     "evaluations": 1000, "rejected": 10, "step_done": 30, "step_size": 60, "share": 0.5, "search": null, "evaluations_per_s": 500.0, "remaining_s": null},
    }));
    let position = status.progress.map(|progress| progress.position);
    assert!(
        matches!(
            position,
            Some(Position::Sampler {
                stage: 4,
                step: 2,
                ..
            })
        ),
        "{position:?}"
    );
    let names = CalibrationState::ALL
        .iter()
        .map(|state| state.name())
        .collect::<Vec<_>>();
    assert_eq!(
        names.join(" "),
        "queued running paused waiting finished failed cancelled"
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
        let body: ErrorBody =
            golden(&json!({"error": {"type": word, "message": "what, value, unit, bound"}}));
        assert_eq!(body.error.kind, kind);
    }
}

#[test]
fn what_may_be_left_out_of_a_new_calibration_may_and_what_is_unknown_may_not() {
    let short: NewCalibration = serde_json::from_value(json!({"experiment": 1, "toml": ""})).unwrap();
    assert_eq!(
        short,
        golden(&json!({"experiment": 1, "toml": "", "files": {}, "name": null}))
    );
    assert!(
        serde_json::from_value::<NewCalibration>(json!({"experiment": 1, "toml": "", "nam": ""})).is_err()
    );
    assert!(serde_json::from_value::<NewCalibration>(json!({"toml": ""})).is_err());
}

#[test]
fn a_running_coordinator_uses_these_forms() {
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
    assert_eq!(lease["calibration"], json!(id));
    assert_eq!(lease["evaluation"], 0);
    assert!(
        lease["lease"].as_u64() < Some(1 << 53),
        "a double cannot hold {}",
        lease["lease"]
    );
    let hash = word(&lease["variant"]).to_owned();
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
    // A worker is told neither measurements nor held-out runs.
    assert!(!serde_json::to_string(&typed).unwrap().contains("8.4839442"));

    let answer = worker.answer(std::slice::from_ref(lease), |l| evaluated(l, FIT_RUNS));
    assert_eq!(answer["duplicates"], 0);
    assert_eq!(answer["leases"], json!([]));
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
