//! Effects: formulas and mechanisms that replace quantities of the base model.
//!
//! # Layout
//! - This file: [`CompiledEffects`], compiled for one model, and [`Active`], the effects whose strength is not neutral.
//! - `case`: the run after the effects on slip, dimensions, exponent and load.
//! - `error`: why a model cannot express an effect.
//! - `law`: an effect compiled for one model.
//! - `node`: pressure, strength and stress at many nodes.
//! - `channel`: the measured channels.
//!
//! At a hook, effects follow the order of their compilation; hooks follow the order of [`Hook::ALL`]. Without an active
//! effect a model runs its base code, bit for bit.

pub(crate) mod case;
mod channel;
mod error;
mod law;
mod node;

pub use error::FormError;
pub(crate) use node::NodeLaws;

use formula::effect::Mechanism;
use formula::variable::Variables;
use formula::{Effect, Hook, Program, Variable};

use law::{Law, formulas_at};

/// The forward models as far as effects distinguish them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelForm {
    /// [`quasi_static`](crate::quasi_static): there is one footprint, so its modulus and width are the same at all nodes.
    QuasiStatic,
    /// [`quasi_static`](crate::quasi_static) with the stresses of [`WongReece`](crate::WongReece), which have neither flat nor rebound.
    WongReece,
    /// [`rft`](crate::rft): stresses depend on motion and depth alone, so no formula enters at a node.
    Rft,
    /// [`spatial`](crate::spatial): modulus and width belong to the footprint or to its patches, see
    /// [`Footprint`](crate::spatial::Footprint).
    Spatial,
    /// A model outside this crate: effects act on its inputs and its outputs, see [`OutsideRun`](crate::outside::OutsideRun).
    Outside,
}

impl ModelForm {
    /// Returns the name in messages.
    fn name(self) -> &'static str {
        match self {
            ModelForm::QuasiStatic => "quasi_static",
            ModelForm::WongReece => "wong_reece",
            ModelForm::Rft => "rft",
            ModelForm::Spatial => "scm",
            ModelForm::Outside => "a model that is not ours",
        }
    }

    /// Returns the mechanisms that the model implements in code; it then ignores the effect's formulas.
    fn mechanisms(self) -> &'static [Mechanism] {
        match self {
            ModelForm::QuasiStatic => &[Mechanism::Rebound, Mechanism::FlatPatch],
            ModelForm::WongReece | ModelForm::Rft => &[],
            ModelForm::Spatial => Mechanism::ALL,
            ModelForm::Outside => &[],
        }
    }

    /// Returns the variables that differ from node to node.
    fn local(self) -> Variables {
        use Variable::{BEff, J, KStar, P, Position, Tau, TauMax, Vn, Vt, Z};
        let both = Variables::new(&[P, Z, Vn, Vt, J, Position, TauMax, Tau]);
        match self {
            ModelForm::QuasiStatic | ModelForm::WongReece | ModelForm::Rft | ModelForm::Outside => both,
            ModelForm::Spatial => both.with(KStar).with(BEff),
        }
    }
}

/// Properties of the test site that effects may use, beyond soil, wheel and condition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// Density of the soil `[kg/m³]`, if known.
    pub density_kg_m3: Option<f64>,
    /// Acceleration of gravity `[m/s²]`.
    pub gravity_m_s2: f64,
    /// Number of grousers on the wheel.
    pub grouser_count: u32,
    /// Height of the grousers `[m]`.
    pub grouser_height_m: f64,
    /// Length of the soil bin `[m]`, if known.
    pub bin_length_m: Option<f64>,
    /// Position of the run in the series of the campaign, from −0.5 to 0.5, if known.
    pub order: Option<f64>,
}

impl Default for Site {
    /// Returns a site on Earth with a smooth wheel, whose other properties are unknown.
    fn default() -> Self {
        Self {
            density_kg_m3: None,
            gravity_m_s2: 9.81,
            grouser_count: 0,
            grouser_height_m: 0.0,
            bin_length_m: None,
            order: None,
        }
    }
}

