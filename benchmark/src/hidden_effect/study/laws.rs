//! Hidden laws outside the library, as effect files.

use record::Extension;

/// A hidden law.
pub struct HiddenLaw {
    pub name: &'static str,
    /// The quantity and the variable of the law.
    pub dependence: &'static str,
    text: &'static str,
}

macro_rules! law {
    ($name:literal, $dependence:literal) => {
        HiddenLaw {
            name: $name,
            dependence: $dependence,
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

impl HiddenLaw {
    /// Returns the name of the law with its addition to a job.
    pub fn hidden(&self) -> (String, Extension) {
        let extension = Extension::File {
            name: format!("{}.toml", self.name),
            text: self.text.to_owned(),
        };
        (self.name.to_owned(), extension)
    }
}
