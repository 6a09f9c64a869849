//! The table `[model]`, and each of `[[models]]`.

use formula::catalogue::catalogue;
use serde_json::{Value, json};
use shared::channel::Channel;
use shared::model::{ModelKind, RunInput, SpatialSettings, grouser_key};

use super::prior;
use super::shape::{above, list, needing, number, one_of, table, text, usual, whole};

/// The keys with their shapes; parameters that have a fixed value among them.
pub(super) fn model() -> Value {
    let kinds = ModelKind::ALL.map(ModelKind::name);
    let names = catalogue().iter().map(|effect| effect.name.as_str());
    let mut model = needing(
        table(
            "the forward model, with parameters that are fixed",
            [
                ("kind", one_of("which forward model", kinds)),
                (
                    "effects",
                    list("effects of the catalogue", one_of("an effect", names)),
                ),
                (
                    "effect_files",
                    list("files of further effects", text("file name")),
                ),
            ],
        ),
        &["kind"],
    );
    let keys = std::iter::once(grousers())
        .chain(terrain())
        .chain(motion())
        .chain(external());
    let keys = keys.map(|(key, shape)| (key.to_owned(), shape));
    for (key, shape) in keys.chain(prior::values()) {
        model["properties"][key] = shape;
    }
    model["patternProperties"] = prior::dotted_values();
    // A model that is not ours has parameters of its own; ours have those above.
    model["additionalProperties"] = json!({ "type": "number" });
    model["if"] = is_external();
    model["else"] = json!({ "propertyNames": prior::names_of(&model) });
    model
}

/// Whether a table `[model]` is of a model that is not ours.
pub(super) fn is_external() -> Value {
    let external = ModelKind::ALL.into_iter().filter(|kind| kind.is_external());
    let names: Vec<&str> = external.map(ModelKind::name).collect();
    json!({ "properties": { "kind": { "enum": names } }, "required": ["kind"] })
}

/// The setting of `kind = "quasi_static"`.
fn grousers() -> (&'static str, Value) {
    let [ignored, rolled] = grouser_key::WORDS;
    let shape = one_of(
        "quasi_static: whether the grousers that wheels have are ignored (a smooth rim) or rolled",
        [ignored, rolled],
    );
    (grouser_key::KEY, usual(shape, ignored))
}

/// Keys of the terrain in `scm`.
fn terrain() -> [(&'static str, Value); 5] {
    let settings = SpatialSettings::default();
    [
        (
            "dem_spacing_m",
            usual(
                above("scm: spacing of the terrain's nodes [m]", 0.0),
                settings.dem_spacing_m,
            ),
        ),
        (
            "travel_step_m",
            usual(above("scm: travel of one step [m]", 0.0), settings.travel_step_m),
        ),
        (
            "displacement",
            usual(
                one_of("scm: where the shear displacement is kept", ["rim", "node"]),
                settings.displacement,
            ),
        ),
        (
            "pressure_direction",
            usual(
                one_of(
                    "scm: normal along which the pressure acts",
                    ["wheel_normal", "vertical"],
                ),
                settings.pressure_direction,
            ),
        ),
        (
            "footprint",
            usual(
                one_of(
                    "scm: whose effective width the nodes of a footprint have",
                    ["hull", "patches"],
                ),
                settings.footprint,
            ),
        ),
    ]
}

/// Keys of the motion of the wheel in `scm`.
fn motion() -> [(&'static str, Value); 4] {
    let settings = SpatialSettings::default();
    [
        (
            "vertical",
            usual(
                one_of("scm: how the hub finds its height", ["balance", "dynamic"]),
                settings.vertical,
            ),
        ),
        (
            "damping_n_s_m",
            usual(
                number(
                    "scm, vertical = \"dynamic\": damping of the hub [N s/m]",
                    0.0,
                    f64::INFINITY,
                ),
                settings.damping_n_s_m,
            ),
        ),
        (
            "steady_tolerance",
            usual(
                above(
                    "scm: what the averages of a steady run may still have to go when it ends",
                    0.0,
                ),
                settings.steady_tolerance,
            ),
        ),
        (
            "steady_travel_m",
            usual(
                above("scm: travel at which a steady run ends in any case [m]", 0.0),
                settings.steady_travel_m,
            ),
        ),
    ]
}

/// What describes a model that is not ours.
fn external() -> [(&'static str, Value); 9] {
    let inputs = one_of("a property of a run", RunInput::ALL.map(RunInput::name));
    let outputs = one_of("a channel", Channel::ALL.map(Channel::column));
    [
        (
            "program",
            text("command: name of the program's file; the worker's operator says where it lies"),
        ),
        ("url", text("umbridge: URL of the server")),
        ("model", text("umbridge: name of the model there")),
        (
            "version",
            text("command, umbridge: version of the model; letters, digits, \".\", \"_\" and \"-\""),
        ),
        (
            "inputs",
            list(
                "command, umbridge: what it is told of a run, in its order",
                inputs,
            ),
        ),
        (
            "parameters",
            list(
                "command, umbridge: its parameters in its order, \"name [unit]\"",
                text("name and unit"),
            ),
        ),
        (
            "outputs",
            list("command, umbridge: what it gives, in its order", outputs),
        ),
        (
            "time_s",
            usual(above("command, umbridge: longest time of one run [s]", 0.0), 60.0),
        ),
        (
            "memory_mb",
            usual(whole("command: address space of the program [MB]", 1, None), 4096),
        ),
    ]
}
