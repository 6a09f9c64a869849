//! The scene of a run: soil, wheel and effects.

use super::settings::{Ground, Shape};
use crate::effects::{Active, Site};
use crate::{Soil, Wheel};

/// The soil, the wheel and the effects of a run.
#[derive(Debug, Clone, Copy)]
pub struct Scene<'a> {
    /// Pressure and shear of the soil.
    pub soil: &'a Soil,
    /// Deformation of the soil.
    pub ground: &'a Ground,
    /// Radius and width of the rim, or nominal ones for a mesh.
    pub wheel: &'a Wheel,
    /// The rest of the wheel's shape.
    pub shape: &'a Shape,
    /// The active effects; `Active::default()` for none.
    pub effects: &'a Active<'a>,
    /// Properties of the test site that effects may use.
    pub site: Site,
}
