//! The variables that a formula can use.

use crate::unit::Unit;

/// A quantity of the model that formulas may use, in SI units; a magnitude, ≥ 0, unless stated otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Variable {
    /// Normal pressure at a node of the contact.
    P,
    /// Sinkage of a node below the undisturbed surface.
    Z,
    /// Velocity of the wheel's surface into the soil, along its normal.
    Vn,
    /// Slip velocity of the wheel's surface along the soil.
    Vt,
    /// Shear displacement: the distance that the wheel's surface has slid since it met the soil.
    J,
    /// Position of a node in the contact: 0 at the rear end, 1 at the front entry.
    Position,
    /// Modulus k* = `k_c` / `b_eff` + `k_phi` of the footprint that holds the node; its unit depends on n.
    KStar,
    /// Effective width 2 A / L of the footprint that holds the node.
    BEff,
    /// Shear strength at a node.
    TauMax,
    /// Shear stress at a node.
    Tau,
    /// Length of the contact along the ground.
    ContactLength,
    /// Slip, in [−1, 1): negative in skid. It is nominal: it uses the speed of the sled along its travel, whatever the
    /// wheel's heading.
    Slip,
    /// Angle from the wheel's heading to the sled's travel, in [−π/2, π/2].
    SlipAngle,
    /// Slip along the heading, (ωR − v cos β) / max(ωR, v), in [−1, 1]: negative in skid; straight ahead it is the slip.
    LongitudinalSlip,
    /// Slip across the heading, v sin β / max(ωR, v), in [−1, 1], of the sign of the slip angle.
    LateralSlip,
    /// Speed of the sled.
    SledSpeed,
    /// Vertical load on the wheel.
    WheelLoad,
    /// Radius of the rim.
    Radius,
    /// Width of the rim.
    Width,
    /// Angle of internal friction.
    FrictionAngle,
    /// Cohesion.
    Cohesion,
    /// Sinkage exponent.
    N,
    /// Reference velocity v0 of the shear-velocity law.
    ShearVelocity,
    /// Density of the soil.
    Density,
    /// Acceleration of gravity.
    Gravity,
    /// Number of grousers.
    GrouserCount,
    /// Height of the grousers.
    GrouserHeight,
    /// Number of the pass over the track, from 1.
    Pass,
    /// Length of the soil bin.
    BinLength,
    /// Position of the run in the series of the campaign: −0.5 for the first run, 0.5 for the last.
    Order,
    /// Drawbar pull; negative when the wheel is towed.
    DrawbarPull,
    /// Torque; negative when the wheel is braked.
    Torque,
    /// Sinkage of the wheel; may be negative.
    Sinkage,
    /// Lateral force; negative at a negative slip angle.
    LateralForce,
}

/// Every variable with its name in formulas and its unit, in the order of the enumeration.
const TABLE: [(Variable, &str, &str); Variable::COUNT] = [
    (Variable::P, "p", "Pa"),
    (Variable::Z, "z", "m"),
    (Variable::Vn, "v_n", "m/s"),
    (Variable::Vt, "v_t", "m/s"),
    (Variable::J, "j", "m"),
    (Variable::Position, "position", "1"),
    (Variable::KStar, "k_star", "N/m^(n+2)"),
    (Variable::BEff, "b_eff", "m"),
    (Variable::TauMax, "tau_max", "Pa"),
    (Variable::Tau, "tau", "Pa"),
    (Variable::ContactLength, "contact_length", "m"),
    (Variable::Slip, "slip", "1"),
    (Variable::SlipAngle, "slip_angle", "rad"),
    (Variable::LongitudinalSlip, "longitudinal_slip", "1"),
    (Variable::LateralSlip, "lateral_slip", "1"),
    (Variable::SledSpeed, "sled_speed", "m/s"),
    (Variable::WheelLoad, "wheel_load", "N"),
    (Variable::Radius, "radius", "m"),
    (Variable::Width, "width", "m"),
    (Variable::FrictionAngle, "friction_angle_rad", "rad"),
    (Variable::Cohesion, "cohesion_pa", "Pa"),
    (Variable::N, "n", "1"),
    (Variable::ShearVelocity, "shear_velocity", "m/s"),
    (Variable::Density, "density_kg_m3", "kg/m^3"),
    (Variable::Gravity, "gravity", "m/s^2"),
    (Variable::GrouserCount, "grouser_count", "1"),
    (Variable::GrouserHeight, "grouser_height", "m"),
    (Variable::Pass, "pass", "1"),
    (Variable::BinLength, "bin_length", "m"),
    (Variable::Order, "order", "1"),
    (Variable::DrawbarPull, "drawbar_pull", "N"),
    (Variable::Torque, "torque", "N m"),
    (Variable::Sinkage, "sinkage", "m"),
    (Variable::LateralForce, "lateral_force", "N"),
];

impl Variable {
    /// The number of variables; `variable as usize` is less than this.
    pub const COUNT: usize = 34;

    /// The number of variables that may differ from node to node; they come first.
    pub const LOCAL: usize = 10;

    /// Every variable, in numerical order.
    pub const ALL: [Variable; Variable::COUNT] = {
        let mut all = [Variable::P; Variable::COUNT];
        let mut place = 0;
        while place < all.len() {
            all[place] = TABLE[place].0;
            place += 1;
        }
        all
    };

    /// Returns the name in formulas.
    pub fn name(self) -> &'static str {
        TABLE[self as usize].1
    }

    /// Returns the unit of the variable; `None` if it depends on a parameter.
    pub fn unit(self) -> Option<Unit> {
        Unit::parse(self.unit_name()).ok()
    }

    /// Returns the unit of the variable in words.
    pub fn unit_name(self) -> &'static str {
        TABLE[self as usize].2
    }
}

/// A set of variables.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Variables(u64);

impl Variables {
    /// The variables that are the same at all nodes: conditions, dimensions, and parameters of soil and rig.
    pub const OF_RUN: Variables = {
        let (first, last) = (Variable::Slip as u64, Variable::Order as u64);
        Variables((1 << (last + 1)) - (1 << first))
    };

    /// Returns the set of these variables.
    pub fn new(variables: &[Variable]) -> Self {
        variables.iter().fold(Self::default(), |set, &v| set.with(v))
    }

    /// Returns the set with one more variable.
    #[must_use]
    pub fn with(self, variable: Variable) -> Self {
        Self(self.0 | 1 << variable as u8)
    }

    /// Returns whether a variable belongs to the set.
    pub fn contains(self, variable: Variable) -> bool {
        self.0 >> variable as u8 & 1 == 1
    }

    /// Returns the union of two sets.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns whether the two have a member in common.
    pub fn meets(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Returns the members, in numerical order.
    pub fn iter(self) -> impl Iterator<Item = Variable> {
        Variable::ALL.into_iter().filter(move |&v| self.contains(v))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_stand_in_the_order_of_their_numbers() {
        for (place, variable) in Variable::ALL.into_iter().enumerate() {
            assert_eq!(variable as usize, place);
        }
        assert_eq!(Variables::OF_RUN.iter().count(), 19);
        assert!(!Variables::OF_RUN.contains(Variable::ContactLength));
        assert!(!Variables::OF_RUN.contains(Variable::DrawbarPull));
    }

    #[test]
    fn units_are_known_but_where_they_depend_on_a_parameter() {
        for variable in Variable::ALL {
            assert_eq!(
                variable.unit().is_none(),
                variable == Variable::KStar,
                "{}",
                variable.name()
            );
        }
    }
}
