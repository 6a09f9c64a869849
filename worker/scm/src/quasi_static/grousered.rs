//! A rim with grousers: the shares of the ground that rim, flanks and tips press.

use super::displacement::{Entry, Slide, arcsine};
use super::panel::{Contact, Panel};
use super::rim::Rim;
use super::straight::StraightGrousers;
use crate::elementary::fraction_pow;
use crate::quadrature::{NODES, PLACE};
use crate::{Condition, Soil, Wheel};

/// Number of surfaces that press at one place: tips, flanks, and the rim between the grousers.
pub(super) const SURFACES: usize = 3;
/// Number of halvings of the angle up to which flanks press behind the axle.
const HALVINGS: u32 = 40;

/// The grousers of a run: the quantities that do not depend on the sinkage. Angles are measured forward from straight down.
///
/// Grousers are averaged over a period, with the hub at constant height. With `R_t = R + h` the tips' radius and
/// `rho = omega R_t / (v cos β)`, `N / 2π |rho sin θ − θ|` between two angles is the share of the ground that a tip sweeps
/// while it turns from one to the other. It follows from the path of the tips over the soil and the spacing of their marks.
#[derive(Debug)]
pub(super) struct Grousered {
    /// The rim, and a cylinder halfway up the grousers, with their speeds.
    rim: Rim,
    flank: Rim,
    /// The sliding of the rim; `None` if no law uses it.
    slide: Option<Slide>,
    pub(super) height: f64,
    tip_radius: f64,
    /// `N / 2π`, and the share of the tips' circumference that tips cover.
    per_turn: f64,
    tips: f64,
    /// rho, and the turn of a tip while the ground between two marks, less a tip's thickness, passes: at least 0 `[rad]`.
    speed_ratio: f64,
    pitch: f64,
    /// The point where tips reverse over the soil: the angle, and `rho sin θ − θ` there.
    turn: Option<[f64; 2]>,
    /// Distance behind the axle up to which flanks press in skid `[m]`.
    rear: f64,
    /// The shares of the ground that the surfaces of the current panels press.
    pub(super) shares: [[f64; NODES]; SURFACES],
}

impl Grousered {
    /// # Arguments
    /// - `tips`: the cylinder of the tips.
    /// - `slides`: whether a law uses the sliding of the rim.
    pub(super) fn new(
        (soil, wheel, condition): (&Soil, &Wheel, &Condition),
        grousers: &StraightGrousers,
        tips: &Rim,
        slides: bool,
    ) -> Self {
        let rim = Rim::new(soil, wheel, condition);
        let halfway = Wheel {
            radius_m: wheel.radius_m + 0.5 * grousers.height_m,
            ..*wheel
        };
        let per_turn = f64::from(grousers.count) / core::f64::consts::TAU;
        let thickness = grousers.thickness_m / tips.radius;
        let speed_ratio = tips.motion.rim_speed / tips.motion.forward;
        let turn = (speed_ratio > 1.0).then(|| {
            let angle = libm::acos(1.0 / speed_ratio);
            [angle, speed_ratio * libm::sin(angle) - angle]
        });
        let mut grousered = Self {
            slide: slides.then(|| Slide::new(rim.radius, &rim.motion, 0.0, rim.radius)),
            flank: Rim::new(soil, &halfway, condition),
            rim,
            height: grousers.height_m,
            tip_radius: tips.radius,
            per_turn,
            tips: per_turn * thickness,
            speed_ratio,
            pitch: (1.0 / per_turn - thickness * speed_ratio).max(0.0),
            turn,
            rear: 0.0,
            shares: [[0.0; NODES]; SURFACES],
        };
        grousered.rear = grousered.rear();
        grousered
    }

