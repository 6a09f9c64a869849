//! A wheel in three dimensions, ready to roll, for tests and the validation table.

use crate::support::{Case, base};
use formula::Effect;
use scm::effects::{CompiledEffects, ModelForm, Site};
use scm::spatial::{Ground, Grousers, Protocol, RunSettings, Scene, Shape, SpatialRun, simulate};
use scm::{Averages, Rejection};

/// A case with the settings of the three-dimensional model.
#[derive(Debug, Clone)]
pub(crate) struct Track {
    pub(crate) case: Case,
    pub(crate) ground: Ground,
    pub(crate) shape: Shape,
    pub(crate) settings: RunSettings,
    /// Effects with the values of their parameters.
    pub(crate) effects: Vec<(Effect, Vec<f64>)>,
    pub(crate) site: Site,
}

impl Track {
    /// Returns a smooth wheel on soil that compacts and does not flow, as in the quasi-static model.
    pub(crate) fn smooth(case: Case) -> Self {
        Self {
            case,
            ground: Ground {
                flow_fraction: 0.0,
                ..Ground::default()
            },
            shape: Shape::Rim(Grousers::default()),
            settings: RunSettings::default(),
            effects: Vec::new(),
            site: Site::default(),
        }
    }

    /// Returns twelve grousers of 9 mm by 2 mm, on soil a quarter of which flows.
    pub(crate) fn with_grousers(case: Case) -> Self {
        Self {
            ground: Ground::default(),
            shape: Shape::Rim(bars(12, 0.009, 0.002)),
            ..Self::smooth(case)
        }
    }

    /// Sets the end of a steady run: a tolerance, and a maximum travel `[m]`.
    pub(crate) fn end_steady(&mut self, tolerance: f64, most_travel_m: f64) {
        self.settings.protocol = Protocol::Steady {
            tolerance,
            most_travel_m,
        };
    }

    /// Rolls a distance unconditionally, and averages over the last part of it.
    pub(crate) fn for_a_travel_of(mut self, travel_m: f64, averaged_m: f64) -> Self {
        let speed = self.case.condition.sled_speed_m_s;
        let cut = (travel_m - averaged_m) / speed;
        self.settings.protocol = Protocol::Fixed {
            duration_s: travel_m / speed,
            transient_force_s: cut,
            transient_sinkage_s: cut,
            lowpass_hz: 0.0,
        };
        self
    }

    /// Adds an effect at these values of its parameters.
    pub(crate) fn enter(&mut self, effect: &Effect, values: &[f64]) {
        self.effects.push((effect.clone(), values.to_vec()));
    }

    /// Adds an effect of the catalogue.
    pub(crate) fn enter_named(&mut self, name: &str, values: &[f64]) {
        let effect = formula::catalogue::find(name).unwrap_or_else(|| panic!("no effect {name}"));
        self.enter(effect, values);
    }

    /// Adds Janosi and Hanamoto's law with a shear modulus `[m]`.
    pub(crate) fn enter_displacement_law(&mut self, shear_modulus_m: f64) {
        self.enter_named("janosi_hanamoto", &[shear_modulus_m]);
    }

    pub(crate) fn try_roll(&self) -> Result<SpatialRun, Rejection> {
        let Case {
            soil,
            wheel,
            condition,
        } = &self.case;
        let effects = self.effects.iter().map(|(effect, _)| effect);
        let effects = CompiledEffects::compile(ModelForm::Spatial, effects)
            .expect("effects that the model can express");
        let values = self.effects.iter().map(|(_, values)| values.clone());
        let scene = Scene {
            soil,
            ground: &self.ground,
            wheel,
            shape: &self.shape,
            effects: &effects.activate(values),
            site: self.site,
        };
        simulate(&scene, condition, &self.settings)
    }

    pub(crate) fn roll(&self) -> SpatialRun {
        self.try_roll()
            .unwrap_or_else(|rejection| panic!("{rejection}: {self:?}"))
    }

    pub(crate) fn averages(&self) -> Averages {
        self.roll().averages
    }
}

/// Grousers of a height `[m]` and a thickness `[m]`.
pub(crate) const fn bars(count: u32, height_m: f64, thickness_m: f64) -> Grousers {
    Grousers {
        count,
        height_m,
        thickness_m,
    }
}

/// Returns twelve grousers of 9 mm at a slip, under 100 N, on sand of 30°.
pub(crate) fn grousered(slip: f64) -> Track {
    Track::with_grousers(base(slip, 100.0, 30.0))
}

/// Returns a smooth wheel and one with grousers at a slip of 0.2, under 100 N, on sand of 30°.
pub(crate) fn both() -> [Track; 2] {
    [smooth(0.2, 100.0, 30.0), grousered(0.2)]
}

/// Returns the largest magnitude of some values.
pub(crate) fn max_abs(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, x| largest.max(x.abs()))
}

/// Difference of the largest and the smallest of some values.
pub(crate) fn range(values: &[f64]) -> f64 {
    let bound = |fold: fn(f64, f64) -> f64| values.iter().copied().reduce(fold).expect("values");
    bound(f64::max) - bound(f64::min)
}

/// Returns a smooth wheel at a slip, under a load `[N]`, on sand of an angle of friction `[°]`.
pub(crate) fn smooth(slip: f64, wheel_load_n: f64, friction_angle_deg: f64) -> Track {
    Track::smooth(base(slip, wheel_load_n, friction_angle_deg))
}
