//! One run of 50 s over 1 m of travel with 12 grousers: what speed is counted on.
//!
//! `cargo build --release -p scm --example fifty_seconds`, then
//! `valgrind --tool=callgrind target/release/examples/fifty_seconds`. Words on the command line change the case:
//! `smooth`, `steady`, `both-halves`.

use scm::spatial::{Ground, Grousers, Protocol, Scene, Settings, Shape, simulate};
use scm::{Condition, Soil, Wheel};

fn main() -> Result<(), scm::Rejection> {
    let words: Vec<String> = std::env::args().collect();
    let says = |word: &str| words.iter().any(|w| w == word);
    let soil = Soil {
        k_c: 0.0,
        k_phi: 1e7,
        n: 1.1,
        cohesion_pa: 0.0,
        friction_angle_rad: 30_f64.to_radians(),
        shear_velocity_m_s: 1e-3,
        gamma_exponent: 0.5,
    };
    let wheel = Wheel {
        radius_m: 0.125,
        width_m: 0.112,
        rig_radius_m: 0.125,
    };
    let shape = Shape::Rim(Grousers {
        count: if says("smooth") { 0 } else { 12 },
        height_m: 0.009,
        thickness_m: 0.002,
    });
    let condition = Condition {
        slip: 0.2,
        wheel_load_n: 100.0,
        sled_speed_m_s: 0.02,
        slip_angle_rad: 0.0,
        pass: 1,
    };
    let settings = Settings {
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
        ..Settings::default()
    };
    let scene = Scene {
        soil: &soil,
        ground: &Ground::default(),
        wheel: &wheel,
        shape: &shape,
    };
    let run = simulate(&scene, &condition, &settings)?;
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
