//! One effective width for the whole footprint, by its hull: `b_eff = 2 A / L`.
//!
//! Without gaps between grousers the footprint is a rectangle, `b_eff = l b / (l + b)`. The plates of `examples/cmu-sand`
//! give kappa = −0.66, at which a single grouser's tip carries nothing.

use super::Rows;
use super::profile::Profile;
use crate::scene::{Track, bars, grousered, smooth};
use scm::spatial::{Footprint, Shape};

/// kappa from the plates on CMU's sand.
const KAPPA: f64 = -0.66;

fn with_kappa(mut track: Track) -> Track {
    let soil = &mut track.case.soil;
    (soil.k_c, soil.k_phi) = scm::bekker_moduli(4.56, KAPPA, soil.n);
    track
}

/// 24 grousers of 5 mm at a slip.
fn grousers(slip: f64) -> Track {
    let mut track = grousered(slip);
    track.shape = Shape::Rim(bars(24, 0.005, 0.002));
    track
}

pub(crate) fn add(rows: &mut Rows) {
    // Smooth, without friction and with vertical pressure, all of which carries load.
    let mut track = with_kappa(smooth(0.2, 100.0, 0.0));
    track.case.soil.gamma_exponent = 0.0;
    let got = track.averages();
    let (length, width) = (got.contact_length_m, track.case.wheel.width_m);
    let b_eff = length * width / (length + width);
    rows.add("smooth", "b_eff [mm]", 1e3 * b_eff, 1e3 * got.b_eff_m, 0.1);
    let mut on_paper = track.clone();
    on_paper.case.soil.k_phi += on_paper.case.soil.k_c / b_eff;
    let sinkage = Profile::in_balance(&on_paper).sinkage;
    rows.add_sinkage("smooth", sinkage, got.sinkage_m, 0.03);

    // z computed for the nodes of a rolled footprint under one b_eff; patches would give 16 and 40 mm and 123 and 174 N of 100
    for (slip, expected) in [(0.05, 6.4), (0.4, 7.9)] {
        let run = with_kappa(grousers(slip)).roll();
        let case = format!("24 x 5 mm, s {slip}");
        let carried = &run.history.wheel_load_n[run.history.len() / 2..];
        let mean = carried.iter().sum::<f64>() / carried.len() as f64;
        rows.add(&case, "W [N]", 100.0, mean, 0.5);
        rows.add_sinkage(&case, 1e-3 * expected, run.averages.sinkage_m, 0.05);
    }

    // without k_c the effective width has no effect
    let hull = grousers(0.2).averages();
    let mut track = grousers(0.2);
    track.settings.footprint = Footprint::Patches;
    let patches = track.averages();
    let expected = [patches.drawbar_pull_n, patches.torque_n_m, patches.sinkage_m];
    rows.add_run("kappa 0, of patches", 100.0, expected, &hull, [0.0; 3]);
}