    /// Returns the distance behind the axle up to which flanks press in skid `[m]`: up to where the rim or the grouser
    /// ahead has pressed deeper than the tips, or where the flanks no longer move into the soil.
    fn rear(&self) -> f64 {
        if self.flank.motion.drives_everywhere() {
            return 0.0;
        }
        let (mut low, mut high) = (0.0, libm::acos(self.rim.radius / self.tip_radius));
        let swept = |angle: f64| angle - self.speed_ratio * libm::sin(angle);
        if swept(high) > 0.5 * self.pitch {
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if swept(middle) < 0.5 * self.pitch {
                    low = middle;
                } else {
                    high = middle;
                }
            }
        }
        (self.tip_radius * libm::sin(high)).min(self.flank_turn())
    }

    /// Returns x at which flanks begin to move into the soil, or cease to; infinite if they do neither.
    fn flank_turn(&self) -> f64 {
        // for a locked wheel, exactly the tips' radius where the tips' own sign changes
        let sine = self.flank.motion.sign_change();
        sine.map_or(f64::INFINITY, |sine| self.tip_radius * sine)
    }

    /// Returns the distance ahead of the axle up to which the rim touches soil `[m]`; 0 if only the tips touch.
    pub(super) fn front_of_rim(&self, hub_height: f64) -> f64 {
        let square = (self.rim.radius - hub_height) * (self.rim.radius + hub_height);
        square.max(0.0).sqrt()
    }

    /// Returns the sliding of the rim, with its radius and entry, if a law uses it.
    pub(super) fn slide_of_rim(&self, hub_height: f64) -> Option<(f64, &Slide, Entry)> {
        let slide = self.slide.as_ref()?;
        let entry = slide.enter(self.front_of_rim(hub_height));
        Some((self.rim.radius, slide, entry))
    }

    /// Returns the places where stresses and shares have kinks, in addition to those of the cylinder of the tips `[m]`.
    pub(super) fn kinks(&self, front_of_rim: f64) -> [f64; 3] {
        [
            front_of_rim,
            self.rim.sign_change.min(front_of_rim),
            self.flank_turn(),
        ]
    }

    /// Lays the surfaces over a piece of the contact ahead of the axle: tips, flanks and rim; returns the number that touch there.
    pub(super) fn lay(
        &mut self,
        tips: &Rim,
        contact: &Contact,
        front_of_rim: f64,
        [start, end]: [f64; 2],
        panels: &mut [Panel; SURFACES],
    ) -> usize {
        let [tip, flank, rim] = panels;
        tip.place(tips, contact, start, end);
        // the pressure holds gamma so far, which is the same for all surfaces of the footprint
        (*flank, *rim) = (*tip, *tip);
        let per_radius = 1.0 / self.tip_radius;
        let sine = tip.x.map(|x| x * per_radius);
        let touches = 0.5 * (start + end) < front_of_rim;
        let swept = self.swept(tip.x, sine, touches);
        for i in 0..NODES {
            let (x, cosine) = (tip.x[i], 1.0 / tip.secant[i]);
            let depth = tip.relative_sinkage[i] * contact.sinkage;
            let open = (1.0 - self.tips - swept[i]).max(0.0);
            let pushed = self.flank.motion.tangential(cosine) > 0.0;
            let chip = self.chip(sine[i], cosine, depth);
            let flanks = if pushed {
                self.flanks(chip, tip.tan_theta[i], cosine)
            } else {
                0.0
            };
            self.shares[0][i] = self.tips;
            self.shares[1][i] = flanks;
            self.shares[2][i] = (open - flanks).max(0.0);
            self.press(tip, i, contact, depth);
            self.press(flank, i, contact, depth - 0.5 * chip);
            self.flank.slip(flank, i, cosine);
            if touches {
                let height = ((self.rim.radius - x) * (self.rim.radius + x)).sqrt();
                rim.secant[i] = self.rim.radius / height;
                rim.tan_theta[i] = x / height;
                self.rim.slip(rim, i, height / self.rim.radius);
                let depth = (front_of_rim - x) * (front_of_rim + x) / (height + contact.hub_height);
                self.press(rim, i, contact, depth);
            }
        }
        (flank.arm, rim.arm) = (self.flank.radius, self.rim.radius);
        if touches { SURFACES } else { SURFACES - 1 }
    }

    /// Lays the flanks that press behind the axle; returns false if none do.
    pub(super) fn lay_behind(&mut self, contact: &Contact, panel: &mut Panel) -> bool {
        let above = contact.hub_height.max(self.rim.radius);
        let highest = ((self.tip_radius - above) * (self.tip_radius + above))
            .max(0.0)
            .sqrt();
        let rear = self.rear.min(highest);
        if rear <= 0.0 {
            return false;
        }
        (panel.extent, panel.arm) = (rear, self.flank.radius);
        for (i, place) in PLACE.into_iter().enumerate() {
            let x = rear * (place - 1.0);
            let height = ((self.tip_radius - x) * (self.tip_radius + x)).sqrt();
            let cosine = height / self.tip_radius;
            panel.x[i] = x;
            (panel.secant[i], panel.tan_theta[i]) = (self.tip_radius / height, x / height);
            let chip = height - above;
            self.shares[0][i] = self.flanks(chip, -panel.tan_theta[i], cosine);
            self.flank.slip(panel, i, cosine);
            panel.pressure[i] = 1.0; // a separate patch
            self.press(panel, i, contact, height - contact.hub_height - 0.5 * chip);
        }
        true
    }

    /// Returns the share of the ground at places that tips have swept since they were as deep as the rim is there; 0
    /// where the rim does not touch.
    fn swept(&self, x: [f64; NODES], sine: [f64; NODES], touches: bool) -> [f64; NODES] {
        if !touches {
            return [0.0; NODES];
        }
        let step = (self.tip_radius - self.rim.radius) * (self.tip_radius + self.rim.radius);
        let sine_before = x.map(|x| (x * x + step).sqrt() / self.tip_radius);
        let (angle, before) = (arcsine(sine), arcsine(sine_before));
        core::array::from_fn(|i| {
            let present = self.speed_ratio * sine[i] - angle[i];
            let past = self.speed_ratio * sine_before[i] - before[i];
            let farthest = match self.turn {
                Some([turn, way]) if angle[i] < turn && turn < before[i] => (way - present).max(way - past),
                _ => (past - present).abs(),
            };
            self.per_turn * farthest
        })
    }

    /// Returns the height of the flank that meets soil `[m]`: its whole height in the soil, or the depth that tips
    /// reach beyond those ahead.
    fn chip(&self, sine: f64, cosine: f64, depth: f64) -> f64 {
        let deeper = self.tip_radius * self.pitch * sine / (self.speed_ratio * cosine - 1.0).abs();
        deeper.min(self.height * cosine).min(depth)
    }

    /// Returns the share of the ground under flanks with this height in the soil `[m]`.
    fn flanks(&self, chip: f64, tangent: f64, cosine: f64) -> f64 {
        self.per_turn * tangent * chip / (cosine * self.flank.radius)
    }

    /// Turns gamma of a node into its pressure at a depth `[m]`.
    fn press(&self, panel: &mut Panel, i: usize, contact: &Contact, depth: f64) {
        let relative = (depth / contact.sinkage).max(f64::MIN_POSITIVE);
        panel.relative_sinkage[i] = relative;
        panel.pressure[i] *= contact.pressure_at_bottom * fraction_pow(relative, self.rim.soil.n);
    }
}

