//! The stresses of Wong & Reece under a rigid wheel: the peak of the pressure, and the mobilisation of the strength by
//! displacement.

use crate::Rejection;
use crate::rejection::require;
use crate::shear::ShearDisplacement;

/// The parameters that the model of Wong & Reece adds to a soil: the line of the peak angle and the shear modulus.
///
/// The rim touches the soil from `theta_1 = acos(1 − z/R)`, ahead of the axle, to the lowest point. The pressure peaks at
/// `theta_m = (c1 + c2 s) theta_1`, s the slip. With `k* = k_c / b_eff + k_phi`, `b_eff = l b / (l + b)`, `l = R sin(theta_1)`:
///
/// - ahead of the peak, `p = gamma k* (R (cos(theta) − cos(theta_1)))^n`, with the true depth;
/// - behind it, `p = gamma k* (R (cos(theta') − cos(theta_1)))^n` at `theta' = theta_1 − theta (theta_1 − theta_m) / theta_m`: the
///   profile ahead, mirrored and stretched over the rear part, zero at the lowest point;
/// - `tau = (c + p tan(phi)) (1 − exp(−|v| / v0)) (1 − exp(−j / K))` against the slip velocity v of the rim, with its
///   displacement since the entry `j = R ((theta_1 − theta) − (1 − s) (sin(theta_1) − sin(theta)))`.
///
/// Integration along the rim and balance of the load are those of [`quasi_static`](crate::quasi_static). With
/// `gamma_exponent` and `shear_velocity_m_s` of the [`Soil`](crate::Soil) 0, gamma and the factor of v0 are 1: the published
/// model, except for the footprint's width in k*, in place of the wheel's width.
///
/// # Validity
/// Driven wheels on homogeneous soil in steady motion. The line of the peak was measured at positive slip: in skid it is
/// extrapolated, and where it leaves [0, 1) the parameters are rejected. Published for sands: c1 from 0.18 to 0.43, c2 from
/// 0.32 to 0.41. The slip is the rig's. There is no rebound: the contact ends below the axle.
///
/// # Source
/// Wong & Reece 1967, <https://doi.org/10.1016/0022-4898(67)90105-X>; Janosi & Hanamoto 1961, see [Literature](crate#literature).
/// The catalogue's `peak_pressure_angle` is the same pressure by two terms of series in the angles, in addition to the
/// base's laws. Checked by `wong_reece::*`, against an integration that shares no code with this one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WongReece {
    /// Share of the entry angle at which the pressure peaks without slip, c1 `[–]`.
    pub c1: f64,
    /// Increase of the peak's share of the entry angle with slip, c2 `[–]`.
    pub c2: f64,
    /// Displacement at which 1 − 1/e of the strength is mobilised, K `[m]`, ≥ 0; 0: any displacement mobilises the whole strength.
    pub shear_modulus_m: f64,
}

impl WongReece {
    /// Returns the laws at a slip; [`Rejection::InvalidParameter`] for `c1 + c2 slip` outside [0, 1), or a negative shear modulus.
    pub(crate) fn at(&self, slip: f64) -> Result<PeakedStresses, Rejection> {
        let share = self.c1 + self.c2 * slip;
        require(
            (0.0..1.0).contains(&share),
            "c1 + c2 slip",
            share,
            "(dimensionless)",
            "at least 0 and below 1",
        )?;
        require(
            self.shear_modulus_m >= 0.0,
            "shear_modulus_m",
            self.shear_modulus_m,
            "m",
            "at least 0",
        )?;
        Ok(PeakedStresses {
            share,
            displacement: ShearDisplacement::new(self.shear_modulus_m),
        })
    }
}

/// The laws of one run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PeakedStresses {
    /// `theta_m / theta_1`, in [0, 1).
    share: f64,
    /// The share of the strength that a displacement mobilises.
    pub(crate) displacement: ShearDisplacement,
}

/// The peak in one contact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Peak {
    radius: f64,
    entry_angle: f64,
    angle: f64,
    /// `1 / (2 sin²(theta_1 / 2))`, one over the relative depth of the lowest point.
    per_depth: f64,
    /// Place of the peak ahead of the axle `[m]`.
    pub(crate) x: f64,
}

impl PeakedStresses {
    /// Returns the peak in a contact that reaches `front` ahead of the axle `[m]`.
    pub(crate) fn peak(&self, radius: f64, front: f64) -> Peak {
        let entry_angle = libm::asin(front / radius);
        let angle = self.share * entry_angle;
        let half = libm::sin(0.5 * entry_angle);
        Peak {
            radius,
            entry_angle,
            angle,
            per_depth: 0.5 / (half * half),
            x: radius * libm::sin(angle),
        }
    }
}

impl Peak {
    /// Returns the effective depth for the pressure at a place behind the peak, relative to that of the lowest point.
    pub(crate) fn relative_depth(&self, x: f64) -> f64 {
        let angle = libm::asin(x / self.radius);
        let mirrored = self.entry_angle - angle * (self.entry_angle - self.angle) / self.angle;
        // a difference of cosines as a product is accurate where it goes to zero
        let sum = libm::sin(0.5 * (self.entry_angle + mirrored));
        let difference = libm::sin(0.5 * (self.entry_angle - mirrored));
        2.0 * sum * difference * self.per_depth
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: WongReece = WongReece {
        c1: 0.4,
        c2: 0.3,
        shear_modulus_m: 0.01,
    };

    #[test]
    fn behind_the_peak_the_depth_goes_from_that_of_the_peak_to_zero() {
        // theta_1 = 0.4, theta_m = 0.46 · 0.4 = 0.184: cos 0.184 − cos 0.4 over 1 − cos 0.4
        let peak = LAW.at(0.2).unwrap().peak(0.1, 0.1 * 0.4_f64.sin());
        let at_peak = (0.184_f64.cos() - 0.4_f64.cos()) / (1.0 - 0.4_f64.cos());
        assert!((peak.relative_depth(peak.x) - at_peak).abs() < 1e-12);
        assert!(peak.relative_depth(0.0).abs() < 1e-15);
        // halfway back in angle: theta' = 0.4 − 0.5 · 0.216 = 0.292
        let halfway = (0.292_f64.cos() - 0.4_f64.cos()) / (1.0 - 0.4_f64.cos());
        assert!((peak.relative_depth(0.1 * 0.092_f64.sin()) - halfway).abs() < 1e-12);
    }

    #[test]
    fn a_peak_outside_the_contact_is_refused_with_its_place() {
        for (slip, share) in [(-0.9, "-0.22999"), (0.9, "1.03")] {
            let law = WongReece { c2: 0.7, ..LAW };
            let message = law.at(slip).unwrap_err().to_string();
            assert!(message.contains(&format!("c1 + c2 slip = {share}")), "{message}");
        }
        let negative = WongReece {
            shear_modulus_m: -0.1,
            ..LAW
        };
        assert!(negative.at(0.0).is_err());
    }
}
