//! First guess of the contact length from Bekker's small-angle closed form.

use super::rim::Rim;

/// Coordinate of the balance: y = ln(l − `l_0`), in which the load is nearly a power law of slope 2n to 2n + 1.
///
/// `l_0` is the length of the contact ahead of the axle at which the soil begins to carry: where a negative `k_c` makes k*
/// of the footprint zero, or at the front of the flat of a flattened rim, if that is farther; 0 otherwise. The footprint of
/// a flattened rim also reaches back by half the flat.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coordinate {
    unsupported: f64,
    radius: f64,
    /// y of l = R.
    pub(super) max_y: f64,
}

impl Coordinate {
    /// Returns the coordinate for a rim; `None` if k* ≤ 0 for every contact with l < R.
    pub(super) fn new(rim: &Rim) -> Option<Self> {
        let long = long_contact_modulus(rim);
        let unsupported = if rim.soil.k_c < 0.0 {
            -rim.soil.k_c / long - rim.flat
        } else {
            0.0
        };
        let unsupported = if rim.flat > unsupported {
            rim.flat
        } else {
            unsupported
        };
        // Written so that NaN and ∞ (k* of the longest contact not positive) are refused too.
        (long > 0.0 && unsupported < rim.radius).then(|| Self {
            unsupported,
            radius: rim.radius,
            max_y: libm::log(rim.radius - unsupported),
        })
    }

    /// Returns the contact length l ≤ R at y.
    pub(super) fn contact_length(&self, y: f64) -> f64 {
        if y < self.max_y {
            (self.unsupported + libm::exp(y)).min(self.radius)
        } else {
            self.radius
        }
    }

    /// Returns whether a contact length equals `l_0` to the last bit.
    pub(super) fn is_origin(&self, contact_length: f64) -> bool {
        contact_length <= self.unsupported
    }

    /// Returns y of a contact length; −∞ for one without support.
    pub(super) fn at(&self, contact_length: f64) -> f64 {
        libm::log((contact_length - self.unsupported).max(0.0))
    }

    /// Returns dy / d ln l at a contact length.
    pub(super) fn per_log_length(&self, contact_length: f64) -> f64 {
        contact_length / (contact_length - self.unsupported)
    }

    /// Returns y at which Bekker's closed form carries the load.
    ///
    /// Small angles (z = l² / 2R), gamma = 1 and no shear give `W = b (K l + k_c) l^(2n) I_n / (2R)^n` with
    /// `K = k_phi + k_c / b` and `I_n = ∫ (1 − u²)^n du` over (0, 1), which `(1 + 4n/π)^(−1/2)` approximates within 1 %,
    /// enough for a start. A flattened rim has a closed form for `k_c` = 0 only; else see [`Self::start_on_flat`].
    pub(super) fn start(&self, rim: &Rim, load: f64) -> f64 {
        let n = rim.soil.n;
        let long = long_contact_modulus(rim);
        let shape = (1.0 + n * (4.0 * core::f64::consts::FRAC_1_PI)).sqrt();
        if rim.flat > 0.0 && rim.soil.k_c != 0.0 {
            return self.start_on_flat(rim, load);
        }
        if self.unsupported > 0.0 && rim.soil.k_c.abs() <= 0.0 {
            // the flat alone carries: W = 2 b l_0 k* z^n at l² = l_0² + 2 R z
            let sinkage = libm::pow(load / (2.0 * rim.width * self.unsupported * long), 1.0 / n);
            let length = (self.unsupported * self.unsupported + 2.0 * rim.radius * sinkage).sqrt();
            let y = libm::log(length - self.unsupported);
            return y.min(self.max_y - 0.1);
        }
        let target = libm::log(load * shape / (rim.width * long)) + n * libm::log(2.0 * rim.radius);
        let mut y = target / (2.0 * n + 1.0);
        if rim.soil.k_c != 0.0 {
            // ln(l + k_c/K) + 2n ln l = target by Newton; the sum is a smooth, monotone function of y.
            let offset = self.unsupported + rim.soil.k_c / long;
            for _ in 0..4 {
                let excess = libm::exp(y);
                let length = self.unsupported + excess;
                let value = libm::log(excess + offset) + 2.0 * n * libm::log(length);
                let slope = excess / (excess + offset) + 2.0 * n * excess / length;
                y += (target - value) / slope;
            }
        }
        let deepest = self.max_y - 0.1;
        if y < deepest { y } else { deepest }
    }

    /// Returns y at which a flattened rim on soil with `k_c` carries the load, by bisection.
    ///
    /// With a the flat's half length and L = l + a: `W = b k*(L) (2 a + (l − a) I_n) z^n`, `z = (l² − a²) / 2R`,
    /// `k*(L) = K + k_c / L`, which rises with l wherever it is positive.
    fn start_on_flat(&self, rim: &Rim, load: f64) -> f64 {
        let (n, flat) = (rim.soil.n, rim.flat);
        let long = long_contact_modulus(rim);
        let shape = 1.0 / (1.0 + n * (4.0 * core::f64::consts::FRAC_1_PI)).sqrt();
        let carries = |y: f64| {
            let length = self.unsupported + libm::exp(y);
            let modulus = long + rim.soil.k_c / (length + flat);
            let sinkage = (length - flat) * (length + flat) / (2.0 * rim.radius);
            let on_flat_and_arc = 2.0 * flat + (length - flat) * shape;
            rim.width * modulus * on_flat_and_arc * libm::pow(sinkage.max(0.0), n)
        };
        let deepest = self.max_y - 0.1;
        let (mut low, mut high) = (deepest - START_RANGE, deepest);
        for _ in 0..START_HALVINGS {
            let middle = 0.5 * (low + high);
            if carries(middle) < load {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }
}

/// Range of y below the deepest contact in which a start is searched; the search ends at a width of 0.01.
const START_RANGE: f64 = 32.0;
const START_HALVINGS: u32 = 12;

/// Returns k* of a contact much longer than wide: K = `k_phi` + `k_c` / b.
fn long_contact_modulus(rim: &Rim) -> f64 {
    rim.soil.k_phi + rim.soil.k_c / rim.width
}
