//! The scene and the grousers of this module's tests.

use super::{Ground, Grousers, Scene, Shape};
use crate::effects::{Active, Site};
use crate::fixture::{SOIL, WHEEL};

/// Twelve grousers of 9 mm by 2 mm.
pub(super) const BARS: Grousers = Grousers {
    count: 12,
    height_m: 0.009,
    thickness_m: 0.002,
};

/// Returns the soil and the wheel of unit tests with the rest of a scene.
pub(super) fn scene<'a>(ground: &'a Ground, shape: &'a Shape, effects: &'a Active<'a>) -> Scene<'a> {
    Scene {
        soil: &SOIL,
        ground,
        wheel: &WHEEL,
        shape,
        effects,
        site: Site::default(),
    }
}
