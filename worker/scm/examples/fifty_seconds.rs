//! One run of 50 s over 1 m of travel with 12 grousers, as a benchmark of speed.
//!
//! `cargo build --release -p scm --example fifty_seconds`, then
//! `valgrind --tool=callgrind target/release/examples/fifty_seconds`. Words on the command line change the case:
//! `smooth`; `staggered`, `oblique` grousers; `steady`, `both-halves`; `formula`: the base's shear-velocity law as a formula; `displacement`: Janosi and
//! Hanamoto's law; `pressure`: soil that grows denser with depth.

#[path = "../tests/scene.rs"]
#[expect(dead_code, reason = "tests ask more of a track")]
mod scene;
#[path = "../tests/support.rs"]
#[expect(dead_code, reason = "tests draw random cases")]
mod support;

use scene::Track;
use scm::spatial::{Grousers, Protocol, RunSettings, Shape, Tread};
use support::base;

fn main() -> Result<(), scm::Rejection> {
    let words: Vec<String> = std::env::args().collect();
    let says = |word: &str| words.iter().any(|w| w == word);
    let mut case = base(0.2, 100.0, 30.0);
    case.condition.sled_speed_m_s = 0.02;
    let mut track = Track::with_grousers(case);
    if says("smooth") {
        track.shape = Shape::Rim(Grousers::default());
    }
    if let Shape::Rim(bars) = track.shape {
        let straight = Tread::straight(bars);
        if says("staggered") {
            track.shape = Shape::Tread(Tread {
                rows: 2,
                stagger: 0.5,
                ..straight
            });
        }
        if says("oblique") {
            track.shape = Shape::Tread(Tread {
                angle_rad: 0.35,
                ..straight
            });
        }
    }
    track.settings = RunSettings {
        protocol: if says("steady") {
            Protocol::default()
        } else {
            Protocol::Fixed {
                duration_s: 50.0,
                transient_force_s: 20.0,
                transient_sinkage_s: 1.0,
                lowpass_hz: 0.5,
            }
        },
        both_halves: says("both-halves"),
        ..RunSettings::default()
    };
    if says("formula") {
        track.case.soil.shear_velocity_m_s = 0.0;
        let text = "name = \"law\"\nsummary = \"law\"\nsource = \"base\"\nshear = \"tau * (1 - exp(-v_t / v_0))\"\n\
            [parameters.v_0]\nunit = \"m/s\"\nneutral = 0\nprior = 0.001\n";
        track.enter(&formula::Effect::read(text).expect("an effect"), &[0.001]);
    }
    if says("displacement") {
        track.enter_displacement_law(0.01);
    }
    if says("pressure") {
        let denser = formula::catalogue::find("density_gradient").expect("in the catalogue");
        track.enter(denser, &[20.0]);
    }
    let run = track.try_roll()?;
    let steps = run.history.len() - 1;
    println!("{:?}", run.averages);
    println!(
        "settled to {:?}, {steps} steps, {:.2} trials a step, {:.0} nodes a trial",
        run.settled_to,
        run.trials as f64 / steps as f64,
        run.node_trials as f64 / run.trials as f64
    );
    Ok(())
}
