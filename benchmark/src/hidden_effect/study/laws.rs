//! Hidden laws outside the library, as effect files, each with its quantity and variable.

use record::Extension;

/// A hidden law: its name, its quantity and variable, its effect file.
pub struct HiddenLaw {
    pub name: &'static str,
    pub dependence: &'static str,
    text: &'static str,
}

/// None depends on load or speed, of which the design has only two levels.
pub const LAWS: [HiddenLaw; 14] = [
    HiddenLaw {
        name: "buried_crust",
        dependence: "pressure_z",
        text: include_str!("../laws/buried_crust.toml"),
    },
    HiddenLaw {
        name: "loose_entry",
        dependence: "pressure_position",
        text: include_str!("../laws/loose_entry.toml"),
    },
    HiddenLaw {
        name: "pore_air",
        dependence: "pressure_v_n",
        text: include_str!("../laws/pore_air.toml"),
    },
    HiddenLaw {
        name: "shaken_bed",
        dependence: "pressure_v_t",
        text: include_str!("../laws/shaken_bed.toml"),
    },
    HiddenLaw {
        name: "remoulded_soil",
        dependence: "pressure_j",
        text: include_str!("../laws/remoulded_soil.toml"),
    },
    HiddenLaw {
        name: "slip_wave",
        dependence: "pressure_slip",
        text: include_str!("../laws/slip_wave.toml"),
    },
    HiddenLaw {
        name: "deep_grip",
        dependence: "shear_z",
        text: include_str!("../laws/deep_grip.toml"),
    },
    HiddenLaw {
        name: "stribeck_dip",
        dependence: "shear_v_t",
        text: include_str!("../laws/stribeck_dip.toml"),
    },
    HiddenLaw {
        name: "dense_peak",
        dependence: "shear_j",
        text: include_str!("../laws/dense_peak.toml"),
    },
    HiddenLaw {
        name: "front_grip",
        dependence: "shear_position",
        text: include_str!("../laws/front_grip.toml"),
    },
    HiddenLaw {
        name: "slip_peak",
        dependence: "shear_slip",
        text: include_str!("../laws/slip_peak.toml"),
    },
    HiddenLaw {
        name: "thrown_soil",
        dependence: "drawbar_pull_slip",
        text: include_str!("../laws/thrown_soil.toml"),
    },
    HiddenLaw {
        name: "chain_drive",
        dependence: "torque_slip",
        text: include_str!("../laws/chain_drive.toml"),
    },
    HiddenLaw {
        name: "sunk_drag",
        dependence: "drawbar_pull_sinkage",
        text: include_str!("../laws/sunk_drag.toml"),
    },
];

impl HiddenLaw {
    /// Its name and its addition to a job.
    pub fn hidden(&self) -> (String, Extension) {
        let extension = Extension::File {
            name: format!("{}.toml", self.name),
            text: self.text.to_owned(),
        };
        (self.name.to_owned(), extension)
    }
}
