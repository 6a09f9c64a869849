//! The runs of an experiment, and its files.

use shared::file::FileSet;

use super::wheel_size::WheelSize;

/// Measured channels: drawbar pull, torque, sinkage.
pub const CHANNELS: usize = 3;
/// The priors of the quasi-static model, from which truths are drawn.
const PRIORS: &str = "log10_p_ref = { uniform = [4.0, 5.6] }\nkappa = { normal = [0.0, 0.3], bounds = [-0.8, 2.0] }\nn = { normal = [1.1, 0.2], bounds = [0.8, 2.0] }\nfriction_angle_deg = { normal = [30.0, 5.7], bounds = [11.5, 37.3] }\n";
/// The priors of the three-dimensional model. The soils carry the wheel, and kappa is fixed because one wheel does not determine it.
const SPATIAL_PRIORS: &str = "log10_p_ref = { uniform = [4.6, 5.4] }\nkappa = 0.0\nn = { normal = [1.1, 0.1], bounds = [0.8, 2.0] }\nfriction_angle_deg = { normal = [30.0, 4.0], bounds = [15.0, 37.3] }\n";
/// The three-dimensional model with its default settings.
const ROLLING: &str = "kind = \"scm\"\n";
/// Short rolling on a coarse grid, because the trials test the search and not the physics.
const SPATIAL: &str = "kind = \"scm\"\ndem_spacing_m = 0.012\ntravel_step_m = 0.003\nsteady_travel_m = 0.3\nsteady_tolerance = 0.01\n";

/// A design of runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plan {
    /// Six slips, two loads, two speeds of the rim.
    Full,
    /// As `Full`, with a second pass in every second run.
    Passes,
    /// As `Full`, with a smaller wheel in every second run.
    Wheels,
    /// As `Full`, with the radius of the wheel fixed at the stated one.
    Fixed,
    /// Eight runs: four slips and two loads, with the speed of the rim alternating between two.
    Sparse,
    /// Four slips, two loads, three speeds of the rim: the factorial of examples/hidden-effect.
    Factorial,
    /// Six slips at one load and one speed, which leave many effects ambiguous.
    Narrow,
    /// Four slips, two loads, two speeds of a wheel that rolls in three dimensions on a coarse grid.
    Spatial,
    /// Six slips, two loads, two speeds of the same wheel with the model's own grid and steps.
    Rolling,
}

/// A run of the design.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedRun {
    pub wheel: &'static str,
    pub slip: f64,
    pub wheel_load_n: f64,
    pub sled_speed_m_s: f64,
    pub pass: u32,
    pub is_holdout: bool,
    /// The place in time, the soil preparation, and the session, taring and operator of the rig, if the experiment states them.
    pub order: Option<usize>,
    pub prepared: Option<usize>,
    pub session: Option<usize>,
    pub zero: Option<usize>,
    pub operator: Option<usize>,
}

impl Plan {
    /// Returns the design in which the data can distinguish an effect of the catalogue from the soil's stiffness.
    pub fn for_effect(effect: &str) -> Self {
        match effect {
            "multipass_hardening" => Plan::Passes,
            "small_diameter" | "edge_loss" | "reece_pressure" => Plan::Wheels,
            _ => Plan::Full,
        }
    }

    /// The fitted runs, and then the held-out runs, which lie between them and slightly beyond.
    pub fn rows(self) -> Vec<PlannedRun> {
        let [slips, loads, rims]: [&[f64]; 3] = match self {
            Plan::Full | Plan::Passes | Plan::Wheels | Plan::Fixed => {
                [&[0.05, 0.1, 0.2, 0.3, 0.45, 0.6], &[60.0, 120.0], &[0.01, 0.05]]
            }
            Plan::Sparse => [&[0.05, 0.2, 0.4, 0.6], &[60.0, 120.0], &[0.01, 0.05]],
            Plan::Factorial => [&[0.05, 0.2, 0.4, 0.6], &[60.0, 120.0], &[0.01, 0.03, 0.08]],
            Plan::Narrow => [&[0.05, 0.1, 0.2, 0.3, 0.45, 0.6], &[90.0], &[0.03]],
            Plan::Rolling => [&[0.05, 0.1, 0.2, 0.3, 0.4, 0.5], &[60.0, 120.0], &[0.01, 0.05]],
            Plan::Spatial => [&[0.05, 0.15, 0.3, 0.5], &[60.0, 120.0], &[0.01, 0.05]],
        };
        let mut rows = self.grid([slips, loads, rims], false);
        rows.extend(match self {
            Plan::Narrow | Plan::Factorial => Vec::new(),
            Plan::Spatial | Plan::Rolling => self.grid([&[0.1, 0.4], &[85.0], &[0.02, 0.06]], true),
            _ => self.grid([&[0.07, 0.15, 0.38, 0.66], &[85.0, 132.0], &[0.02, 0.06]], true),
        });
        rows
    }

