//! `experiment.toml`.

use serde_json::{Value, json};
use shared::channel::Channel;
use shared::experiment::{AveragingProtocol, Rig, Scatter};

use super::shape::{above, either, flag, list, named, needing, number, one_of, table, text, usual, whole};

const ANY: f64 = f64::INFINITY;

/// The whole file.
pub(super) fn experiment() -> Value {
    let mut experiment = needing(
        table(
            "wheels, soils, rig and noise of a campaign",
            [
                ("runs", text("file of the test runs, beside the experiment")),
                ("campaign", campaign()),
                ("plates", text("file of plate-sinkage readings")),
                ("shear", text("file of ring-shear readings")),
                ("wheel", named("the wheels, each as [wheel.NAME]", wheel())),
                ("soil", named("the soils, each as [soil.NAME]", soil())),
                ("rig", rig()),
                ("noise", noise()),
                ("protocol", protocol()),
            ],
        ),
        &["soil"],
    );
    experiment["properties"]["soil"]["minProperties"] = json!(1);
    experiment["anyOf"] = json!([
        { "required": ["runs", "wheel"] }, { "required": ["plates"] }, { "required": ["shear"] }
    ]);
    experiment
}

fn campaign() -> Value {
    let campaign = table(
        "where the measurements come from; nothing is computed from it",
        [
            ("title", text("what was measured, as a title")),
            ("authors", list("who measured", text("a name"))),
            ("institution", text("where")),
            (
                "date",
                text("when it was measured, else published: YYYY, YYYY-MM or YYYY-MM-DD"),
            ),
            (
                "licence",
                text("licence of the rows, in words; an SPDX identifier where one says it all"),
            ),
            (
                "doi",
                text("DOI of the publication: 10.1016/j.jterra.2010.08.001"),
            ),
            (
                "source",
                text("file, table or figure that the rows come from, with its version"),
            ),
            (
                "digitised",
                usual(
                    flag("whether the rows were read off figures; needs source"),
                    false,
                ),
            ),
            ("preparation", text("how the soil was prepared before a run")),
            ("wheel", text("material and surface of the wheels")),
            (
                "slip",
                text("how slip was set or measured, and with which radius"),
            ),
            ("sinkage", text("how sinkage was measured, and from which zero")),
            (
                "forces",
                text("sensor, sampling, tare and signs of forces and torque"),
            ),
            ("averaging", text("which part of a run was averaged")),
            (
                "noise",
                text("how the standard deviations under [noise] were found"),
            ),
            (
                "doubts",
                list("what is uncertain about all this", text("a doubt")),
            ),
        ],
    );
    needing(campaign, &["title"])
}

fn wheel() -> Value {
    let rim = [
        (
            "radius_m",
            above(
                "radius of the rim [m]; beside a mesh, the radius that slip and sinkage refer to",
                0.0,
            ),
        ),
        (
            "width_m",
            above("width of the rim [m]; beside a mesh, the width of the lane", 0.0),
        ),
    ];
    let surface = [
        (
            "rig_radius_m",
            above(
                "radius with which the rig converts slip to rim speed [m]; radius_m where nothing is said",
                0.0,
            ),
        ),
        (
            "mesh",
            text("surface in place of rim and grousers, STL or OBJ, for scm"),
        ),
    ];
    let keys = rim
        .into_iter()
        .chain(grousers())
        .chain(grouser_form())
        .chain(surface);
    needing(table("a rigid wheel", keys), &["radius_m", "width_m"])
}

