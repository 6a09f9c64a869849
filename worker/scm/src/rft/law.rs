//! Stress on a surface element that moves through granular soil: the law of three-dimensional resistive force theory.

/// Coefficients of f1, f2 and f3, in the order of [`terms`].
///
/// # Source
/// Agarwal, Goldman & Kamrin 2023, PNAS 120(4) e2214017120, <https://doi.org/10.1073/pnas.2214017120>, supporting
/// information S3, from two public transcriptions, that of KKKobefeng/3D-RFT (`Cylinder/Cyl3DRFTt.m`) and one in Python for
/// a legged-robot simulator, which differ in two of 60 numbers. They give f3 of x2 x3² as −0.02730 and −0.20770: with the
/// second, soil would push a level plate upwards as it is lifted (+0.10 instead of −0.08), and the fit to the
/// two-dimensional theory of Li et al. 2013, <https://doi.org/10.1126/science.1229163>, for rising plates is worse (rms
/// 0.147 against 0.104), so the first is used. They give f2 of x3 x2² as 0.18589 and 0.18519, a difference of at most 0.0007
/// in a stress of about 1; the first, from the same source, is used.
const COEFFICIENTS: [[f64; 3]; TERMS] = [
    [0.00212, -0.06796, -0.02634],
    [-0.02320, -0.10941, -0.03436],
    [-0.20890, 0.04725, 0.45256],
    [-0.43083, -0.06914, 0.00835],
    [-0.00259, -0.05835, 0.02553],
    [0.48872, -0.65880, -1.31290],
    [-0.00415, -0.11985, -0.05532],
    [0.07204, -0.25739, 0.06790],
    [-0.02750, -0.26834, -0.16404],
    [-0.08772, 0.02692, 0.02287],
    [0.01992, -0.00736, 0.02927],
    [-0.45961, 0.63758, 0.95406],
    [0.40799, 0.08997, -0.00131],
    [-0.10107, 0.21069, -0.11028],
    [-0.06576, 0.04748, 0.01487],
    [0.05664, 0.20406, -0.02730],
    [-0.09269, 0.18589, 0.10911],
    [0.01892, 0.04934, -0.04097],
    [0.01033, 0.13527, 0.07881],
    [0.15120, -0.33207, -0.27519],
];
const TERMS: usize = 20;

/// Returns the monomials up to the third degree.
fn terms(x1: f64, x2: f64, x3: f64) -> [f64; TERMS] {
    [
        1.0,
        x1,
        x2,
        x3,
        x1 * x1,
        x2 * x2,
        x3 * x3,
        x1 * x2,
        x2 * x3,
        x3 * x1,
        x1 * x1 * x1,
        x2 * x2 * x2,
        x3 * x3 * x3,
        x1 * x2 * x2,
        x2 * x1 * x1,
        x2 * x3 * x3,
        x3 * x2 * x2,
        x3 * x1 * x1,
        x1 * x3 * x3,
        x1 * x2 * x3,
    ]
}

