//! The description of a unit, as XML.

use std::fmt::Write;

use shared::model::DrawnModel;

/// A variable: its value reference, name, unit, what it is, and whether it is an input.
type Variable = (u32, &'static str, Option<&'static str>, &'static str);

/// Inputs in the order of their value references, which the library knows.
const INPUTS: [Variable; 4] = [
    (1, "slip", None, "slip by the radius of the rig, in [-1, 1)"),
    (
        2,
        "wheel_load_n",
        Some("N"),
        "load of the wheel normal to the ground",
    ),
    (3, "sled_speed_m_s", Some("m/s"), "speed of travel"),
    (4, "slip_angle_deg", Some("deg"), "from wheel heading to travel"),
];
const OUTPUTS: [Variable; 4] = [
    (
        5,
        "drawbar_pull_n",
        Some("N"),
        "net force of the wheel along its heading",
    ),
    (6, "torque_n_m", Some("N.m"), "torque at the axle"),
    (
        7,
        "sinkage_m",
        Some("m"),
        "radius minus hub height above the undisturbed surface",
    ),
    (8, "lateral_force_n", Some("N"), "force across the wheel"),
];

const UNITS: &str = r#"  <UnitDefinitions>
    <Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit>
    <Unit name="N.m"><BaseUnit kg="1" m="2" s="-2"/></Unit>
    <Unit name="m"><BaseUnit m="1"/></Unit>
    <Unit name="s"><BaseUnit s="1"/></Unit>
    <Unit name="m/s"><BaseUnit m="1" s="-1"/></Unit>
    <Unit name="deg"><BaseUnit rad="1" factor="0.017453292519943295"/></Unit>
  </UnitDefinitions>
"#;

/// Returns `modelDescription.xml` of a model with one condition.
///
/// # Source
/// Modelica Association 2023, *Functional Mock-up Interface Specification*, version 3.0.1, section 2.4. Checked by `tests/fmu`, where FMPy
/// validates it by the schema of the standard.
pub(super) fn description(model: &DrawnModel) -> String {
    let mut xml = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <fmiModelDescription fmiVersion=\"3.0\" modelName=\"{name}\" instantiationToken=\"{token}\" version=\"{version}\" \
         generationTool=\"Grouser {tool}\" variableNamingConvention=\"flat\" \
         description=\"averages of a steady run of a calibrated wheel\">\n\
         \x20 <CoSimulation modelIdentifier=\"grouser\" canHandleVariableCommunicationStepSize=\"true\"/>\n{UNITS}\
         \x20 <DefaultExperiment startTime=\"0\" stepSize=\"0.1\"/>\n\x20 <ModelVariables>\n\
         \x20   <Float64 name=\"time\" valueReference=\"0\" causality=\"independent\" variability=\"continuous\" unit=\"s\"/>\n",
        name = escaped(&model.name),
        token = escaped(&model.token),
        version = escaped(&model.model_version),
        tool = env!("CARGO_PKG_VERSION"),
    );
    let condition = model.variant.conditions.first();
    let start = condition.map_or([0.0; 4], |c| {
        [c.slip, c.wheel_load_n, c.sled_speed_m_s, c.slip_angle_deg]
    });
    let unit = |unit: Option<&str>| unit.map_or_else(String::new, |unit| format!(" unit=\"{unit}\""));
    let mut add = |(reference, name, of, what): Variable, rest: String| {
        let of = unit(of);
        // Writing to a text cannot fail.
        let _ = writeln!(
            xml,
            "    <Float64 name=\"{name}\" valueReference=\"{reference}\" {rest}{of} description=\"{what}\"/>"
        );
    };
    for (input, start) in INPUTS.into_iter().zip(start) {
        add(
            input,
            format!("causality=\"input\" variability=\"discrete\" start=\"{start}\""),
        );
    }
    for output in OUTPUTS {
        add(output, "causality=\"output\" variability=\"discrete\"".into());
    }
    let last = model.draws.len();
    let _ = writeln!(
        xml,
        "    <Int32 name=\"draw\" valueReference=\"9\" causality=\"parameter\" variability=\"tunable\" start=\"0\" min=\"0\" max=\"{last}\" \
         description=\"number of a draw of the posterior, from 1; 0: the mean over all draws\"/>"
    );
    xml += "  </ModelVariables>\n  <ModelStructure>\n";
    // Initial values also follow from the parameter, the draw.
    for (tag, dependencies) in [("Output", "1 2 3 4"), ("InitialUnknown", "1 2 3 4 9")] {
        for (reference, ..) in OUTPUTS {
            let _ = writeln!(
                xml,
                "    <{tag} valueReference=\"{reference}\" dependencies=\"{dependencies}\"/>"
            );
        }
    }
    xml + "  </ModelStructure>\n</fmiModelDescription>\n"
}

fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn initial_values_depend_on_the_draw() {
        let xml = description(&super::super::fixture::model());
        assert!(xml.contains("<Output valueReference=\"5\" dependencies=\"1 2 3 4\"/>"));
        assert!(xml.contains("<InitialUnknown valueReference=\"8\" dependencies=\"1 2 3 4 9\"/>"));
    }

    #[test]
    fn names_are_escaped() {
        assert_eq!(escaped("a<b & \"c\">"), "a&lt;b &amp; &quot;c&quot;&gt;");
    }
}
