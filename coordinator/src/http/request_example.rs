//! Examples of bodies for the OpenAPI document. They are those of the example `hidden-effect`, in the order of a first session with the
//! interface.

use serde_json::{Value, json};
use shared::exchange::PROTOCOL_VERSION;

use crate::example::{EXAMPLES, Example};

/// A row of measurements that the example does not contain.
const FURTHER_RUNS: &str =
    "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,torque_n_m,sinkage_m,use
more,w,s,0.25,80.0,0.015,11.9,1.62,0.0071,fit
";

/// Two samples of a recording, which has a row each tenth of a second.
const RECORDING: &str = "t_s,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,torque_n_m,sinkage_m
0.0,0.2,100,0.016,11.2,2.31,0.0082
0.1,0.2,100,0.016,10.1,2.27,0.0085
";

/// Text of an effect file.
const EFFECT: &str = "name = \"stiffer_pull\"
summary = \"the drawbar pull is larger by a constant share\"
source = \"an example\"
drawbar_pull = \"drawbar_pull * (1 + gain)\"

[parameters.gain]
unit = \"1\"
neutral = 0.0
prior = { normal = [0.0, 0.2] }
";

/// A decision whether the wheel climbs a slope.
const DECISION: &str = "[decision]
loss = \"energy_j_m + 200 * stuck\"

[[decision.options]]
name = \"climb\"
condition = { slope_deg = 8 }

[[decision.options]]
name = \"stay\"
loss = \"60\"
";

/// A table with semicolons and decimal commas: slip, load and drawbar pull of one run.
const TABLE_BASE64: &str = "c2xpcCBbJV07bG9hZCBba05dO3B1bGwgW05dCjIwOzAsMTszNSwyCg==";

/// The map of the table's columns.
const MAP: &str = "columns.wheel = { value = \"smooth\" }
columns.soil = { value = \"sand\" }
columns.slip = { column = \"slip [%]\", unit = \"%\" }
columns.wheel_load_n = { column = \"load [kN]\", unit = \"kN\" }
columns.sled_speed_m_s = { value = 8, unit = \"mm/s\" }
columns.drawbar_pull_n = { column = \"pull [N]\", unit = \"N\" }
";

/// Returns a body for the operation with this id; `None` if the operation takes no body.
pub(super) fn request_example(operation: &str) -> Option<Value> {
    let [
        Example {
            name,
            job,
            experiment,
            files,
            ..
        },
        ..,
    ] = EXAMPLES;
    let text_of = |&(name, text): &(&str, &str)| (name.to_owned(), Value::from(text));
    Some(match operation {
        "create_experiment" => {
            let files: serde_json::Map<String, Value> = files.iter().map(text_of).collect();
            json!({"toml": experiment.1, "files": files})
        }
        "check_job" => {
            let files: serde_json::Map<String, Value> = files.iter().map(text_of).collect();
            json!({"experiment": {"toml": experiment.1, "files": files}, "toml": job.1})
        }
        "create_calibration" => json!({"experiment": 1, "toml": job.1, "name": name}),
        "extend_calibration" => json!({"effect": "slip_sinkage"}),
        "describe_study" => {
            json!({"name": "Sand, wheel 3", "author": "A. Meyer", "tags": ["sand", "2026"], "note": null})
        }
        "create_what_if" => json!({"without": ["r00", "r01"]}),
        "predict" => json!({"sweep": "slip=0.05:0.6:12", "statements": ["drawbar_pull_n > 12"]}),
        "decide" => json!({ "file": DECISION }),
        "add_runs" | "follow" => json!({ "runs": FURTHER_RUNS }),
        "stream" => json!({ "recording": RECORDING }),
        "add_effect" | "add_to_library" => json!({ "text": EFFECT }),
        "import_table" => json!({"name": "sand.csv", "content_base64": TABLE_BASE64, "map": MAP}),
        "guess_import_map" => json!({"name": "sand.csv", "content_base64": TABLE_BASE64, "sheet": null}),
        "exchange_work" => json!({
            "worker": "rig-pc-1",
            "protocol": PROTOCOL_VERSION,
            "model_version": "1",
            "threads": 8,
            "results": [],
            "holding": [],
            "returned": [],
            "started": [],
            "received": 0,
            "want": 0,
            "wait_ms": 0,
        }),
        _ => return None,
    })
}
