//! The base case of tests, comparisons of runs, and reproducible pseudo-random numbers.

use formula::Effect;
use scm::effects::{Active, CompiledEffects, ModelForm, Site};
use scm::{Averages, Condition, Rejection, Soil, Wheel, quasi_static};

/// A soil, a wheel and a condition.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Case {
    pub(crate) soil: Soil,
    pub(crate) wheel: Wheel,
    pub(crate) condition: Condition,
}

impl Case {
    pub(crate) fn try_simulate(&self) -> Result<Averages, Rejection> {
        quasi_static::simulate(&self.soil, &self.wheel, &self.condition)
    }

    pub(crate) fn simulate(&self) -> Averages {
        self.try_simulate()
            .unwrap_or_else(|rejection| panic!("{rejection}: {self:?}"))
    }

    pub(crate) fn simulate_with(&self, effects: &mut Active, site: &Site) -> Result<Averages, Rejection> {
        quasi_static::simulate_with(&self.soil, &self.wheel, &self.condition, effects, site)
    }

    /// Rotation speed omega [rad/s] from the rig's radius.
    pub(crate) fn omega(&self) -> f64 {
        let (slip, v) = (self.condition.slip, self.condition.sled_speed_m_s);
        v * (1.0 + slip.min(0.0)) / (1.0 - slip.max(0.0)) / self.wheel.rig_radius_m
    }
}

/// Cohesionless sand, 30 degrees, under a 100 N wheel of 125 mm whose rim moves at 10 mm/s.
pub(crate) fn base(slip: f64, wheel_load_n: f64, friction_angle_deg: f64) -> Case {
    Case {
        soil: Soil {
            k_c: 0.0,
            k_phi: 1e7,
            n: 1.1,
            cohesion_pa: 0.0,
            friction_angle_rad: friction_angle_deg.to_radians(),
            shear_velocity_m_s: 1e-3,
            gamma_exponent: 0.5,
        },
        wheel: Wheel {
            radius_m: 0.125,
            width_m: 0.112,
            rig_radius_m: 0.125,
        },
        condition: Condition {
            slip,
            wheel_load_n,
            sled_speed_m_s: 0.01 * (1.0 - slip),
            slip_angle_rad: 0.0,
            pass: 1,
        },
    }
}

/// Compiles effects for the quasi-static model.
pub(crate) fn compiled<'a>(effects: impl IntoIterator<Item = &'a Effect>) -> CompiledEffects {
    CompiledEffects::compile(ModelForm::QuasiStatic, effects).expect("effects that the model can express")
}

/// Reads an effect without parameters, from the lines of its file that state its formulas.
pub(crate) fn law(formulas: &str) -> Effect {
    let text = format!("name = \"odd\"\nsummary = \"an odd law\"\nsource = \"none\"\n{formulas}\n");
    Effect::read(&text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Asserts that drawbar pull `[N]` and torque \[N m\] of two runs differ by less than these bounds, and their sinkages by
/// less than a relative bound; an infinite bound compares nothing.
#[track_caller]
pub(crate) fn assert_near(got: &Averages, expected: &Averages, [pull, torque, sinkage]: [f64; 3]) {
    let near = (got.drawbar_pull_n - expected.drawbar_pull_n).abs() < pull
        && (got.torque_n_m - expected.torque_n_m).abs() < torque
        && (got.sinkage_m / expected.sinkage_m - 1.0).abs() < sinkage;
    assert!(near, "{got:?} is not {expected:?} to {pull}, {torque}, {sinkage}");
}

/// A linear congruential generator (Knuth's MMIX constants).
pub(crate) struct Draws(pub(crate) u64);

impl Draws {
    pub(crate) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        self.uniform(low.ln(), high.ln()).exp()
    }

    /// Returns a normal number within bounds: the sum of twelve uniform ones, drawn again if it is outside.
    pub(crate) fn normal(&mut self, mean: f64, sd: f64, [low, high]: [f64; 2]) -> f64 {
        loop {
            let sum: f64 = (0..12).map(|_| self.uniform(-0.5, 0.5)).sum();
            let value = mean + sd * sum;
            if (low..=high).contains(&value) {
                return value;
            }
        }
    }

    /// Returns a number from one of the ranges with equal probability; an empty range is a fixed value.
    fn any_of(&mut self, ranges: &[(f64, f64)]) -> f64 {
        let (low, high) = ranges[self.uniform(0.0, ranges.len() as f64) as usize];
        self.uniform(low, high)
    }

    /// Draws wheels from 58 to 150 mm, soft to hard soil, drive and skid, straight and at an angle.
    pub(crate) fn case(&mut self) -> Case {
        let n = self.uniform(0.7, 1.8);
        let kappa = self.any_of(&[(0.0, 0.0), (0.0, 0.0), (-0.6, 0.0), (0.0, 2.0)]);
        let (k_c, k_phi) = scm::bekker_moduli(self.uniform(2.8, 5.6), kappa, n);
        let radius_m = self.any_of(&[(0.058, 0.0625), (0.125, 0.125), (0.15, 0.15)]);
        let slip = self.any_of(&[(0.0, 0.8), (-0.8, 0.0), (-0.1, 0.0), (-1.0, -1.0)]);
        Case {
            soil: Soil {
                k_c,
                k_phi,
                n,
                cohesion_pa: self.any_of(&[(0.0, 0.0), (0.0, 0.0), (0.0, 500.0)]),
                friction_angle_rad: self.uniform(15.0, 40.0).to_radians(),
                shear_velocity_m_s: self.log_uniform(2e-4, 5e-3),
                gamma_exponent: self.any_of(&[(0.0, 0.0), (0.5, 0.5), (0.5, 0.5), (1.0, 1.0)]),
            },
            wheel: Wheel {
                radius_m,
                width_m: radius_m * self.uniform(0.6, 1.2),
                rig_radius_m: radius_m * self.uniform(0.9, 1.0),
            },
            condition: Condition {
                slip,
                wheel_load_n: self.log_uniform(20.0, 300.0) * (radius_m / 0.125) * (radius_m / 0.125),
                sled_speed_m_s: self.log_uniform(5e-3, 8e-2),
                slip_angle_rad: self.any_of(&[(0.0, 0.0), (-0.1, 0.1), (-0.7, 0.7)]),
                pass: 1,
            },
        }
    }
}
