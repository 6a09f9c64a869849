//! Oracle 9: the balance of power.

use super::Rows;
use super::profile::Profile;
use crate::scene::{grousered, smooth};

pub(crate) fn add(rows: &mut Rows) {
    // A frictionless wheel only compacts: P = R_c v, to the grid's 2 % of the resistance.
    let mut track = smooth(0.2, 100.0, 0.0);
    track.case.soil.gamma_exponent = 0.0;
    let speed = track.case.condition.sled_speed_m_s;
    let mut paper = Profile::in_balance(&track);
    let run = track.roll();
    paper.sinkage = run.averages.sinkage_m;
    let expected = paper.resistance() * speed;
    rows.add(
        "compaction",
        "P [W]",
        expected,
        run.dissipated_power_w,
        0.02 * expected,
    );

    // The power of motor and sled from the means; the hub's vertical motion has no mean power in the steady state. The bound
    // is the tolerance of settled means: 0.5 % of load times speed.
    for (name, track) in [("smooth", smooth(0.2, 100.0, 30.0)), ("grousers", grousered(0.2))] {
        let run = track.for_a_travel_of(0.4, 0.21).roll();
        let motor = run.averages.torque_n_m * 0.01 / 0.125;
        let input = motor - run.averages.drawbar_pull_n * speed;
        rows.add(
            name,
            "P [W]",
            input,
            run.dissipated_power_w,
            0.005 * 100.0 * speed,
        );
    }
}
