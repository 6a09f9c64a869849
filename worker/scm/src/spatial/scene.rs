//! What a run is made of.

use super::settings::{Ground, Shape};
use crate::effects::{Active, Site};
use crate::{Soil, Wheel};

/// What the wheel rolls on, and the wheel.
#[derive(Debug, Clone, Copy)]
pub struct Scene<'a> {
    /// Pressure and shear of the soil.
    pub soil: &'a Soil,
    /// Deformation of the soil.
    pub ground: &'a Ground,
    /// Radius and width of the rim, or nominal ones of a mesh.
    pub wheel: &'a Wheel,
    /// The rest of the wheel's shape.
    pub shape: &'a Shape,
    /// Effects that enter; `Active::default()` is none.
    pub effects: &'a Active<'a>,
    /// What effects may ask of the run beyond the rest.
    pub site: Site,
}
