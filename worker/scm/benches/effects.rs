//! The cost of a formula: the base without its shear-velocity law, with that law as a formula, and with the law in code.
//!
//! `cargo bench -p scm --bench effects`. All three run in turn, and the fastest of many turns counts, so that the ratios
//! hold on a busy machine. A base velocity of 0 mobilises the whole strength; the formula then replaces the code, and both
//! give the same forces.

#[path = "../tests/support.rs"]
#[expect(dead_code, reason = "tests draw random cases")]
mod support;

use std::hint::black_box;
use std::time::Instant;

use formula::Effect;
use formula::catalogue::find;
use scm::effects::{Active, CompiledEffects, ModelForm, Site};
use scm::{Averages, quasi_static};
use support::base;

const TURNS: u32 = 2000;

/// One of the variants: its name and its simulation.
type Way<'a> = (&'a str, Box<dyn FnMut() -> Averages + 'a>);

/// Prints the fastest time of each variant, and its ratio to that of the last one.
fn compare(title: &str, turns: u32, ways: &mut [Way]) {
    let mut fastest = vec![f64::INFINITY; ways.len()];
    for _ in 0..turns {
        for (fastest, (_, simulate)) in fastest.iter_mut().zip(ways.iter_mut()) {
            let start = Instant::now();
            black_box(simulate());
            *fastest = fastest.min(start.elapsed().as_secs_f64());
        }
    }
    let native = fastest.last().copied().unwrap_or(f64::NAN);
    println!("{title}");
    for ((name, simulate), fastest) in ways.iter_mut().zip(&fastest) {
        let pull = simulate().drawbar_pull_n;
        println!(
            "  {name:44} {:10.2} us   x {:.2}   {pull:.6} N",
            1e6 * fastest,
            fastest / native
        );
    }
}

fn main() {
    let law = "name = \"velocity\"\nsummary = \"the shear-velocity law\"\nsource = \"Krenn & Hirzinger\"\n\
               shear = \"tau * (1 - exp(-v_t / reference_m_s))\"\n[parameters.reference_m_s]\nunit = \"m/s\"\nneutral = 0.0\nprior = 0.001\n";
    let law = Effect::read(law).expect("a formula");
    let janosi = find("janosi_hanamoto").expect("an effect of the catalogue");
    let site = Site::default();
    for slip in [0.2, -0.3] {
        let effects = CompiledEffects::compile(ModelForm::QuasiStatic, [&law]).expect("a form");
        let jh = CompiledEffects::compile(ModelForm::QuasiStatic, [janosi]).expect("a form");
        let run = |velocity: f64, active: &mut Active| {
            let mut case = base(slip, 100.0, 30.0);
            case.soil.shear_velocity_m_s = black_box(velocity);
            quasi_static::simulate_with(&case.soil, &case.wheel, &case.condition, active, &site)
                .expect("support")
        };
        // an evaluation activates its effects once for all of its runs
        let (mut law, mut jh) = (effects.activate([vec![0.001]]), jh.activate([vec![0.01]]));
        let (mut none, mut nothing) = (Active::default(), Active::default());
        let mut ways: [Way; 4] = [
            ("base, v0 = 0", Box::new(|| run(0.0, &mut none))),
            ("janosi_hanamoto, K = 10 mm", Box::new(|| run(0.001, &mut jh))),
            ("v0 = 0, law as a formula", Box::new(|| run(0.0, &mut law))),
            ("law in code, v0 = 1 mm/s", Box::new(|| run(0.001, &mut nothing))),
        ];
        compare(&format!("quasi_static, slip {slip}"), TURNS, &mut ways);
    }
}
