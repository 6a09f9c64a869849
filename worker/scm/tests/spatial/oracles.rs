//! Every row of the validation table holds, oracle by oracle.

use crate::validation::{self, ORACLES, Row, Rows};

fn holds(add: fn(&mut Rows)) {
    let rows = validation::rows(add);
    let show = |r: &Row| {
        format!(
            "{}: {} {} ± {}, not {}",
            r.case, r.quantity, r.expected, r.tolerance, r.got
        )
    };
    let failed: Vec<String> = rows.iter().filter(|row| !row.passes()).map(show).collect();
    assert!(!rows.is_empty() && failed.is_empty(), "{failed:#?}");
}

#[test]
fn plate_and_lowered_wheel_carry_bekkers_pressure() {
    holds(validation::plate::add);
}

#[test]
fn frictionless_smooth_wheel_is_the_one_on_paper() {
    holds(validation::smooth_wheel::add);
}

#[test]
fn smooth_wheel_without_flow_is_the_quasi_static_one() {
    holds(validation::quasi_static::add);
}

#[test]
fn grousers_without_flow_are_on_average_the_quasi_static_ones() {
    holds(validation::grousered::add);
}

#[test]
fn finer_grids_and_shorter_steps_change_little() {
    holds(validation::convergence::add);
}

#[test]
fn forces_scale_with_moduli_and_load_and_slip_is_the_rigs() {
    holds(validation::scaling::add);
}

#[test]
fn power_goes_where_it_should() {
    holds(validation::power::add);
}

#[test]
fn displacement_law_gives_the_prototypes_figures() {
    holds(validation::displacement::add);
}

#[test]
fn grousers_give_the_prototypes_figures() {
    holds(validation::grousers::add);
}

#[test]
fn rows_of_grousers_roll_over_their_tips() {
    holds(validation::tread::add);
}

#[test]
fn the_buried_side_meets_rankines_passive_force() {
    holds(validation::side_wall::add);
}

#[test]
fn deposits_lift_the_wheel_as_the_prototypes() {
    holds(validation::flow::add);
}

#[test]
fn one_effective_width_for_the_hull_carries_where_single_patches_do_not() {
    holds(validation::hull::add);
}

#[test]
fn another_implementation_is_reproduced() {
    holds(validation::other_implementation::add);
}

#[test]
fn no_oracle_is_left_out_and_a_wrong_figure_fails() {
    // there is one test for each, above and in `effects::signatures`
    assert_eq!(ORACLES.len(), 15);
    let mut rows = Rows::default();
    rows.add("off by more than allowed", "F [N]", 1.0, 1.2, 0.1);
    rows.add("not a number", "F [N]", 1.0, f64::NAN, 0.1);
    rows.add("as expected", "F [N]", 1.0, 1.05, 0.1);
    let verdicts: Vec<bool> = rows.into_rows().iter().map(Row::passes).collect();
    assert_eq!(verdicts, [false, false, true]);
}
