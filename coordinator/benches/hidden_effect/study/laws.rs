//! Laws that are in nobody's library, as effect files, and what each acts on and depends on.

use record::Extension;

/// A law: its name, the pair of quantity and variable that is right, its effect file.
pub(crate) struct Law {
    pub(crate) name: &'static str,
    pub(crate) pair: &'static str,
    text: &'static str,
}

/// Only what a design of two loads and two speeds can show: none depends on those.
pub(crate) const LAWS: [Law; 14] = [
    Law {
        name: "buried_crust",
        pair: "pressure_z",
        text: include_str!("../laws/buried_crust.toml"),
    },
    Law {
        name: "loose_entry",
        pair: "pressure_position",
        text: include_str!("../laws/loose_entry.toml"),
    },
    Law {
        name: "pore_air",
        pair: "pressure_v_n",
        text: include_str!("../laws/pore_air.toml"),
    },
    Law {
        name: "shaken_bed",
        pair: "pressure_v_t",
        text: include_str!("../laws/shaken_bed.toml"),
    },
    Law {
        name: "remoulded_soil",
        pair: "pressure_j",
        text: include_str!("../laws/remoulded_soil.toml"),
    },
    Law {
        name: "slip_wave",
        pair: "pressure_slip",
        text: include_str!("../laws/slip_wave.toml"),
    },
    Law {
        name: "deep_grip",
        pair: "shear_z",
        text: include_str!("../laws/deep_grip.toml"),
    },
    Law {
        name: "stribeck_dip",
        pair: "shear_v_t",
        text: include_str!("../laws/stribeck_dip.toml"),
    },
    Law {
        name: "dense_peak",
        pair: "shear_j",
        text: include_str!("../laws/dense_peak.toml"),
    },
    Law {
        name: "front_grip",
        pair: "shear_position",
        text: include_str!("../laws/front_grip.toml"),
    },
    Law {
        name: "slip_peak",
        pair: "shear_slip",
        text: include_str!("../laws/slip_peak.toml"),
    },
    Law {
        name: "thrown_soil",
        pair: "drawbar_pull_slip",
        text: include_str!("../laws/thrown_soil.toml"),
    },
    Law {
        name: "chain_drive",
        pair: "torque_slip",
        text: include_str!("../laws/chain_drive.toml"),
    },
    Law {
        name: "sunk_drag",
        pair: "drawbar_pull_sinkage",
        text: include_str!("../laws/sunk_drag.toml"),
    },
];

impl Law {
    /// What a job adds for it.
    pub(crate) fn hidden(&self) -> (String, Extension) {
        let extension = Extension::File {
            name: format!("{}.toml", self.name),
            text: self.text.to_owned(),
        };
        (self.name.to_owned(), extension)
    }
}
