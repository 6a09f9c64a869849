//! Runs under like conditions, between which a channel differs for few reasons.

use shared::experiment::TestRun;

/// Relative difference of wheel loads that are alike.
const LIKE_LOADS: f64 = 0.15;
/// Difference of slip angles that are alike `[deg]`.
const LIKE_ANGLES_DEG: f64 = 0.5;

/// Returns whether two runs differ only in load, slip and the speed that sets it.
pub(super) fn share_wheel_and_soil(a: &TestRun, b: &TestRun) -> bool {
    a.wheel == b.wheel && share_soil(a, b)
}

/// Returns whether two runs differ only in slip and in the speed that sets it.
pub(super) fn differ_in_slip(a: &TestRun, b: &TestRun) -> bool {
    share_wheel_and_soil(a, b) && have_like_loads(a, b)
}

/// Returns whether two runs differ only in wheel, load, slip and the speed that sets it.
pub(super) fn share_soil(a: &TestRun, b: &TestRun) -> bool {
    a.soil == b.soil && a.pass == b.pass && (a.slip_angle_deg - b.slip_angle_deg).abs() <= LIKE_ANGLES_DEG
}

/// Returns whether the wheel loads of two runs are alike.
pub(super) fn have_like_loads(a: &TestRun, b: &TestRun) -> bool {
    let [less, more] = [
        a.wheel_load_n.min(b.wheel_load_n),
        a.wheel_load_n.max(b.wheel_load_n),
    ];
    more - less <= LIKE_LOADS * more
}
