//! The end of steady runs, and the scatter of the averages of neighbours; it fails above its bounds.
//!
//! `cargo bench -p scm --bench steady`; under `valgrind --tool=callgrind` the word `draws` counts only the instructions of
//! the draws.

#[path = "../tests/scene.rs"]
#[expect(dead_code, reason = "tests ask more of a track")]
mod scene;
#[path = "../tests/steady_runs.rs"]
mod steady_runs;
#[path = "../tests/support.rs"]
#[expect(dead_code, reason = "tests draw random cases")]
mod support;

use std::process::ExitCode;

use steady_runs::{draws, mean, neighbours, outcomes, scatter};

/// Number of runs of either kind.
const COUNT: u32 = 40;

fn main() -> ExitCode {
    let mut fine = true;
    let mut row = |name: &str, got: f64, bound: f64| {
        println!("{name:40} | {got:9.4} | at most {bound}");
        fine &= got <= bound;
    };
    let drawn = outcomes(&draws(COUNT));
    row("draws of the prior: mean steps", mean(&drawn, 0), 400.0);
    if !std::env::args().any(|word| word == "draws") {
        let near = outcomes(&neighbours(COUNT));
        row("neighbouring loads: mean steps", mean(&near, 0), 400.0);
        row("neighbouring loads: F scatter [N]", scatter(&near, 1), 0.02);
        row("neighbouring loads: T scatter [N m]", scatter(&near, 2), 0.002);
        row("neighbouring loads: z scatter [mm]", scatter(&near, 3), 0.005);
    }
    ExitCode::from(u8::from(!fine))
}
