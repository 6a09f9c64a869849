//! Effects as formulas: their grammar, their files and their evaluation at blocks of points.
//!
//! # Layout
//! Content of an effect file:
//! - [`effect`]: an effect file, read and checked.
//! - [`catalogue`]: the effect files that come with the program.
//! - [`variable`], [`hook`]: the variables of a formula, and the quantity of the model that it replaces.
//! - [`slip`]: slip along and across the heading.
//! - [`mod@unit`]: units, and the dimensions behind them.
//!
//! From text to numbers:
//! - [`expression`]: one formula over names that its user declares.
//! - `syntax`: parses the text of a formula into operations, with a check of units.
//! - `evaluation`: evaluates operations: [`program`] is a compiled formula, [`block`] evaluates it at many points.
//! - [`nesting`]: whether a file is too deep to be parsed.
//! - [`word`]: finds the known word nearest to an unknown one.
//!
//! Everything is pure and safe for untrusted text: no loops, only declared names, limits on every size. The crate knows
//! neither the wheel-soil models nor probability: a prior is kept as written.
//!
//! # An effect file
//! ```
//! # let text = r#"
//! name = "slip_softened_pressure"
//! summary = "a slipping rim loosens the soil, which then carries less"
//! source = "an observation in our own bin"
//! pressure = "p * (1 - softening * share)"
//!
//! [definitions]                 # names for parts of formulas
//! share = "tanh(abs(slip) / slip_scale)"
//!
//! [parameters.softening]        # a strength: it has a value at which the effect is absent
//! unit = "1"
//! neutral = 0.0
//! typical = 0.2                 # tables show the effect at this value
//! prior = { uniform = [0.0, 0.6] }
//!
//! [parameters.slip_scale]
//! unit = "1"
//! prior = 0.3                   # a number: known, not inferred
//! # "#;
//! # let effect = formula::Effect::read(text).unwrap();
//! # assert!(effect.is_neutral(&[0.0, 0.3]) && !effect.is_neutral(&[0.2, 0.3]));
//! ```
//! Each replaced quantity has a key; its formula sees the quantity after the effects before it. At the neutral value of
//! all its strengths an effect is not evaluated. An effect without parameters is a law that always holds. `mechanism`
//! names a part of a model that implements the effect in code.
//!
//! # Formulas
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = power { ("*" | "/") power }
//! power   = "-" power | atom [ "^" power ]
//! atom    = number | name | function "(" sum { "," sum } ")" | "(" sum ")"
//!         | "if" "(" sum comparison sum "," sum "," sum ")"
//! ```
//! - Numbers: `2`, `0.5`, `.5`, `1e-3`. Names: variables, parameters, definitions, `pi`.
//! - `^` binds most tightly and from the right: `-a^2` is −(a²), `a^-b` is a^(−b), `a^b^c` is a^(b^c). A sign binds more
//!   tightly than `*`; `*` and `/`, then `+` and `-`, go from left to right. There is no sign `+` in front.
//! - Functions of one argument: `exp`, `log` (natural), `sqrt`, `tanh`, `abs`, `sin`, `cos`, `tan` (of rad). Of two: `min`,
//!   `max`, `pow` (the same as `^`).
//! - `if(a < b, then, otherwise)` with `<`, `<=`, `>`, `>=`, `==` or `!=`: the only place for a comparison. Both values are
//!   always computed, and one is taken.
//!
//! # Variables of formulas
//! | key of the formula | replaces | in | must be | additional variables |
//! |---|---|---|---|---|
//! | `slip` | `slip` | 1 | in [−1, 1) | |
//! | `radius`, `width` | the same | m | > 0 | |
//! | `sinkage_exponent` | `n` | 1 | > 0 | |
//! | `wheel_load` | `wheel_load` | N | > 0 | `drawbar_pull` (N), `torque` (N m) |
//! | `pressure` | `p` | Pa | ≥ 0 | `p` (Pa), `z` (m), `v_n` (m/s), `v_t` (m/s), `j` (m), `position` (1), and those of the contact |
//! | `shear_limit` | `tau_max` | Pa | ≥ 0 | as `pressure`, and `tau_max` (Pa) |
//! | `shear` | `tau` | Pa | ≥ 0 | as `shear_limit`, and `tau` (Pa) |
//! | `drawbar_pull`, `lateral_force` | the same | N | finite | all four channels, and those of the contact |
//! | `torque` | the same | N m | finite | all four channels, and those of the contact |
//! | `sinkage` | the same | m | finite | all four channels, and those of the contact |
//!
//! Every formula sees `slip` (1), `slip_angle` (rad), `longitudinal_slip` (1), `lateral_slip` (1), `sled_speed` (m/s), `wheel_load`
//! (N), `radius` (m), `width` (m), `friction_angle_rad` (rad), `cohesion_pa` (Pa), `n` (1), `shear_velocity` (m/s), `density_kg_m3`
//! (kg/m^3), `gravity` (m/s^2), `grouser_count` (1), `grouser_height` (m), `pass` (1), `bin_length` (m) and `order` (1). Those of the
//! contact are `contact_length` (m), `b_eff` (m) and `k_star` (N/m^(n+2)). [`Variable`] says what each is.
//!
//! # Units
//! Parameters have a unit of `1 kg m s deg rad N Pa J W Hz`, with `^`, `/` and spaces, without prefixes. Only certain
//! contradictions of units are errors. A number takes the unit that its neighbour needs, as in `v_t / 0.02`, and so
//! does a quantity whose unit depends on a parameter: `k_star`, or a power whose exponent is not a number. A degree is
//! not a radian: `sin(tilt_deg * pi / 180)`.
//!
//! # Numbers
//! IEEE double precision; no value is an error and none is clamped. Undefined values are NaN, and models reject a NaN in
//! any of their quantities.
//! - `1/0` is infinite and `0/0` NaN; `log(0)` is −∞; `log` and `sqrt` of negative numbers are NaN.
//! - `exp` above 709.78 is infinite and below −700 (where it would be under 1e-304) it is 0.
//! - `x^0` is 1, also for 0 and NaN, and so is `1^x`; `0^b` is 0 for b > 0 and infinite for b < 0. A negative base needs a whole exponent, else
//!   the power is NaN. `x^2` is `x * x`, `x^0.5` is `sqrt(x)`; other powers are exp(b ln x), to a relative error of
//!   1.1e-16 |b ln x| and a few units in the last place.
//! - `tanh` to a relative error of 1e-14, ±1 at infinity.
//! - `min` and `max` of NaN are NaN. Comparisons with NaN do not hold, but for `!=`: `if(x < 1, a, b)` is b where x is NaN. −0
//!   equals 0.
//!
//! A formula gives the same bits on every machine, whichever variables differ from point to point.
//!
//! # Limits
//! A file has at most 32 768 bytes, 16 parameters and 32 definitions; a formula 2000 characters, with parentheses and signs 50
//! deep; a name 60 characters; an effect 1000 different operations; tables are nested at most 8 deep; powers of units reach 9.

pub mod catalogue;
pub mod effect;
mod evaluation;
pub mod expression;
pub mod hook;
pub mod nesting;
pub mod slip;
mod syntax;
pub mod unit;
pub mod variable;
pub mod word;

pub use evaluation::{block, elementary, program};

pub use effect::{Effect, EffectError, Parameter};
pub use hook::Hook;
pub use program::Program;
pub use variable::Variable;
