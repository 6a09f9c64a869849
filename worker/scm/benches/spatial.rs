//! Time of one run in three dimensions: by case, by step, by node and trial, by spacing of the grid.

#[path = "../tests/scene.rs"]
#[expect(dead_code, reason = "tests ask more of a track")]
mod scene;
#[path = "../tests/support.rs"]
#[expect(dead_code, reason = "tests draw random cases")]
mod support;

use divan::Bencher;
use divan::counter::ItemsCount;
use scene::Track;
use scm::Rejection;
use scm::spatial::{Displacement, Grousers, Protocol, RunSettings, Shape, SpatialRun};
use support::base;

fn main() {
    divan::main();
}

/// A run, by the settings that the benches change.
#[derive(Debug, Clone, Copy)]
struct Case {
    name: &'static str,
    smooth: bool,
    fifty_seconds: bool,
    both_halves: bool,
    slip_angle_deg: f64,
    spacing_m: f64,
    /// Shear modulus of Janosi and Hanamoto's law, which is active if this is above 0.
    shear_modulus_m: f64,
    displacement: Displacement,
}

impl std::fmt::Display for Case {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.write_str(self.name)
    }
}

/// 50 s over 1 m of travel with 12 grousers.
const FIFTY: Case = Case {
    name: "50 s",
    smooth: false,
    fifty_seconds: true,
    both_halves: false,
    slip_angle_deg: 0.0,
    spacing_m: 0.004,
    shear_modulus_m: 0.0,
    displacement: Displacement::Rim,
};

impl Case {
    fn run(&self) -> Result<SpatialRun, Rejection> {
        let mut case = base(0.2, 100.0, 30.0);
        case.condition.sled_speed_m_s = 0.02;
        case.condition.slip_angle_rad = self.slip_angle_deg.to_radians();
        let mut track = Track::with_grousers(case);
        if self.smooth {
            track.shape = Shape::Rim(Grousers::default());
        }
        if self.shear_modulus_m > 0.0 {
            track.enter_displacement_law(self.shear_modulus_m);
        }
        let protocol = if self.fifty_seconds {
            Protocol::Fixed {
                duration_s: 50.0,
                transient_force_s: 20.0,
                transient_sinkage_s: 1.0,
                lowpass_hz: 0.5,
            }
        } else {
            Protocol::default()
        };
        track.settings = RunSettings {
            dem_spacing_m: self.spacing_m,
            displacement: self.displacement,
            protocol,
            both_halves: self.both_halves,
            ..RunSettings::default()
        };
        track.try_roll()
    }
}

const CASES: [Case; 6] = [
    FIFTY,
    Case {
        name: "50 s, smooth",
        smooth: true,
        ..FIFTY
    },
    Case {
        name: "50 s, both halves",
        both_halves: true,
        ..FIFTY
    },
    Case {
        name: "50 s, slip angle 10 degrees",
        slip_angle_deg: 10.0,
        ..FIFTY
    },
    Case {
        name: "steady",
        fifty_seconds: false,
        ..FIFTY
    },
    Case {
        name: "steady, smooth",
        fifty_seconds: false,
        smooth: true,
        ..FIFTY
    },
];

/// Time of a run, and steps per second.
#[divan::bench(args = CASES)]
fn steps(bencher: Bencher<'_, '_>, case: Case) {
    let steps = case.run().map_or(0, |run| run.history.len() - 1);
    bencher.counter(ItemsCount::new(steps)).bench(|| case.run());
}

/// Time of a run, and computed nodes in contact per second, over all trials.
#[divan::bench(args = CASES)]
fn node_trials(bencher: Bencher<'_, '_>, case: Case) {
    let nodes = case.run().map_or(0, |run| run.node_trials);
    bencher.counter(ItemsCount::new(nodes)).bench(|| case.run());
}

/// Time of a run by the spacing of the grid in millimetres, and nodes in contact per second.
#[divan::bench(args = [8.0, 5.0, 4.0, 2.0])]
fn spacing(bencher: Bencher<'_, '_>, spacing_mm: f64) {
    let case = Case {
        spacing_m: 1e-3 * spacing_mm,
        ..FIFTY
    };
    let nodes = case.run().map_or(0, |run| run.node_trials);
    bencher.counter(ItemsCount::new(nodes)).bench(|| case.run());
}

/// Time of a run without displacement, and with displacement on the rim and on the soil's nodes.
#[divan::bench(args = ["none", "rim", "node"])]
fn displacement(bencher: Bencher<'_, '_>, keeper: &str) {
    let case = Case {
        shear_modulus_m: if keeper == "none" { 0.0 } else { 0.01 },
        displacement: if keeper == "node" {
            Displacement::Node
        } else {
            Displacement::Rim
        },
        ..FIFTY
    };
    let steps = case.run().map_or(0, |run| run.history.len() - 1);
    bencher.counter(ItemsCount::new(steps)).bench(|| case.run());
}
