//! The quantities that a formula may replace.

use crate::variable::{Variable, Variables};

/// A place in the model where effects enter: the quantity that a formula replaces.
///
/// A formula sees the quantity after the effects before it. The hooks stand in the order of their evaluation; at one
/// hook, effects follow the order of the catalogue, then that of the files in a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Hook {
    /// Slip, in [−1, 1), at the rim's speed: the speed of the sled follows from it.
    Slip,
    /// Radius of the rim, > 0.
    Radius,
    /// Width of the rim, > 0.
    Width,
    /// Sinkage exponent n, in (0, 10].
    SinkageExponent,
    /// Load that the soil must carry, > 0; may depend on pull and torque, which depend on this load in turn.
    WheelLoad,
    /// Normal pressure at a node, ≥ 0.
    Pressure,
    /// Shear strength at a node, ≥ 0.
    ShearLimit,
    /// Shear stress at a node, ≥ 0.
    Shear,
    /// Measured drawbar pull.
    DrawbarPull,
    /// Measured torque.
    Torque,
    /// Measured sinkage.
    Sinkage,
    /// Measured lateral force.
    LateralForce,
}

/// Every hook with its key in effect files and the variable that it replaces, in the order of the enumeration.
const TABLE: [(Hook, &str, Variable); Hook::COUNT] = [
    (Hook::Slip, "slip", Variable::Slip),
    (Hook::Radius, "radius", Variable::Radius),
    (Hook::Width, "width", Variable::Width),
    (Hook::SinkageExponent, "sinkage_exponent", Variable::N),
    (Hook::WheelLoad, "wheel_load", Variable::WheelLoad),
    (Hook::Pressure, "pressure", Variable::P),
    (Hook::ShearLimit, "shear_limit", Variable::TauMax),
    (Hook::Shear, "shear", Variable::Tau),
    (Hook::DrawbarPull, "drawbar_pull", Variable::DrawbarPull),
    (Hook::Torque, "torque", Variable::Torque),
    (Hook::Sinkage, "sinkage", Variable::Sinkage),
    (Hook::LateralForce, "lateral_force", Variable::LateralForce),
];

impl Hook {
    /// The number of hooks.
    pub const COUNT: usize = 12;

    /// Every hook, in the order of evaluation.
    pub const ALL: [Hook; Hook::COUNT] = {
        let mut all = [Hook::Slip; Hook::COUNT];
        let mut place = 0;
        while place < all.len() {
            all[place] = TABLE[place].0;
            place += 1;
        }
        all
    };

    /// The measured channels: each formula sees the channels before this effect.
    pub const CHANNELS: [Hook; 4] = [Hook::DrawbarPull, Hook::Torque, Hook::Sinkage, Hook::LateralForce];

    /// Returns the key in effect files.
    pub fn name(self) -> &'static str {
        TABLE[self as usize].1
    }

    /// Returns the variable that the formula replaces.
    pub fn target(self) -> Variable {
        TABLE[self as usize].2
    }

    /// Returns the variables that its formula may use.
    pub fn sees(self) -> Variables {
        use Variable::{
            BEff, ContactLength, DrawbarPull, J, KStar, LateralForce, P, Position, Sinkage, Tau, TauMax,
            Torque, Vn, Vt, Z,
        };
        let run = Variables::OF_RUN;
        let contact = run.union(Variables::new(&[ContactLength, BEff, KStar]));
        let node = contact.union(Variables::new(&[P, Z, Vn, Vt, J, Position]));
        match self {
            Hook::Slip | Hook::Radius | Hook::Width | Hook::SinkageExponent => run,
            Hook::WheelLoad => run.with(DrawbarPull).with(Torque),
            Hook::Pressure => node,
            Hook::ShearLimit => node.with(TauMax),
            Hook::Shear => node.with(TauMax).with(Tau),
            Hook::DrawbarPull | Hook::Torque | Hook::Sinkage | Hook::LateralForce => {
                contact.union(Variables::new(&[DrawbarPull, Torque, Sinkage, LateralForce]))
            }
        }
    }

    /// Returns whether its quantity may have this value.
    pub fn admits(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Hook::Slip => (-1.0..1.0).contains(&value),
                Hook::Radius | Hook::Width | Hook::WheelLoad => value > 0.0,
                Hook::SinkageExponent => value > 0.0 && value <= 10.0,
                Hook::Pressure | Hook::ShearLimit | Hook::Shear => value >= 0.0,
                Hook::DrawbarPull | Hook::Torque | Hook::Sinkage | Hook::LateralForce => true,
            }
    }

    /// Returns the bound that [`Hook::admits`] checks, in words.
    pub fn bound(self) -> &'static str {
        match self {
            Hook::Slip => "in [-1, 1)",
            Hook::Radius | Hook::Width | Hook::WheelLoad => "finite and above 0",
            Hook::SinkageExponent => "above 0 and at most 10",
            Hook::Pressure | Hook::ShearLimit | Hook::Shear => "finite and at least 0",
            Hook::DrawbarPull | Hook::Torque | Hook::Sinkage | Hook::LateralForce => "finite",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_formula_sees_the_quantity_that_it_replaces() {
        for (place, hook) in Hook::ALL.into_iter().enumerate() {
            assert_eq!(hook as usize, place);
            assert!(hook.sees().contains(hook.target()), "{}", hook.name());
        }
    }
}
