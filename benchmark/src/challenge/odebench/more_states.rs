//! Systems 52 to 63 of `ODEBench`: three or four states.

use libm::exp;

use super::system::{OdeSystem, Term, terms};

/// Lorenz's system with parameters, for a span in which it stays predictable.
const fn lorenz(number: usize, parameters: &'static [f64], span: f64) -> OdeSystem {
    OdeSystem {
        number,
        parameters,
        starts: [&[2.3, 8.1, 12.4], &[10.0, 20.0, 30.0]],
        span,
        terms: terms![|x, c|
            0 => c[0] * x[1],
            0 => -c[0] * x[0],
            1 => c[1] * x[0],
            1 => -x[1],
            1 => -x[0] * x[2],
            2 => x[0] * x[1],
            2 => -c[2] * x[2]
        ],
    }
}

/// Rössler's system with parameters, for a span in which it stays predictable.
const fn roessler(number: usize, parameters: &'static [f64]) -> OdeSystem {
    OdeSystem {
        number,
        parameters,
        starts: [&[2.3, 1.1, 0.8], &[-0.1, 4.1, -2.1]],
        span: 3.0,
        terms: terms![|x, c|
            0 => -c[3] * x[1],
            0 => -c[3] * x[2],
            1 => c[3] * x[0],
            1 => c[3] * c[0] * x[1],
            2 => c[3] * c[1],
            2 => c[3] * x[2] * x[0],
            2 => -c[3] * c[2] * x[2]
        ],
    }
}

/// The systems of three or four states.
pub const SYSTEMS: [OdeSystem; 12] = [
    OdeSystem {
        number: 52,
        parameters: &[0.1, 0.21, 0.34, 3.1],
        starts: [&[1.3, 1.1, 0.89], &[0.89, 1.3, 1.1]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0] * x[1],
            0 => -c[0] * x[0],
            1 => c[1] * x[0] * x[2],
            1 => -c[1] * x[1],
            2 => c[2] * (c[3] + 1.0),
            2 => -c[2] * x[2],
            2 => -c[2] * c[3] * x[0] * x[1]
        ],
    },
    OdeSystem {
        number: 53,
        parameters: &[0.1, 0.6, 0.2, 7.95, 0.05, 0.4, 0.1, 2.0, 0.1, 0.1],
        starts: [&[0.005, 0.26, 2.15], &[0.248, 0.0973, 0.0027]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0],
            0 (1) => -c[5] * x[1] * x[0] / (c[9] + x[0]),
            0 => -c[4] * x[0],
            1 => c[1] * c[8] * x[2],
            1 => c[1] * x[1] * x[2],
            1 (1) => -c[2] * x[1] / (c[6] + x[1]),
            1 (1) => -c[3] * x[0] * x[1] / (c[7] + x[1]),
            2 => -c[1] * c[8] * x[2],
            2 => -c[1] * x[1] * x[2],
            2 (1) => c[2] * x[1] / (c[6] + x[1]),
            2 (1) => c[3] * x[0] * x[1] / (c[7] + x[1])
        ],
    },
    lorenz(54, &[5.1, 12.0, 1.67], 5.0),
    lorenz(55, &[10.0, 99.96, 8.0 / 3.0], 1.5),
    lorenz(56, &[10.0, 28.0, 8.0 / 3.0], 3.0),
    roessler(57, &[-0.2, 0.2, 5.7, 5.0]),
    roessler(58, &[0.1, 0.2, 5.7, 5.0]),
    roessler(59, &[0.2, 0.2, 5.7, 5.0]),
    OdeSystem {
        number: 60,
        parameters: &[0.95, 0.7, 0.65, 3.5, 0.25, 0.1],
        starts: [&[0.1, 0.05, 0.05], &[-0.3, 0.2, 0.1]],
        span: 10.0,
        terms: terms![|x, c|
            0 => x[0] * x[2],
            0 => -c[1] * x[0],
            0 => -c[3] * x[1],
            1 => c[3] * x[0],
            1 => x[1] * x[2],
            1 => -c[1] * x[1],
            2 => c[2],
            2 => c[0] * x[2],
            2 => -x[2] * x[2] * x[2] / 3.0,
            2 => -x[0] * x[0],
            2 => -x[1] * x[1],
            2 => -c[4] * x[2] * x[0] * x[0],
            2 => -c[4] * x[2] * x[1] * x[1],
            2 => c[5] * x[2] * x[0] * x[0] * x[0]
        ],
    },
    OdeSystem {
        number: 61,
        parameters: &[5.0, -10.0, -3.8, 3.0],
        starts: [&[15.0, -15.0, -15.0], &[8.0, 14.0, -10.0]],
        span: 2.0,
        terms: terms![|x, c|
            0 => c[0] * x[0],
            0 => -x[1] * x[2],
            1 => c[1] * x[1],
            1 => x[0] * x[2],
            2 => c[2] * x[2],
            2 => x[0] * x[1] / c[3]
        ],
    },
    OdeSystem {
        number: 62,
        parameters: &[0.89, 0.4, 1.4, 1.0],
        starts: [&[2.25, -0.5, -1.13, 0.4], &[0.342, -0.431, -0.86, 0.041]],
        span: 10.0,
        terms: terms![|x, c|
            0 => -x[0],
            0 (3) => 1.0 / (1.0 + exp(c[0] * x[2] + c[1] * x[1] - c[2])),
            1 => c[3] * x[0],
            1 => -c[3] * x[1],
            2 => -x[2],
            2 (3) => 1.0 / (1.0 + exp(c[0] * x[0] + c[1] * x[3] - c[2])),
            3 => c[3] * x[2],
            3 => -c[3] * x[3]
        ],
    },
    OdeSystem {
        number: 63,
        parameters: &[0.47, 0.28, 0.3],
        starts: [&[0.6, 0.3, 0.09, 0.01], &[0.4, 0.3, 0.25, 0.05]],
        span: 10.0,
        terms: terms![|x, c|
            0 => -c[1] * x[0] * x[2],
            1 => c[1] * x[0] * x[2],
            1 => -c[0] * x[1],
            2 => c[0] * x[1],
            2 => -c[2] * x[2],
            3 => c[2] * x[2]
        ],
    },
];