impl Rim {
    /// Sets the motion of a node on the cylinder.
    fn slip(&self, panel: &mut Panel, i: usize, cosine: f64) {
        let (tangential, lateral) = (self.motion.tangential(cosine), self.motion.lateral);
        panel.tangential[i] = tangential;
        panel.speed[i] = (tangential * tangential + lateral * lateral).sqrt();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{CONDITION, SOIL};

    const RADIUS: f64 = 0.125;
    const HEIGHT: f64 = 0.009;

    fn grousered(count: u32, slip: f64) -> (Grousered, Rim) {
        let [rim, tips] = [RADIUS, RADIUS + HEIGHT].map(|radius_m| Wheel {
            radius_m,
            width_m: 0.112,
            rig_radius_m: RADIUS,
        });
        let condition = Condition { slip, ..CONDITION };
        let grousers = StraightGrousers {
            count,
            height_m: HEIGHT,
            thickness_m: 1e-5,
        };
        let tips = Rim::new(&SOIL, &tips, &condition);
        let grousered = Grousered::new((&SOIL, &rim, &condition), &grousers, &tips, false);
        (grousered, tips)
    }

    /// Returns the share of the ground at x that a line-thin tip has passed more deeply than the rim is there: the test
    /// follows the ground of a whole spacing of marks, each point with the history of its tips.
    fn passed(count: u32, ratio: f64, x: f64) -> f64 {
        const POINTS: u32 = 400;
        const STEPS: u32 = 4_000;
        let (tip, pitch) = (RADIUS + HEIGHT, core::f64::consts::TAU / f64::from(count));
        let rim = (RADIUS * RADIUS - x * x).sqrt();
        let farthest = (tip * tip - rim * rim).sqrt();
        let first = libm::asin(x / tip);
        // tips turn by ratio / tip while the ground moves by a unit of length
        let way = |turned: f64| turned * tip / ratio;
        let is_passed = |phase: f64| {
            // the past positions, relative to the point, of the tip that is at an angle now
            let tip_passes = |number: i64| {
                let now = first + (phase + number as f64) * pitch;
                let ahead = |turned: f64| {
                    let angle = now + turned;
                    (tip * libm::sin(angle) - (x + way(turned)), angle)
                };
                let span = (libm::asin(farthest / tip) - now).max(0.0);
                let mut before = ahead(0.0);
                (1..=STEPS).any(|step| {
                    let current = ahead(span * f64::from(step) / f64::from(STEPS));
                    let crosses = (before.0 > 0.0) != (current.0 > 0.0);
                    before = current;
                    crosses && current.1 <= libm::asin(farthest / tip) && current.1 >= first - 1.6
                })
            };
            (-2 - i64::from(count) / 2..=i64::from(count) / 2).any(tip_passes)
        };
        let hits = (0..POINTS)
            .filter(|i| is_passed((f64::from(*i) + 0.5) / f64::from(POINTS)))
            .count();
        hits as f64 / f64::from(POINTS)
    }

    #[test]
    fn the_swept_share_agrees_with_marks_on_the_ground() {
        for (count, slip) in [
            (12, 0.2),
            (12, 0.6),
            (24, 0.4),
            (12, -0.05),
            (12, -0.3),
            (24, -0.6),
        ] {
            let (wheel, _) = grousered(count, slip);
            for x in [0.0, 0.01, 0.03] {
                let sine = [x / wheel.tip_radius; NODES];
                let share = wheel.swept([x; NODES], sine, true)[0].min(1.0);
                let counted = passed(count, wheel.speed_ratio, x);
                assert!((share - counted).abs() < 0.01, "{slip} {x}: {share} {counted}");
            }
        }
    }

    #[test]
    fn flanks_press_behind_the_axle_in_skid_alone() {
        assert!(grousered(12, 0.2).0.rear <= 0.0);
        assert!(grousered(12, -0.5).0.rear > 0.01);
    }
}
