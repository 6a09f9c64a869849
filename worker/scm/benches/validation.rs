//! Prints the expected figures of effects and of the three-dimensional model, with the model's results.
//!
//! `cargo bench -p scm --bench validation`; it fails if a row fails.

#[path = "../tests/scene.rs"]
#[expect(dead_code, reason = "tests ask more of a track")]
mod scene;
#[path = "../tests/support.rs"]
#[expect(dead_code, reason = "tests draw random cases, the table does not")]
mod support;
#[path = "../tests/validation/mod.rs"]
mod validation;

use std::process::ExitCode;

fn main() -> ExitCode {
    println!("oracle | case | quantity | expected | got | tolerance | verdict");
    let (mut count, mut failed) = (0, 0);
    for (oracle, add) in validation::ORACLES {
        for row in validation::rows(add) {
            let verdict = if row.passes() { "pass" } else { "FAIL" };
            println!(
                "{oracle:20} | {:38} | {:15} | {:10.4} | {:10.4} | {:9.2e} | {verdict}",
                row.case, row.quantity, row.expected, row.got, row.tolerance
            );
            count += 1;
            failed += usize::from(!row.passes());
        }
    }
    println!("{count} rows, {failed} failed");
    ExitCode::from(u8::from(failed > 0))
}
