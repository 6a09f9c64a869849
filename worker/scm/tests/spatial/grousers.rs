//! The effect of grousers.

use crate::scene::{bars, grousered, smooth};
use crate::support::assert_near;
use scm::spatial::{Footprint, Grousers, Shape};

#[test]
fn means_with_grousers_are_near_those_of_the_smooth_wheel() {
    let got = grousered(0.2).averages();
    let mut bare = smooth(0.2, 100.0, 30.0);
    bare.ground = grousered(0.2).ground;
    let bare = bare.averages();
    // 5 % of the load, 6 % of the torque, 10 % of the sinkage: 2.7 N, 0.25 N m, 0.3 mm are found
    assert_near(&got, &bare, [5.0, 0.06 * bare.torque_n_m, 0.1]);
    // the hull spans the gaps between grousers; the patches under single grousers are narrow
    let by_hull = got.b_eff_m / bare.b_eff_m;
    assert!((1.0..1.25).contains(&by_hull), "{got:?} {bare:?}");
    let mut patches = grousered(0.2);
    patches.settings.footprint = Footprint::Patches;
    let patches = patches.averages();
    assert!(patches.b_eff_m < 0.8 * bare.b_eff_m, "{patches:?} {bare:?}");
    // without k_c both are equal
    assert_eq!(patches.sinkage_m.to_bits(), got.sinkage_m.to_bits());
    assert_eq!(patches.drawbar_pull_n.to_bits(), got.drawbar_pull_n.to_bits());
}

#[test]
fn grousers_sink_the_deeper_the_more_they_slip() {
    let [low, middle, high] = [0.2, 0.4, 0.6].map(|slip| grousered(slip).averages().sinkage_m);
    assert!(middle > 1.1 * low && high > 1.3 * middle, "{low} {middle} {high}");
    // the smooth wheel does not sink deeper with slip
    let smooth = [0.2, 0.6].map(|slip| smooth(slip, 100.0, 30.0).averages().sinkage_m);
    assert!((smooth[1] / smooth[0] - 1.0).abs() < 0.01, "{smooth:?}");
}

#[test]
fn vanishing_grousers_leave_the_smooth_wheel() {
    let mut track = grousered(0.2);
    track.shape = Shape::Rim(bars(12, 1e-5, 0.002));
    let low = track.averages();
    track.shape = Shape::Rim(Grousers::default());
    let none = track.averages();
    // 0.01 mm of height press 0.01 mm deeper: 0.3 N at 28 N/mm
    assert_near(&low, &none, [0.5, f64::INFINITY, f64::INFINITY]);
    assert!((low.sinkage_m - none.sinkage_m).abs() < 1e-4, "{low:?} {none:?}");
}

#[test]
fn hard_ground_carries_the_wheel_on_its_grousers_tips() {
    let mut track = grousered(0.2);
    track.case.soil.k_phi = 1e10;
    let got = track.averages();
    // between two tips in contact, 30 degrees apart, the rim hangs R + h − (R + h) cos(15°) = 4.6 mm lower than over one
    assert!((-0.0091..-0.009 + 0.0046).contains(&got.sinkage_m), "{got:?}");
}