/// Effects compiled for one model.
#[derive(Debug, Clone)]
pub struct CompiledEffects {
    laws: Vec<Law>,
}

impl CompiledEffects {
    /// Compiles effects in this order; [`FormError`] names the effect that the model cannot express.
    pub fn compile<'a>(
        model: ModelForm,
        effects: impl IntoIterator<Item = &'a Effect>,
    ) -> Result<Self, FormError> {
        let law = |effect: &Effect| {
            let mechanism = effect.mechanism.filter(|m| model.mechanisms().contains(m));
            let without_laws = model == ModelForm::Rft && effect.needs_soil_laws();
            if without_laws || mechanism.is_none() && effect.hooks().next().is_none() {
                let (effect, model) = (effect.name.clone(), model.name());
                return Err(FormError::NoForm { effect, model });
            }
            let names = effect.parameters.iter().map(|p| p.name.as_str());
            if let Some(mechanism) = mechanism.filter(|m| !names.clone().eq(m.parameters().iter().copied())) {
                let expected = mechanism.parameters().join(", ");
                return Err(FormError::Parameters {
                    effect: effect.name.clone(),
                    mechanism: mechanism.name(),
                    expected,
                });
            }
            let program = |hook: Hook| match mechanism {
                Some(_) => None,
                None => effect.program(hook, model.local()),
            };
            Ok(Law {
                effect: effect.clone(),
                programs: Hook::ALL.map(program),
                mechanism,
            })
        };
        let laws = effects.into_iter().map(law).collect::<Result<_, _>>()?;
        Ok(Self { laws })
    }

    /// Returns the effects, in their order.
    pub fn effects(&self) -> impl Iterator<Item = &Effect> {
        self.laws.iter().map(|law| &law.effect)
    }

    /// Selects the effects that are active at these values: one list for each effect, in the order of its file's parameters.
    pub fn activate(&self, values: impl IntoIterator<Item = Vec<f64>>) -> Active<'_> {
        let laws = self.laws.iter().zip(values);
        let mut active = Active {
            laws: laws
                .filter(|(law, values)| !law.effect.is_neutral(values))
                .collect(),
            entered: [false; Hook::COUNT],
            nodes: None,
        };
        active.entered = Hook::ALL.map(|hook| active.at(hook).next().is_some());
        active.nodes = NodeLaws::new(&active.laws);
        active
    }
}

/// The effects of a run whose strength is not neutral, with the values of their parameters.
#[derive(Debug, Clone, Default)]
pub struct Active<'a> {
    laws: Vec<(&'a Law, Vec<f64>)>,
    /// True by hook if a formula enters there.
    entered: [bool; Hook::COUNT],
    /// The formulas at nodes, ready to be lent to a model, if there are any.
    pub(crate) nodes: Option<NodeLaws<'a>>,
}

impl<'a> Active<'a> {
    /// Returns whether no effect is active, so that the model is the base.
    pub(crate) fn is_empty(&self) -> bool {
        self.laws.is_empty()
    }

    /// Returns whether a formula enters at a hook.
    pub(crate) fn enter(&self, hook: Hook) -> bool {
        self.entered[hook as usize]
    }

    /// Returns the formulas at a hook, in order, each with its effect and parameters.
    fn at(&self, hook: Hook) -> impl Iterator<Item = (&'a Program, &'a Law, &[f64])> {
        formulas_at(&self.laws, hook)
    }

    /// Returns the parameters of an effect that the model implements in code, in the order of the effect's file.
    pub(crate) fn mechanism(&self, mechanism: Mechanism) -> Option<&[f64]> {
        let law = self.laws.iter().find(|(law, _)| law.mechanism == Some(mechanism));
        law.map(|(_, values)| values.as_slice())
    }
}
