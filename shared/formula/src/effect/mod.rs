//! Effects and their files.

mod file;
mod names;
mod neutral;
mod place;

use strum::{EnumString, IntoStaticStr, VariantArray};

use crate::evaluation::program::Program;
use crate::hook::Hook;
use crate::syntax::graph::{Graph, Id};
use crate::syntax::proportion::is_proportional;
use crate::variable::{Variable, Variables};

/// A mechanism that may be missing from the model: formulas for some of its quantities, with their parameters.
///
/// At the neutral value of its strengths an effect is not evaluated, so the model equals the model without it, bit for bit.
#[derive(Debug, Clone)]
pub struct Effect {
    /// Name in jobs and results.
    pub name: String,
    /// One line that describes the effect.
    pub summary: String,
    /// The source that describes the effect.
    pub source: String,
    /// The part of a model that has this effect in code, if any.
    pub mechanism: Option<Mechanism>,
    /// The parameters, in the order of the file.
    pub parameters: Vec<Parameter>,
    /// The text of the file.
    pub text: String,
    formulas: Vec<(Hook, Id)>,
    graph: Graph,
}

/// A parameter of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Name within the effect; `EFFECT.NAME` elsewhere.
    pub name: String,
    /// Unit as the file states it.
    pub unit: String,
    /// The value at which the effect is absent; `None` for a parameter that only shapes it.
    pub neutral: Option<f64>,
    /// The value at which tables show the effect.
    pub typical: Option<f64>,
    /// The prior as written: a number, which fixes the parameter, or a table with a distribution.
    pub prior: toml::Value,
    /// Line in the file.
    pub line: usize,
}

/// An effect that a model has in code, because no formula at a point can express it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, EnumString, IntoStaticStr, VariantArray)]
#[strum(serialize_all = "snake_case")]
pub enum Mechanism {
    /// The soil springs back behind the axle.
    Rebound,
    /// The rim is flattened by its load.
    FlatPatch,
    /// The sliding wheel carries soil away from under itself.
    Digging,
    /// The soil is stiffer near the ends of its bin.
    EndWall,
    /// The buried side of the wheel pushes soil at a slip angle.
    SideWall,
}

impl Mechanism {
    /// Every mechanism.
    pub const ALL: &'static [Self] = Self::VARIANTS;

    /// Returns the name in effect files.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Returns the parameters that it takes, in order.
    pub fn parameters(self) -> &'static [&'static str] {
        match self {
            Mechanism::Rebound => &["compliance_m_pa"],
            Mechanism::FlatPatch => &["deflection_m_n"],
            Mechanism::Digging => &["depth_m"],
            Mechanism::EndWall => &["wall_stiffening", "reach_m"],
            Mechanism::SideWall => &["passive_scale", "wall_friction"],
        }
    }

    /// Returns the variables that it uses in addition to those of the effect's formulas.
    fn uses(self) -> Variables {
        match self {
            Mechanism::SideWall => Variables::new(&[Variable::Density, Variable::Gravity]),
            Mechanism::Rebound | Mechanism::FlatPatch | Mechanism::Digging | Mechanism::EndWall => {
                Variables::default()
            }
        }
    }
}

/// Why an effect file cannot be used, and where.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}{message}", prefix(*line, *column))]
pub struct EffectError {
    /// Line, counted from 1; `None` if the whole file is to blame.
    pub line: Option<usize>,
    /// Column, counted from 1; `None` if no column is to blame.
    pub column: Option<usize>,
    /// Description of the mistake.
    pub message: String,
}

fn prefix(line: Option<usize>, column: Option<usize>) -> String {
    match (line, column) {
        (Some(line), Some(column)) => format!("line {line}, column {column}: "),
        (Some(line), None) => format!("line {line}: "),
        _ => String::new(),
    }
}

impl Effect {
    /// The maximum size of a file, in bytes.
    pub const LONGEST: usize = 32_768;

    /// Returns the quantities that its formulas replace, in the order of evaluation.
    pub fn hooks(&self) -> impl Iterator<Item = Hook> {
        self.formulas.iter().map(|(hook, _)| *hook)
    }

    /// Compiles the formula for a quantity, where the variables `local` differ from point to point; `None` if the
    /// effect has no such formula.
    ///
    /// `local` may hold the first [`Variable::LOCAL`] variables: only they have columns in a [`Block`](crate::evaluation::block::Block). The
    /// choice changes no bit of a value. Checked by `fuzzed::any_formula_has_the_same_bits_at_one_point_and_in_blocks`.
    ///
    /// # Panics
    /// If `local` holds another variable.
    pub fn program(&self, hook: Hook, local: Variables) -> Option<Program> {
        let has_column = |variable: Variable| (variable as usize) < Variable::LOCAL;
        assert!(
            local.iter().all(has_column),
            "only variables of nodes may differ from point to point"
        );
        let result = self.formulas.iter().find(|(h, _)| *h == hook)?.1;
        Some(Program::compile(&self.graph, result, local))
    }

    /// Returns whether its formula at a hook is the replaced quantity times a factor that does not depend on that quantity.
    pub fn only_scales(&self, hook: Hook) -> bool {
        self.formulas
            .iter()
            .find(|(candidate, _)| *candidate == hook)
            .is_some_and(|(_, result)| is_proportional(&self.graph, *result, hook.target()))
    }

    /// Returns the variables that its formulas and its mechanism use.
    pub fn uses(&self) -> Variables {
        let uses = self
            .formulas
            .iter()
            .map(|(_, result)| self.graph.variables(*result));
        let mechanism = self.mechanism.map(Mechanism::uses).unwrap_or_default();
        uses.fold(mechanism, Variables::union)
    }

    /// Returns whether it needs the laws of Bekker and Mohr-Coulomb for the soil at a point: it replaces a quantity of these
    /// laws, or uses their parameters. A model without these laws cannot express it.
    pub fn needs_soil_laws(&self) -> bool {
        const HOOKS: [Hook; 4] = [
            Hook::SinkageExponent,
            Hook::Pressure,
            Hook::ShearLimit,
            Hook::Shear,
        ];
        const PARAMETERS: [Variable; 5] = [
            Variable::FrictionAngle,
            Variable::Cohesion,
            Variable::N,
            Variable::ShearVelocity,
            Variable::KStar,
        ];
        self.hooks().any(|hook| HOOKS.contains(&hook)) || self.uses().meets(Variables::new(&PARAMETERS))
    }

    /// Returns the position of a parameter by name.
    pub fn parameter(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|p| p.name == name)
    }

    /// Returns whether all strengths are neutral at these values of the parameters, so that the effect changes nothing.
    ///
    /// An effect without strengths always acts. `values` are in the order and units of the parameters; −0 counts as 0, and
    /// NaN is not neutral. Checked by `evaluation::zero_of_either_sign_is_neutral`.
    pub fn is_neutral(&self, values: &[f64]) -> bool {
        let mut strengths = self.parameters.iter().zip(values);
        let any = self.parameters.iter().any(|p| p.neutral.is_some());
        any && strengths.all(|(p, value)| {
            // the difference treats 0 and -0 alike, and NaN as not neutral
            p.neutral.is_none_or(|neutral| value - neutral == 0.0)
        })
    }
}