    fn grid(self, [slips, loads, rims]: [&[f64]; 3], is_holdout: bool) -> Vec<PlannedRun> {
        let mut rows = Vec::new();
        for (i, &slip) in slips.iter().enumerate() {
            for (j, &wheel_load_n) in loads.iter().enumerate() {
                for (k, &rim) in rims.iter().enumerate() {
                    let is_second = (i + j + k) % 2 == 1;
                    if is_second && self == Plan::Sparse && !is_holdout {
                        continue;
                    }
                    rows.push(PlannedRun {
                        wheel: if is_second && self == Plan::Wheels {
                            "small"
                        } else {
                            "wide"
                        },
                        slip,
                        wheel_load_n,
                        sled_speed_m_s: rim * (1.0 - slip),
                        pass: if is_second && self == Plan::Passes { 2 } else { 1 },
                        is_holdout,
                        order: None,
                        prepared: None,
                        session: None,
                        zero: None,
                        operator: None,
                    });
                }
            }
        }
        rows
    }

    /// Returns the job of the base model.
    pub fn job(self) -> FileSet {
        let (model, priors) = match self {
            Plan::Spatial => (SPATIAL, SPATIAL_PRIORS),
            Plan::Rolling => (ROLLING, SPATIAL_PRIORS),
            _ => ("kind = \"quasi_static\"\n", PRIORS),
        };
        let radii = match self {
            // The radius of a wheel with grousers is that of its rim.
            Plan::Spatial | Plan::Rolling => "wheel_radius_m = { uniform = [0.124, 0.130] }\n",
            Plan::Wheels => {
                "\"wheel_radius_m.wide\" = { uniform = [0.125, 0.155] }\n\"wheel_radius_m.small\" = { uniform = [0.075, 0.09] }\n"
            }
            Plan::Fixed => "",
            _ => "wheel_radius_m = { uniform = [0.125, 0.155] }\n",
        };
        FileSet {
            toml: format!("experiment = \"experiment.toml\"\n[model]\n{model}[priors]\n{priors}{radii}"),
            files: Default::default(),
        }
    }
}

/// Returns the files of an experiment with its measured values and the noise's standard deviations.
pub fn experiment(rows: &[PlannedRun], values: &[[f64; CHANNELS]], sds: [f64; CHANNELS]) -> FileSet {
    experiment_stating(WheelSize::TRUE, rows, values, sds)
}

/// Returns the files of an experiment that states these dimensions of its wide wheel.
pub fn experiment_stating(
    wide: WheelSize,
    rows: &[PlannedRun],
    values: &[[f64; CHANNELS]],
    sds: [f64; CHANNELS],
) -> FileSet {
    let wheel = |name: &str, radius: f64, width: f64| {
        format!(
            "[wheel.{name}]\nradius_m = {radius}\nwidth_m = {width}\ngrouser_count = 12\ngrouser_height_m = 0.009\ngrouser_thickness_m = 0.002\n"
        )
    };
    let mut toml = "runs = \"runs.csv\"\n".to_owned();
    toml += &wheel("wide", wide.radius_m, wide.width_m);
    // Without the key, the radius of the rig is that of the wheel.
    if wide != WheelSize::TRUE {
        toml += &format!("rig_radius_m = {}\n", wide.rig_radius_m);
    }
    if rows.iter().any(|row| row.wheel == "small") {
        toml += &wheel("small", 0.075, 0.06);
    }
    let [pull, torque, sinkage] = sds;
    toml += &format!(
        "[soil.s]\ndensity_kg_m3 = 1400.0\n[rig]\nbin_length_m = 1.5\n[noise]\ndrawbar_pull_n = {pull:?}\ntorque_n_m = {torque:?}\nsinkage_m = {sinkage:?}\n"
    );
    let mut runs =
        "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,pass,drawbar_pull_n,torque_n_m,sinkage_m,use"
            .to_owned();
    let columns = [
        ("order", rows.iter().map(|row| row.order).collect::<Vec<_>>()),
        ("prepared", rows.iter().map(|row| row.prepared).collect()),
        ("session", rows.iter().map(|row| row.session).collect()),
        ("zero", rows.iter().map(|row| row.zero).collect()),
        ("operator", rows.iter().map(|row| row.operator).collect()),
    ];
    let mut stated = columns.to_vec();
    stated.retain(|(_, values)| values.iter().any(Option::is_some));
    runs.extend(stated.iter().map(|(name, _)| format!(",{name}")));
    for (number, (row, [pull, torque, sinkage])) in rows.iter().zip(values).enumerate() {
        let PlannedRun {
            wheel,
            slip,
            wheel_load_n,
            sled_speed_m_s,
            pass,
            is_holdout,
            ..
        } = row;
        let usage = if *is_holdout { "holdout" } else { "fit" };
        runs += &format!(
            "\nr{number},{wheel},s,{slip:?},{wheel_load_n:?},{sled_speed_m_s:?},{pass},{pull:?},{torque:?},{sinkage:?},{usage}"
        );
        for (_, values) in &stated {
            runs += &values[number].map_or(",".to_owned(), |value| format!(",{value}"));
        }
    }
    runs += "\n";
    FileSet {
        toml,
        files: [("runs.csv".to_owned(), runs)].into(),
    }
}
