//! Feeds the crate texts of all kinds for some minutes: `cargo run -p formula --release --example fuzz -- --minutes 10`.
//!
//! `--seed N` sets the first seed. A failure ends the run and prints the bytes that led to it.
#![allow(clippy::float_cmp)]

#[path = "../tests/generate.rs"]
mod generate;

use std::time::{Duration, Instant};

use generate::{Dice, anything, check_evaluation, check_exact, check_read, file};

/// Returns the number that follows an option.
fn option(name: &str, default: u64) -> u64 {
    let mut arguments = std::env::args().skip_while(|argument| argument != name);
    let value = arguments.nth(1).map(|value| value.parse());
    value.map_or(default, |value| value.expect("a whole number follows the option"))
}

fn main() {
    let limit = Duration::from_secs(60 * option("--minutes", 1));
    let mut state = option("--seed", 1);
    let mut random = || {
        // SplitMix64
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (state ^ state >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    };
    let (start, mut slowest) = (Instant::now(), Duration::ZERO);
    let (mut texts, mut read, mut values, mut exact) = (0_u64, 0_u64, 0_u64, 0_u64);
    while start.elapsed() < limit {
        for _ in 0..1000 {
            let length = random() % 1500;
            let bytes: Vec<u8> = (0..length).map(|_| random() as u8).collect();
            let case = || {
                let mut dice = Dice(&bytes);
                let text = if length % 2 == 0 {
                    anything(&mut dice)
                } else {
                    file(&mut dice)
                };
                let effect = check_read(&text);
                let compared = effect.as_ref().map(|effect| check_evaluation(effect, &mut dice));
                check_exact(&mut Dice(&bytes));
                compared
            };
            let before = Instant::now();
            let Ok(compared) = std::panic::catch_unwind(case) else {
                eprintln!("failed for the bytes {bytes:?}");
                std::process::exit(1);
            };
            let mut took = before.elapsed();
            if took > slowest {
                // measured twice, because the machine may have been busy
                let before = Instant::now();
                case();
                took = took.min(before.elapsed());
            }
            slowest = slowest.max(took);
            texts += 1;
            exact += 1;
            read += u64::from(compared.is_some());
            values += compared.unwrap_or(0) as u64;
        }
    }
    println!(
        "{texts} texts, {read} of them read, {values} values compared, {exact} formulas evaluated by hand; slowest {} ms; {} s",
        slowest.as_millis(),
        start.elapsed().as_secs()
    );
}