/// Keys of the grousers of a wheel.
fn grousers() -> [(&'static str, Value); 4] {
    let not_negative = |words| usual(number(words, 0.0, ANY), 0.0);
    [
        (
            "grouser_count",
            usual(
                whole("number of grousers, in each row", 0, Some(u64::from(u32::MAX))),
                0,
            ),
        ),
        (
            "grouser_height_m",
            not_negative("height of a grouser above the rim [m]"),
        ),
        (
            "grouser_thickness_m",
            not_negative("thickness of a grouser along the rim [m]"),
        ),
        (
            "grouser_rows",
            usual(
                whole(
                    "number of rows of grousers side by side, each with grouser_count; for scm",
                    1,
                    Some(100),
                ),
                1,
            ),
        ),
    ]
}

/// Keys of the arrangement and the form of the grousers of a wheel.
fn grouser_form() -> [(&'static str, Value); 5] {
    [
        (
            "grouser_stagger",
            usual(
                json!({
                    "type": "number", "minimum": 0, "exclusiveMaximum": 1,
                    "description": "shift of a row against the one to its right, relative to the distance of its grousers",
                }),
                0.0,
            ),
        ),
        (
            "grouser_width_m",
            above(
                "width of the grousers of a row [m]; width_m / grouser_rows where nothing is said",
                0.0,
            ),
        ),
        (
            "grouser_angle_deg",
            bent(
                "angle of the grousers against the axle, positive: the left end is further forward [deg]",
                89.0,
            ),
        ),
        (
            "grouser_chevron_deg",
            bent(
                "angle of either half of a V, positive: its middle enters the soil first [deg]",
                89.0,
            ),
        ),
        (
            "grouser_bow_m",
            bent(
                "how far forward of their middle the grousers' ends lie, on a parabola [m]",
                1.0,
            ),
        ),
    ]
}

/// A number between -`most` and `most`, 0 where nothing is said.
fn bent(words: &str, most: f64) -> Value {
    usual(number(words, -most, most), 0.0)
}

fn soil() -> Value {
    let angle = json!({ "type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 90 });
    table(
        "what is known of a soil besides the parameters",
        [
            ("density_kg_m3", above("bulk density [kg/m^3]", 0.0)),
            (
                "repose_angle_deg",
                super::shape::said(angle, "angle of repose [deg]; 32 in scm where nothing is said"),
            ),
        ],
    )
}

fn rig() -> Value {
    let gravity = Rig::default().gravity_m_s2;
    table(
        "the test rig",
        [
            (
                "gravity_m_s2",
                usual(above("acceleration of gravity [m/s^2]", 0.0), gravity),
            ),
            (
                "bin_length_m",
                above("length of the soil bin along travel [m]", 0.0),
            ),
        ],
    )
}

fn noise() -> Value {
    let of_channel = |channel: Channel| {
        let words = format!(
            "standard deviation of the {} [{}]",
            channel.words(),
            channel.unit()
        );
        let word = one_of("pooled from the repeats, or inferred", ["replicates", "unknown"]);
        (channel.column(), either(&words, vec![above("known", 0.0), word]))
    };
    let of_scatter = |scatter: Scatter| {
        let shape = vec![number("known", 0.0, 1.0), one_of("inferred", ["unknown"])];
        (scatter.key(), either("relative standard deviation", shape))
    };
    let channels = Channel::ALL.map(of_channel).into_iter();
    table(
        "how measurements scatter",
        channels.chain(Scatter::ALL.map(of_scatter)),
    )
}

fn protocol() -> Value {
    let usual_protocol = AveragingProtocol::default();
    let time = |words, value: f64| usual(number(words, 0.0, ANY), value);
    table(
        "how histories become averages",
        [
            (
                "kind",
                usual(
                    one_of("when a simulated run ends", ["steady", "paper"]),
                    usual_protocol.kind,
                ),
            ),
            (
                "measured_transient_s",
                time(
                    "cut from the start of a measured history [s]",
                    usual_protocol.measured_transient_s,
                ),
            ),
            (
                "simulated_transient_force_s",
                time(
                    "cut from simulated forces and torque [s]",
                    usual_protocol.simulated_transient_force_s,
                ),
            ),
            (
                "simulated_transient_sinkage_s",
                time(
                    "cut from the simulated sinkage [s]",
                    usual_protocol.simulated_transient_sinkage_s,
                ),
            ),
            (
                "lowpass_hz",
                time(
                    "cut-off of the low-pass filter [Hz]; 0 is no filter",
                    usual_protocol.lowpass_hz,
                ),
            ),
        ],
    )
}
