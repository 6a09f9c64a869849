//! A law outside the library that a search claims, with its possible places and its forms.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::law_formulas::LawFormulas;

/// A law outside the library.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Outside {
    /// `pressure`, `shear`, `drawbar_pull`, `torque` or `sinkage`.
    pub acts_on: String,
    /// `z`, `v_n`, `v_t`, `j`, `position`, `slip`, `sled_speed`, `wheel_load` or `sinkage`.
    pub depends_on: String,
    /// The most probable places of the law, by falling probability: as many as have 0.95 together, and this one. Empty in records of
    /// earlier versions.
    #[serde(default)]
    pub places: Vec<LawPlace>,
    /// The form of the dependence: `step`, `power`, ..., or `spline`.
    pub form: String,
    /// Log evidence over that of the searched model \[nats\].
    pub log_bayes_factor: f64,
    /// The effect file, ready to be added.
    pub effect_file: String,
    /// Pairs of the variable and the factor on the quantity, or for a channel the addition to it.
    pub curve: Vec<[f64; 2]>,
    /// Log predictive density of left-out levels over that of the searched model, and over that of the best of the library \[nats\].
    pub left_out_nats: [f64; 2],
    /// The curve and every form of the law that was fitted: the claimed one, then the others by falling log Bayes factor. Empty in
    /// records of earlier versions.
    #[serde(default)]
    pub forms: Vec<FittedForm>,
    /// The formulas that the curve may follow; null where the curve was not fitted beyond the effects of the law, and in records of
    /// earlier versions.
    #[serde(default)]
    pub formulas: Option<LawFormulas>,
}

/// A place where a law outside the library may act.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct LawPlace {
    /// `pressure`, `shear`, `drawbar_pull`, `torque` or `sinkage`.
    pub acts_on: String,
    /// `z`, `v_n`, `v_t`, `j`, `position`, `slip`, `sled_speed`, `wheel_load` or `sinkage`.
    pub depends_on: String,
    /// Probability among all laws.
    pub probability: f64,
}

/// A form of a law outside the library, with its fitted values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct FittedForm {
    /// The form: `step`, `power`, ..., or `spline`.
    pub form: String,
    /// The quantity with the law, as a formula of effect files.
    pub formula: String,
    /// Log evidence over that of the searched model, on the scale of the law's \[nats\].
    pub log_bayes_factor: f64,
    /// Probability among the forms of this law, each of which has the same prior.
    pub probability: f64,
    /// Number of the class, from 1, in which these data cannot distinguish forms.
    pub class: u32,
}

impl LawPlace {
    /// Writes the place with its probability: `shear by sled speed (0.62)`.
    fn words(&self) -> String {
        let [acts_on, depends_on] = [&self.acts_on, &self.depends_on].map(|name| name.replace('_', " "));
        format!("{acts_on} by {depends_on} ({:.2})", self.probability)
    }

    /// Returns whether this is the place of a law.
    #[must_use]
    pub fn is_of(&self, law: &Outside) -> bool {
        self.acts_on == law.acts_on && self.depends_on == law.depends_on
    }
}

impl Outside {
    /// Minimum difference of log Bayes factors by which the data prefer a form \[nats\].
    const PREFERRED: f64 = 3.0;
    /// Maximum number of forms that are named as alike.
    const MAX_ALIKE: usize = 3;
    /// A place is stated alone if its probability is higher.
    const PLACED: f64 = 0.9;

    /// Returns the places of the law if these data do not tell them apart; none if the claimed one has more than 0.9 of the probability,
    /// or is the only one.
    #[must_use]
    pub fn open_places(&self) -> &[LawPlace] {
        let is_told = |place: &LawPlace| place.is_of(self) && place.probability > Self::PLACED;
        match self.places.len() < 2 || self.places.iter().any(is_told) {
            true => &[],
            false => &self.places,
        }
    }

    /// Writes the places if these data do not tell them apart: `shear by sled speed (0.62) or shear by v n (0.35)`.
    #[must_use]
    pub fn places_alike(&self) -> Option<String> {
        let words: Vec<String> = self.open_places().iter().map(LawPlace::words).collect();
        let (last, before) = words.split_last()?;
        Some(format!("{} or {last}", before.join(", ")))
    }

    /// Returns the leading forms if others fit as well as the best: `saturation (93.1), log (92.8) and power (91.0)`. `None` if one is
    /// preferred.
    #[must_use]
    pub fn forms_alike(&self) -> Option<String> {
        let best = self.forms.iter().map(|form| form.log_bayes_factor);
        let best = best.fold(f64::NEG_INFINITY, f64::max);
        let leading = self.forms.iter().take(Self::MAX_ALIKE);
        let alike = leading.filter(|form| best - form.log_bayes_factor <= Self::PREFERRED);
        let alike: Vec<String> = alike
            .map(|form| format!("{} ({:.1})", form.form.replace('_', " "), form.log_bayes_factor))
            .collect();
        let (last, others) = alike.split_last()?;
        (!others.is_empty()).then(|| format!("{} and {last}", others.join(", ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A law of the shear stress by the depth, with places along these variables.
    fn law(places: &[(&str, f64)]) -> Outside {
        let place = |(depends_on, probability): &(&str, f64)| LawPlace {
            acts_on: "shear".into(),
            depends_on: (*depends_on).into(),
            probability: *probability,
        };
        Outside {
            acts_on: "shear".into(),
            depends_on: "z".into(),
            places: places.iter().map(place).collect(),
            form: "linear".into(),
            log_bayes_factor: 20.0,
            effect_file: String::new(),
            curve: Vec::new(),
            left_out_nats: [0.0; 2],
            forms: Vec::new(),
            formulas: None,
        }
    }

    #[test]
    fn a_place_is_stated_alone_where_the_data_tell_it() {
        let words = |places| law(places).places_alike();
        let both = "shear by wheel load (0.57) or shear by z (0.43)";
        assert_eq!(words(&[("wheel_load", 0.57), ("z", 0.43)]).as_deref(), Some(both));
        assert_eq!(words(&[("z", 0.91), ("wheel_load", 0.09)]), None);
        assert_eq!(words(&[("z", 0.5)]), None);
        // Another place than the claimed one may be the probable one.
        assert!(words(&[("wheel_load", 0.97), ("z", 0.03)]).is_some());
        assert_eq!(words(&[]), None);
    }
}
