//! Hidden laws outside the library, as effect files.

use record::Extension;

/// A hidden law.
#[derive(Debug)]
pub struct HiddenLaw {
    pub name: &'static str,
    /// The quantity of the law with each variable on which it depends.
    pub dependences: &'static [&'static str],
    text: &'static str,
}

macro_rules! law {
    ($name:literal, $($dependence:literal),+) => {
        HiddenLaw {
            name: $name,
            dependences: &[$($dependence),+],
            text: include_str!(concat!("../laws/", $name, ".toml")),
        }
    };
}

/// No law depends on load or speed, which have only two levels in the design.
pub const LAWS: [HiddenLaw; 14] = [
    law!("buried_crust", "pressure_z"),
    law!("loose_entry", "pressure_position"),
    law!("pore_air", "pressure_v_n"),
    law!("shaken_bed", "pressure_v_t"),
    law!("remoulded_soil", "pressure_j"),
    law!("slip_wave", "pressure_slip"),
    law!("deep_grip", "shear_z"),
    law!("stribeck_dip", "shear_v_t"),
    law!("dense_peak", "shear_j"),
    law!("front_grip", "shear_position"),
    law!("slip_peak", "shear_slip"),
    law!("thrown_soil", "drawbar_pull_slip"),
    law!("chain_drive", "torque_slip"),
    law!("sunk_drag", "drawbar_pull_sinkage"),
];

/// Products of a factor of one variable and a factor of another.
pub const LAWS_OF_TWO_VARIABLES: [HiddenLaw; 6] = [
    law!("churned_depth", "shear_z", "shear_v_t"),
    law!("sheared_load", "pressure_j", "pressure_wheel_load"),
    law!("pumped_depth", "pressure_z", "pressure_v_n"),
    law!("front_slip", "shear_position", "shear_slip"),
    law!("ploughed_load", "drawbar_pull_slip", "drawbar_pull_wheel_load"),
    law!("loaded_chain", "torque_slip", "torque_wheel_load"),
];

impl HiddenLaw {
    /// Returns the law of a name.
    pub fn find(name: &str) -> Option<&'static Self> {
        let mut all = LAWS.iter().chain(&LAWS_OF_TWO_VARIABLES);
        all.find(|law| law.name == name)
    }

    /// Returns whether a dependence that a search found has the quantity of the law.
    pub fn has_quantity(&self, found: &str) -> bool {
        let quantity = |dependence: &str| dependence.split('_').next().unwrap_or_default().to_owned();
        self.dependences
            .iter()
            .any(|stated| quantity(stated) == quantity(found))
    }

    /// Returns the name of the law with its addition to a job.
    pub fn hidden(&self) -> (String, Extension) {
        let extension = Extension::File {
            name: format!("{}.toml", self.name),
            text: self.text.to_owned(),
        };
        (self.name.to_owned(), extension)
    }
}
