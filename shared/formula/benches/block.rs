//! Time of a formula in blocks, compared with the same law written in Rust over the same arrays with the same elementary functions.
//!
//! `cargo bench -p formula` prints both times for 16, 32 and 128 points, then their ratios, each the minimum of many batches.

use std::hint::black_box;
use std::time::Instant;

use divan::counter::ItemsCount;
use formula::block::Block;
use formula::variable::Variables;
use formula::{Effect, Hook, Program, Variable, elementary};

fn main() {
    divan::main();
    print_ratios();
}

const POINTS: [usize; 3] = [16, 32, 128];
const PARAMETERS: [f64; 3] = [0.3, 0.4, 0.01];

/// A law and the columns that it reads: its target and a second variable.
#[derive(Debug, Clone, Copy)]
enum Law {
    /// Pressure grows with a power of slip velocity.
    Power,
    /// Shear stress is mobilised by an exponential of shear displacement.
    Exponential,
}

const LAWS: [Law; 2] = [Law::Power, Law::Exponential];

impl Law {
    fn text(self) -> &'static str {
        match self {
            Law::Power => "pressure = \"p * (1 + a * (v_t / shear_velocity)^b)\"",
            Law::Exponential => "shear = \"tau * (1 - exp(-j / k))\"",
        }
    }

    fn hook(self) -> Hook {
        match self {
            Law::Power => Hook::Pressure,
            Law::Exponential => Hook::Shear,
        }
    }

    fn other(self) -> Variable {
        match self {
            Law::Power => Variable::Vt,
            Law::Exponential => Variable::J,
        }
    }

    fn program(self) -> Program {
        let (used, parameters) = match self {
            Law::Power => ("ab", [("a", "1"), ("b", "1")].as_slice()),
            Law::Exponential => ("k", [("k", "m")].as_slice()),
        };
        let mut text = format!(
            "name = \"{used}\"\nsummary = \"a law\"\nsource = \"none\"\n{}\n",
            self.text()
        );
        for (name, unit) in parameters {
            text += &format!("[parameters.{name}]\nunit = \"{unit}\"\nneutral = 0\nprior = 1\n");
        }
        let effect = Effect::read(&text).unwrap_or_else(|e| panic!("{e}"));
        let local = Variables::new(&[self.hook().target(), self.other()]);
        effect.program(self.hook(), local).expect("the law has this hook")
    }

    fn parameters(self) -> &'static [f64] {
        match self {
            Law::Power => &PARAMETERS[..2],
            Law::Exponential => &PARAMETERS[2..],
        }
    }
}

/// The law in plain Rust code.
#[inline(never)]
fn native(law: Law, target: &mut [f64], other: &[f64], shear_velocity: f64) {
    let [a, b, k] = black_box(PARAMETERS);
    match law {
        Law::Power => {
            for (p, v_t) in target.iter_mut().zip(other) {
                *p *= 1.0 + a * elementary::fraction_pow(v_t / shear_velocity, b);
            }
        }
        Law::Exponential => {
            for (tau, j) in target.iter_mut().zip(other) {
                *tau *= 1.0 - elementary::exp(-j / k);
            }
        }
    }
}

/// Fills the columns with values that the law leaves unchanged, because it is applied repeatedly.
fn fill(law: Law, target: &mut [f64], other: &mut [f64]) {
    for (point, (target, other)) in target.iter_mut().zip(other).enumerate() {
        let share = (point as f64 + 0.5) / 128.0;
        *target = 1e4 * share;
        *other = match law {
            Law::Power => 1e-3 * share,
            Law::Exponential => 0.03 * share,
        };
    }
}

struct Interpreted {
    law: Law,
    program: Program,
    scalars: Vec<f64>,
    block: Block,
    target: Vec<f64>,
}

impl Interpreted {
    fn new(law: Law) -> Self {
        let (program, mut scalars, mut block) = (law.program(), Vec::new(), Block::default());
        let mut variables = [0.0; Variable::COUNT];
        variables[Variable::ShearVelocity as usize] = 1e-3;
        program.settle(&variables, law.parameters(), &mut scalars);
        let (mut target, mut other) = (vec![0.0; 128], vec![0.0; 128]);
        fill(law, &mut target, &mut other);
        block.column_mut(law.other()).copy_from_slice(&other);
        Self {
            law,
            program,
            scalars,
            block,
            target,
        }
    }

    fn step(&mut self, points: usize) {
        let target = self.law.hook().target();
        self.block.column_mut(target)[..points].copy_from_slice(&self.target[..points]);
        self.block
            .replace(target, black_box(&self.program), black_box(&self.scalars), points);
        black_box(self.block.column(target)[0]);
    }
}

struct Native {
    law: Law,
    start: Vec<f64>,
    target: Vec<f64>,
    other: Vec<f64>,
}

impl Native {
    fn new(law: Law) -> Self {
        let (mut start, mut other) = (vec![0.0; 128], vec![0.0; 128]);
        fill(law, &mut start, &mut other);
        let target = start.clone();
        Self {
            law,
            start,
            target,
            other,
        }
    }

    fn step(&mut self, points: usize) {
        self.target[..points].copy_from_slice(&self.start[..points]);
        native(
            self.law,
            &mut self.target[..points],
            &self.other[..points],
            black_box(1e-3),
        );
        black_box(self.target[0]);
    }
}

#[divan::bench(args = POINTS)]
fn power_interpreted(bencher: divan::Bencher<'_, '_>, points: usize) {
    let mut law = Interpreted::new(Law::Power);
    bencher
        .counter(ItemsCount::new(points))
        .bench_local(|| law.step(points));
}

#[divan::bench(args = POINTS)]
fn power_native(bencher: divan::Bencher<'_, '_>, points: usize) {
    let mut law = Native::new(Law::Power);
    bencher
        .counter(ItemsCount::new(points))
        .bench_local(|| law.step(points));
}

#[divan::bench(args = POINTS)]
fn exponential_interpreted(bencher: divan::Bencher<'_, '_>, points: usize) {
    let mut law = Interpreted::new(Law::Exponential);
    bencher
        .counter(ItemsCount::new(points))
        .bench_local(|| law.step(points));
}

#[divan::bench(args = POINTS)]
fn exponential_native(bencher: divan::Bencher<'_, '_>, points: usize) {
    let mut law = Native::new(Law::Exponential);
    bencher
        .counter(ItemsCount::new(points))
        .bench_local(|| law.step(points));
}

/// Returns the minimum time of a step over many batches, in nanoseconds.
fn min_time(mut step: impl FnMut()) -> f64 {
    const BATCH: u32 = 2000;
    let batches = (0..300).map(|_| {
        let start = Instant::now();
        (0..BATCH).for_each(|_| step());
        start.elapsed().as_secs_f64() * 1e9 / f64::from(BATCH)
    });
    batches.fold(f64::INFINITY, f64::min)
}

fn print_ratios() {
    println!("law          points  interpreted  native  [ns per point]  ratio");
    for law in LAWS {
        for points in POINTS {
            let (mut interpreted, mut by_hand) = (Interpreted::new(law), Native::new(law));
            let ours = min_time(|| interpreted.step(points)) / points as f64;
            let theirs = min_time(|| by_hand.step(points)) / points as f64;
            let ratio = ours / theirs;
            println!(
                "{:<12} {points:>6} {ours:>12.2} {theirs:>7.2} {ratio:>23.2}",
                format!("{law:?}")
            );
        }
    }
}
