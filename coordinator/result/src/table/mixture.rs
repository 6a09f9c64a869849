//! Mixture distribution of a new measurement, with a component for each draw and each value of the discrepancy.

use statistics::ErrorLaw;

/// A component of the mixture: one draw of the posterior with one value of the discrepancy.
#[derive(Debug, Clone, Copy)]
pub struct Component {
    /// The model's value [channel's unit].
    pub mean: f64,
    /// Scale of noise, scatter and discrepancy together [channel's unit]; `None` if the noise is unknown.
    pub scale: Option<f64>,
    /// Probability of this value of the discrepancy.
    pub weight: f64,
}

/// Share of the average weight below which a component is ignored.
const MIN_SHARE: f64 = 1e-12;
/// Width of the bracket that ends a search for a quantile, as a share of the first bracket.
const CLOSE: f64 = 1e-13;

/// Returns the quantile y of the mixture at probability p; without noise, the quantile of the means.
pub fn quantile(components: &[Component], law: ErrorLaw, p: f64) -> f64 {
    let total: f64 = components.iter().map(|c| c.weight).sum();
    let counted: Vec<Component> = components
        .iter()
        .copied()
        .filter(|c| c.weight > MIN_SHARE * total / components.len() as f64)
        .collect();
    let share_below = |y: f64| {
        let below = |c: &Component| match (c.scale, law) {
            (Some(sd), ErrorLaw::Gaussian) => {
                0.5 * libm::erfc((c.mean - y) / (sd * std::f64::consts::SQRT_2))
            }
            (Some(scale), law) => law.cumulative((y - c.mean) / scale),
            (None, _) => f64::from(u8::from(c.mean <= y)),
        };
        counted.iter().map(|c| c.weight * below(c)).sum::<f64>() / total
    };
    let end = |scales: f64| {
        let ends = counted.iter().map(|c| c.mean + scales * c.scale.unwrap_or(0.0));
        match scales < 0.0 {
            true => ends.fold(f64::INFINITY, f64::min),
            false => ends.fold(f64::NEG_INFINITY, f64::max),
        }
    };
    // For normal errors, ten scales on each side contain the quantile. Heavy tails may need more.
    let mut reach = 10.0;
    while law != ErrorLaw::Gaussian
        && reach < 1e6
        && !(share_below(end(-reach)) < p && share_below(end(reach)) > p)
    {
        reach *= 10.0;
    }
    crossing(|y| share_below(y) - p, end(-reach), end(reach))
}

/// Finds where a rising function crosses zero by inverse quadratic interpolation, with bisection where that is unsafe; returns an end of
/// the interval if there is no crossing.
///
/// # Source
/// Chandrupatla 1997, Adv. Eng. Softw. 28(3):145, doi:10.1016/S0965-9978(96)00051-8. Checked by
/// `quantiles_of_one_normal_are_the_normal_s` and `a_step_is_found_where_it_is`.
fn crossing(rising: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let close = CLOSE * (high - low);
    let (mut a, mut b) = ((low, rising(low)), (high, rising(high)));
    if a.1 >= 0.0 {
        return low;
    }
    if b.1 <= 0.0 {
        return high;
    }
    let mut share = 0.5;
    loop {
        let y = a.0 + share * (b.0 - a.0);
        let new = (y, rising(y));
        // The bracket lies between `a`, the newest point, and `b`; `c` is the previous end.
        let c = if (new.1 < 0.0) == (a.1 < 0.0) {
            a
        } else {
            std::mem::replace(&mut b, a)
        };
        a = new;
        let width = b.0 - a.0;
        if width.abs() <= close.max(f64::EPSILON * a.0.abs()) {
            return if a.1.abs() < b.1.abs() { a.0 } else { b.0 };
        }
        let along = (a.0 - b.0) / (c.0 - b.0);
        let up = (a.1 - b.1) / (c.1 - b.1);
        let is_safe = up * up < along && (1.0 - up) * (1.0 - up) < 1.0 - along;
        let least = 0.5 * close / width.abs();
        share = if is_safe {
            let first = a.1 / (b.1 - a.1) * (c.1 / (b.1 - c.1));
            let second = (c.0 - a.0) / width * (a.1 / (c.1 - a.1)) * (b.1 / (c.1 - b.1));
            (first + second).clamp(least, 1.0 - least)
        } else {
            0.5
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn component(mean: f64, sd: f64, weight: f64) -> Component {
        Component {
            mean,
            scale: Some(sd),
            weight,
        }
    }

    #[test]
    fn quantiles_of_one_normal_are_the_normal_s() {
        let draws = [component(3.0, 2.0, 1.0); 5];
        let at = |p| quantile(&draws, ErrorLaw::Gaussian, p);
        assert!((at(0.95) - (3.0 + 2.0 * 1.644_853_627)).abs() < 1e-6);
        assert!((at(0.05) - (3.0 - 2.0 * 1.644_853_627)).abs() < 1e-6);
    }

    #[test]
    fn quantiles_of_one_t_are_the_t_s() {
        let law = |degrees_of_freedom| ErrorLaw::StudentT { degrees_of_freedom };
        let draws = [component(3.0, 2.0, 1.0); 5];
        // Abramowitz & Stegun, table 26.10.
        assert!((quantile(&draws, law(5.0), 0.95) - (3.0 + 2.0 * 2.015_048)).abs() < 1e-5);
        assert!((quantile(&draws, law(1.0), 0.05) - (3.0 - 2.0 * 6.313_752)).abs() < 1e-5);
    }

    #[test]
    fn a_wide_mixture_is_wider_than_its_parts() {
        let draws = [component(-5.0, 1.0, 1.0), component(5.0, 1.0, 1.0)];
        assert!(quantile(&draws, ErrorLaw::Gaussian, 0.95) > 5.0);
        assert!(quantile(&draws, ErrorLaw::Gaussian, 0.05) < -5.0);
        // A component of negligible weight does not change the quantile.
        let draws = [component(-5.0, 1.0, 1e-9), component(5.0, 1.0, 1.0)];
        assert!((quantile(&draws, ErrorLaw::Gaussian, 0.05) - (5.0 - 1.644_853_627)).abs() < 1e-6);
    }

    #[test]
    fn a_step_is_found_where_it_is() {
        let draws = [1.0, 2.0, 3.0, 4.0].map(|mean| Component {
            mean,
            scale: None,
            weight: 1.0,
        });
        assert!((quantile(&draws, ErrorLaw::Gaussian, 0.6) - 3.0).abs() < 1e-9);
        assert!((quantile(&draws, ErrorLaw::Gaussian, 0.05) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_quantile_needs_few_looks_at_the_mixture() {
        let looks = std::cell::Cell::new(0);
        let share = |y: f64| {
            looks.set(looks.get() + 1);
            0.5 * libm::erfc(-y) - 0.05
        };
        crossing(share, -14.0, 14.0);
        assert!(looks.get() < 25, "{}", looks.get());
    }
}
