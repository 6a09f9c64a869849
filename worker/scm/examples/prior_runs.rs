//! Quasi-static runs at one slip under draws of a prior like that of `examples/cmu-sand`, as a benchmark of cost.
//!
//! `cargo build --release -p scm --example prior_runs`, then
//! `valgrind --tool=callgrind target/release/examples/prior_runs 1000 -0.7` for a number of runs at a slip. A word after it changes
//! the soil's law: `none`, no shear-velocity law; `formula`, that law as a formula; `displacement`, Janosi and Hanamoto's law in
//! addition. `base` takes one case instead of the draws, `wide` draws far beyond that prior; `print` prints every run.

#[path = "../tests/support.rs"]
#[expect(dead_code, reason = "tests ask more of a case")]
mod support;

use formula::Effect;
use formula::catalogue::find;
use scm::effects::{Active, CompiledEffects, ModelForm, Site};
use scm::{Wheel, quasi_static};
use support::{Case, Draws, base};

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |place: usize| words.get(place).and_then(|word| word.parse::<f64>().ok());
    let (runs, slip) = (number(0).unwrap_or(1000.0), number(1).unwrap_or(-0.7));
    let says = |word: &str| words.iter().any(|w| w == word);
    let law = "name = \"velocity\"\nsummary = \"the shear-velocity law\"\nsource = \"base\"\n\
               shear = \"tau * (1 - exp(-v_t / v_0))\"\n[parameters.v_0]\nunit = \"m/s\"\nneutral = 0\nprior = 0.001\n";
    let law = Effect::read(law).expect("a formula");
    let janosi = find("janosi_hanamoto").expect("an effect of the catalogue");
    let compiled =
        |effect: &Effect| CompiledEffects::compile(ModelForm::QuasiStatic, [effect]).expect("a form");
    let (law, janosi) = (compiled(&law), compiled(janosi));
    let mut active = if says("formula") {
        law.activate([vec![0.001]])
    } else if says("displacement") {
        janosi.activate([vec![0.01]])
    } else {
        Active::default()
    };
    let in_code = !(says("formula") || says("none"));
    let mut draws = Draws(1);
    let (mut sums, mut rejected) = ([0.0; 2], 0);
    for _ in 0..runs as u32 {
        let mut case = if says("base") {
            base(slip, 100.0, 30.0)
        } else if says("wide") {
            draws.case()
        } else {
            prior_draw(&mut draws, slip)
        };
        if !in_code {
            case.soil.shear_velocity_m_s = 0.0;
        }
        match quasi_static::simulate_with(
            &case.soil,
            &case.wheel,
            &case.condition,
            &mut active,
            &Site::default(),
        ) {
            Ok(averages) => {
                sums[0] += averages.drawbar_pull_n;
                sums[1] += averages.sinkage_m;
                if says("print") {
                    println!("{:?} {:?}", averages.drawbar_pull_n, averages.sinkage_m);
                }
            }
            Err(rejection) => {
                rejected += 1;
                if says("print") {
                    println!("{}", rejection.kind());
                }
            }
        }
    }
    println!("slip {slip}: sums of pull and sinkage {sums:?}, {rejected} of {runs} refused");
}

/// A small wheel on sand from the prior of `examples/cmu-sand`, at a slip.
fn prior_draw(draws: &mut Draws, slip: f64) -> Case {
    // a sum of twelve uniform numbers is nearly normal
    let mut normal =
        |mean: f64, sd: f64| mean + sd * ((0..12).map(|_| draws.uniform(0.0, 1.0)).sum::<f64>() - 6.0);
    let n = normal(1.32, 0.13).clamp(0.8, 2.0);
    let (log10_p_ref, friction_angle_deg) = (normal(3.93, 0.15), normal(31.0, 4.0).clamp(15.0, 45.0));
    let (k_c, k_phi) = scm::bekker_moduli(log10_p_ref, draws.uniform(-0.95, 0.5), n);
    let mut case = base(slip, 24.0, friction_angle_deg);
    (case.soil.k_c, case.soil.k_phi, case.soil.n) = (k_c, k_phi, n);
    case.wheel = Wheel {
        radius_m: draws.uniform(0.058, 0.0625),
        width_m: 0.05,
        rig_radius_m: 0.058,
    };
    case.condition.sled_speed_m_s = 0.01;
    case
}
