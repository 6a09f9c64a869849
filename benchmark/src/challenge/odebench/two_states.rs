//! Systems 24 to 51 of `ODEBench`: two states.

use libm::{cos, exp, sin, tan};

use super::system::{OdeSystem, Term, terms};

/// The systems of two states.
pub const SYSTEMS: [OdeSystem; 28] = [
    OdeSystem {
        number: 24,
        parameters: &[2.1],
        starts: [&[0.4, -0.03], &[0.0, 0.2]],
        span: 10.0,
        terms: terms![|x, c| 0 => x[1], 1 => -c[0] * x[0]],
    },
    OdeSystem {
        number: 25,
        parameters: &[4.5, 0.43],
        starts: [&[0.12, 0.043], &[0.0, -0.3]],
        span: 10.0,
        terms: terms![|x, c| 0 => x[1], 1 => -c[0] * x[0], 1 => -c[1] * x[1]],
    },
    OdeSystem {
        number: 26,
        parameters: &[3.0, 2.0, 2.0],
        starts: [&[5.0, 4.3], &[2.3, 3.6]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0] * x[0],
            0 => -x[0] * x[0],
            0 => -c[1] * x[0] * x[1],
            1 => c[2] * x[1],
            1 => -x[0] * x[1],
            1 => -x[1] * x[1]
        ],
    },
    OdeSystem {
        number: 27,
        parameters: &[1.84, 1.45, 3.0, 1.62],
        starts: [&[8.3, 3.4], &[0.4, 0.65]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0] * x[0],
            0 => -c[1] * x[0] * x[1],
            1 => -c[2] * x[1],
            1 => c[3] * x[0] * x[1]
        ],
    },
    OdeSystem {
        number: 28,
        parameters: &[0.9],
        starts: [&[-1.9, 0.0], &[0.3, 0.8]],
        span: 10.0,
        terms: terms![|x, c| 0 => x[1], 1 => -c[0] * sin(x[0])],
    },
    OdeSystem {
        number: 29,
        parameters: &[0.65],
        starts: [&[3.2, 1.4], &[1.3, 0.2]],
        span: 10.0,
        terms: terms![|x, c| 0 => c[0] * x[0] * x[1], 1 => x[1] * x[1], 1 => -x[0] * x[0]],
    },
    OdeSystem {
        number: 30,
        parameters: &[1.61],
        starts: [&[0.3, 0.04], &[0.1, 0.21]],
        span: 10.0,
        terms: terms![|x, c|
            0 => x[0] * x[1],
            0 => -c[0] * x[0] * x[0] * x[1],
            1 => x[0] * x[1],
            1 => -c[0] * x[0] * x[1] * x[1]
        ],
    },
    OdeSystem {
        number: 31,
        parameters: &[0.4, 0.314],
        starts: [&[7.2, 0.98], &[20.0, 12.4]],
        span: 10.0,
        terms: terms![|x, c| 0 => -c[0] * x[0] * x[1], 1 => c[0] * x[0] * x[1], 1 => -c[1] * x[1]],
    },
    OdeSystem {
        number: 32,
        parameters: &[0.18],
        starts: [&[-1.8, -1.8], &[5.8, 0.0]],
        span: 10.0,
        terms: terms![|x, c| 0 => x[1], 1 => -c[0] * x[1], 1 => x[0], 1 => -x[0] * x[0] * x[0]],
    },
    OdeSystem {
        number: 33,
        parameters: &[0.08],
        starts: [&[5.0, 0.7], &[9.81, -0.8]],
        span: 10.0,
        terms: terms![|x, c|
            0 => -sin(x[1]),
            0 => -c[0] * x[0] * x[0],
            1 => x[0],
            1 => -cos(x[1]) / x[0]
        ],
    },
    OdeSystem {
        number: 34,
        parameters: &[0.93],
        starts: [&[2.1, 0.0], &[-1.2, -0.2]],
        span: 10.0,
        terms: terms![|x, c| 0 => x[1], 1 => sin(x[0]) * cos(x[0]), 1 => -c[0] * sin(x[0])],
    },
    OdeSystem {
        number: 35,
        parameters: &[4.2],
        starts: [&[1.13, -0.3], &[2.4, 1.7]],
        span: 10.0,
        terms: terms![|x, c|
            0 => cos(x[0]) / tan(x[1]),
            1 => sin(x[0]) * cos(x[1]) * cos(x[1]),
            1 => c[0] * sin(x[0]) * sin(x[1]) * sin(x[1])
        ],
    },
    OdeSystem {
        number: 36,
        parameters: &[0.07],
        starts: [&[0.45, 0.9], &[1.34, -0.8]],
        span: 10.0,
        terms: terms![|x, c| 0 => x[1], 1 => -sin(x[0]), 1 => -x[1], 1 => -c[0] * cos(x[0]) * x[1]],
    },
    OdeSystem {
        number: 37,
        parameters: &[0.43],
        starts: [&[2.2, 0.0], &[0.1, 3.2]],
        span: 10.0,
        terms: terms![|x, c| 0 => x[1], 1 => -x[0], 1 => -c[0] * x[0] * x[0] * x[1], 1 => c[0] * x[1]],
    },
    OdeSystem {
        number: 38,
        parameters: &[3.37],
        starts: [&[0.7, 0.0], &[-1.1, -0.7]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0] * x[1],
            0 => -c[0] / 3.0 * x[0] * x[0] * x[0],
            0 => c[0] * x[0],
            1 => -x[0] / c[0]
        ],
    },
    OdeSystem {
        number: 39,
        parameters: &[2.4, 0.07],
        starts: [&[0.4, 0.31], &[0.2, -0.7]],
        span: 10.0,
        terms: terms![|x, c|
            0 => -x[0],
            0 => c[0] * x[1],
            0 => x[0] * x[0] * x[1],
            1 => c[1],
            1 => -c[0] * x[0],
            1 => -x[0] * x[0] * x[1]
        ],
    },
    OdeSystem {
        number: 40,
        parameters: &[0.886],
        starts: [&[0.63, -0.03], &[0.2, 0.2]],
        span: 10.0,
        terms: terms![|x, c| 0 => x[1], 1 => -x[0], 1 => c[0] * x[1], 1 => -c[0] * x[0] * x[0] * x[1]],
    },
    OdeSystem {
        number: 41,
        parameters: &[15.3, 0.001, 0.3],
        starts: [&[0.8, 0.3], &[0.02, 1.2]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0] * c[1] * x[1],
            0 => -c[0] * c[1] * x[0],
            0 => c[0] * x[0] * x[0] * x[1],
            0 => -c[0] * x[0] * x[0] * x[0],
            0 => -x[0],
            1 => c[2],
            1 => -x[0]
        ],
    },
    OdeSystem {
        number: 42,
        parameters: &[8.9, 4.0, 1.4],
        starts: [&[0.2, 0.35], &[3.0, 7.8]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0],
            0 => -x[0],
            0 (1) => -c[1] * x[0] * x[1] / (1.0 + x[0] * x[0]),
            1 => c[2] * x[0],
            1 (1) => -c[2] * x[0] * x[1] / (1.0 + x[0] * x[0])
        ],
    },
    OdeSystem {
        number: 43,
        parameters: &[1.67, 0.64],
        starts: [&[1.47, -0.2], &[-1.9, 0.03]],
        span: 10.0,
        terms: terms![|x, c| 0 => x[1], 1 => c[0], 1 => -sin(x[0]), 1 => -c[1] * x[1]],
    },
    OdeSystem {
        number: 44,
        parameters: &[1.67, 0.64],
        starts: [&[1.47, -0.2], &[-1.9, 0.03]],
        span: 10.0,
        terms: terms![|x, c| 0 => x[1], 1 => c[0], 1 => -sin(x[0]), 1 => -c[1] * x[1] * x[1].abs()],
    },
    OdeSystem {
        number: 45,
        parameters: &[0.5, 0.02],
        starts: [&[1.4, 0.2], &[0.32, 0.64]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0],
            0 => -c[0] * x[0],
            0 => -x[0] * x[1] * x[1],
            1 => x[0] * x[1] * x[1],
            1 => -c[1] * x[1]
        ],
    },
    OdeSystem {
        number: 46,
        parameters: &[0.33],
        starts: [&[0.54, -0.1], &[0.43, 1.21]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0] * sin(x[0] - x[1]),
            0 => -sin(x[0]),
            1 => c[0] * sin(x[1] - x[0]),
            1 => -sin(x[1])
        ],
    },
    OdeSystem {
        number: 47,
        parameters: &[4.89, 1.4],
        starts: [&[0.65, 0.59], &[3.2, 10.3]],
        span: 10.0,
        terms: terms![|x, c|
            0 => -x[0],
            0 (2) => 1.0 / (1.0 + exp(c[0] * x[1] - c[1])),
            1 => -x[1],
            1 (2) => 1.0 / (1.0 + exp(c[0] * x[0] - c[1]))
        ],
    },
    OdeSystem {
        number: 48,
        parameters: &[18.3, 0.48, 11.23],
        starts: [&[0.1, 30.4], &[13.2, 5.21]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0],
            0 => -x[0],
            0 (1) => -x[0] * x[1] / (1.0 + c[1] * x[0] * x[0]),
            1 => c[2],
            1 (1) => -x[0] * x[1] / (1.0 + c[1] * x[0] * x[0])
        ],
    },
    OdeSystem {
        number: 49,
        parameters: &[3.03, 3.1],
        starts: [&[0.7, -1.4], &[2.1, 1.3]],
        span: 10.0,
        terms: terms![|x, c|
            0 => 1.0,
            0 => -(c[0] + 1.0) * x[0],
            0 => c[1] * x[0] * x[0] * x[1],
            1 => c[0] * x[0],
            1 => -c[1] * x[0] * x[0] * x[1]
        ],
    },
    OdeSystem {
        number: 50,
        parameters: &[0.24, 1.43],
        starts: [&[0.14, 0.6], &[1.5, 0.9]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0],
            0 => -x[0],
            0 => x[0] * x[0] * x[1],
            1 => c[1],
            1 => -x[0] * x[0] * x[1]
        ],
    },
    OdeSystem {
        number: 51,
        parameters: &[1.432, 0.972],
        starts: [&[2.2, 0.67], &[0.03, -0.12]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0],
            0 => sin(x[1]) * cos(x[0]),
            1 => c[1],
            1 => sin(x[1]) * cos(x[0])
        ],
    },
];