/// Stress on a surface element per depth and per scale factor `xi_n`, as a vector (x forward, y across, z up).
///
/// With N the normal of the element's plane that points down, v the direction of motion and e the upward vertical, the paper's angles
/// enter only through `x1 = sin(gamma) = −v·e`, `x2 = cos(beta) = −N·e` and
/// `x3 = cos(psi) cos(gamma) sin(beta) + sin(gamma) cos(beta) = v·N`, and
///
/// - `alpha = f1 N + f2 v − f3 e`, `f_i = sum_k c_ik T_k(x1, x2, x3)`, which equals the paper's local components without its frame;
/// - the part along the outward normal n is kept where it presses, `alpha_n = max(−alpha·n, 0)`, and friction limits the
///   part along the surface: `−alpha_n n + min(mu alpha_n / |alpha_t|, 1) alpha_t`.
///
/// # Arguments
/// - `normal`: n, out of the body, of length 1. `direction`: v, of length 1.
/// - `surface_friction`: mu, between surface and soil `[–]`, ≥ 0.
///
/// # Returns
/// `[–]`; times `xi_n` `[Pa/m]`, depth `[m]` and area `[m²]` it is the soil's force on the body. `None` if the element does
/// not lead, `v·n ≤ 0`: there the soil loses contact.
///
/// # Validity
/// Dry cohesionless soil, slow motion (no inertia of grains), a level surface, stresses that depend on the element's own
/// motion alone. If `alpha·n > 0` the fit would have the soil pull: such an element carries nothing (a departure; it happens
/// on rising elements).
///
/// # Source
/// [`COEFFICIENTS`]. Checked by `rft::*`.
pub(super) fn stress(normal: [f64; 3], direction: [f64; 3], surface_friction: f64) -> Option<[f64; 3]> {
    let leads = dot(normal, direction);
    if leads <= 0.0 {
        return None;
    }
    let side = if normal[2] > 0.0 { -1.0 } else { 1.0 };
    let down = normal.map(|component| side * component);
    let values = terms(-direction[2], -down[2], side * leads);
    let mut f = [0.0; 3];
    for (term, coefficients) in values.iter().zip(&COEFFICIENTS) {
        for i in 0..3 {
            f[i] += coefficients[i] * term;
        }
    }
    let mut alpha = [0.0; 3];
    for i in 0..3 {
        alpha[i] = f[0] * down[i] + f[1] * direction[i];
    }
    alpha[2] -= f[2];
    let pressing = -dot(alpha, normal);
    if pressing <= 0.0 {
        return Some([0.0; 3]);
    }
    let along: [f64; 3] = core::array::from_fn(|i| alpha[i] + pressing * normal[i]);
    let size = dot(along, along).sqrt();
    let max_friction = surface_friction * pressing;
    let share = if size > max_friction {
        max_friction / size
    } else {
        1.0
    };
    Some(core::array::from_fn(|i| share * along[i] - pressing * normal[i]))
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(v: [f64; 3]) -> [f64; 3] {
        let length = dot(v, v).sqrt();
        v.map(|c| c / length)
    }

    #[test]
    fn a_level_plate_is_pressed_by_the_sum_of_the_coefficients_and_little_when_lifted() {
        // all terms are 1: −(f1 + f2 + f3) = 0.27614 + 0.31422 + 0.28468
        let pressed = stress([0.0, 0.0, -1.0], [0.0, 0.0, -1.0], 0.4).unwrap();
        assert!((pressed[2] - 0.87504).abs() < 1e-12 && pressed[0] == 0.0 && pressed[1] == 0.0);
        let lifted = stress([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], 0.4).unwrap();
        assert!((-0.2..0.0).contains(&lifted[2]), "{lifted:?}");
    }

    #[test]
    fn an_element_that_does_not_lead_feels_no_stress() {
        assert_eq!(stress([0.0, 0.0, 1.0], [0.0, 0.0, -1.0], 0.4), None);
    }

    #[test]
    fn a_plate_dragged_forwards_meets_the_components_of_the_published_form() {
        // beta = 45°, gamma = 0, psi = 0, without a limit of friction: f1 sin(beta) + f2 and −f1 cos(beta) − f3 along r and z
        let half = 0.5_f64.sqrt();
        let values = terms(0.0, half, half);
        let products = |i: usize| values.iter().zip(&COEFFICIENTS).map(move |(t, c)| t * c[i]);
        let f = |i: usize| products(i).sum::<f64>();
        let got = stress([half, 0.0, -half], [1.0, 0.0, 0.0], 1e9).unwrap();
        assert!((got[0] - (f(0) * half + f(1))).abs() < 1e-12, "{got:?}");
        assert!((got[2] - (-f(0) * half - f(2))).abs() < 1e-12, "{got:?}");
        assert!(
            got[0] < 0.0 && got[2] > 0.0,
            "it is held back and lifted: {got:?}"
        );
    }

    #[test]
    fn turning_everything_about_the_vertical_turns_the_stress() {
        let turned = |v: [f64; 3]| [0.6 * v[0] - 0.8 * v[1], 0.8 * v[0] + 0.6 * v[1], v[2]];
        for (normal, direction) in [
            ([0.3, 0.2, -0.9], [0.7, 0.1, -0.2]),
            ([0.5, -0.4, 0.3], [0.9, 0.3, 0.4]),
            ([1.0, 0.0, 0.0], [0.9, 0.5, 0.0]),
        ] {
            let (n, v) = (unit(normal), unit(direction));
            let base = stress(n, v, 0.4).unwrap();
            let there = stress(turned(n), turned(v), 0.4).unwrap();
            for (a, b) in turned(base).iter().zip(there) {
                assert!((a - b).abs() < 1e-12);
            }
            let mirrored = |v: [f64; 3]| [v[0], -v[1], v[2]];
            let there = stress(mirrored(n), mirrored(v), 0.4).unwrap();
            for (a, b) in mirrored(base).iter().zip(there) {
                assert!((a - b).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn friction_limits_the_stress_along_the_surface() {
        let mu = 0.2;
        let (n, v) = (unit([0.2, 0.1, -1.0]), unit([1.0, 0.2, -0.1]));
        let force = stress(n, v, mu).unwrap();
        let pressing = -dot(force, n);
        let along: [f64; 3] = core::array::from_fn(|i| force[i] + pressing * n[i]);
        assert!((dot(along, along).sqrt() / pressing - mu).abs() < 1e-12);
    }
}
