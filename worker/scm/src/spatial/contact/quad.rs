//! A quad: four neighbouring nodes under the wheel.

use super::super::pack::{PACK, Pack, max, max_lane, splat};
use super::super::wheel::envelope::NOWHERE;

/// The state of four neighbouring nodes under the wheel, in a step and at a trial height.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Quad {
    /// Hub height at which the wheel touches the present surface `[m]`.
    pub(crate) surface: Pack,
    /// Hub height at which the depth below the reference surface is zero `[m]`.
    pub(crate) reference: Pack,
    /// Slope dh/dx of the wheel's surface `[–]`.
    pub(crate) slope: Pack,
    /// Vertical shear force per projected area and unit strength `[–]`.
    pub(crate) shear_z: Pack,
    /// Rear and front end of the contact, ahead of the hub `[m]`.
    pub(crate) rear_end: Pack,
    pub(crate) front_end: Pack,
    /// Start of the contact in this strip: the covered length behind the strip's middle `[m]`, and the increase of the
    /// penetration per length there `[–]`.
    pub(crate) left: Pack,
    pub(crate) tilt: Pack,
    /// Point of the pressure, ahead of the strip's middle `[m]`.
    pub(crate) offset: Pack,
    /// Penetration and depth z at that point `[m]`, z^n, and the shape g of the distribution.
    pub(crate) pressed: Pack,
    pub(crate) depth: Pack,
    pub(crate) depth_power: Pack,
    pub(crate) shape: Pack,
    /// Area `[m²]` and pressure `[Pa]`.
    pub(crate) area: Pack,
    pub(crate) pressure: Pack,
}

impl Quad {
    pub(crate) fn blank() -> Self {
        let zero = Pack::splat(0.0);
        Self {
            surface: zero,
            reference: zero,
            slope: zero,
            shear_z: zero,
            rear_end: zero,
            front_end: zero,
            left: zero,
            tilt: zero,
            offset: zero,
            pressed: zero,
            depth: zero,
            depth_power: zero,
            shape: zero,
            area: zero,
            pressure: zero,
        }
    }
}

impl Quad {
    /// Selects the lanes in contact with the hub at a height.
    #[inline]
    pub(crate) fn touching(&self, hub: f64) -> Pack {
        self.surface.simd_gt(splat(hub))
    }
}

/// The soil under a strip of the wheel.
pub(crate) struct Under<'a> {
    pub(crate) surface: &'a [[f64; PACK]],
    pub(crate) loose: &'a [[f64; PACK]],
    /// Offset that is added to the rise of the wheel.
    pub(crate) bias: &'a [Pack],
    /// Share of the loose soil that carries load.
    pub(crate) credit: Pack,
}

impl Under<'_> {
    /// Brings a strip of the wheel and the soil together; returns the height of the hub at which it begins to touch.
    ///
    /// `wheel` gives rise, slope and vertical shear force of a pack.
    #[inline]
    pub(crate) fn meet(&self, quads: &mut [Quad], wheel: impl Fn(usize) -> (Pack, Pack, Pack)) -> f64 {
        let mut highest = splat(NOWHERE);
        let soil = self.surface.iter().zip(self.loose).zip(self.bias);
        for (pack, (quad, ((surface, loose), &bias))) in quads.iter_mut().zip(soil).enumerate() {
            let (rise, slope, shear_z) = wheel(pack);
            let rise = rise + bias;
            quad.surface = Pack::new(*surface) + rise;
            quad.reference = Pack::new(*loose) * self.credit + rise;
            quad.slope = slope;
            quad.shear_z = shear_z;
            highest = max(highest, quad.surface);
        }
        max_lane(highest)
    }
}
