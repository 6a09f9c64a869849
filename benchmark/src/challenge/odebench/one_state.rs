//! Systems 1 to 23 of `ODEBench`: one state.

use libm::{cos, exp, log, pow, sin};

use super::system::{OdeSystem, Term, terms};

/// The systems of one state.
pub const SYSTEMS: [OdeSystem; 23] = [
    OdeSystem {
        number: 1,
        parameters: &[0.7, 1.2, 2.31],
        starts: [&[10.0], &[3.54]],
        span: 10.0,
        terms: terms![|x, c| 0 => c[0] / c[2], 0 => -x[0] / (c[1] * c[2])],
    },
    OdeSystem {
        number: 2,
        parameters: &[0.23],
        starts: [&[4.78], &[0.87]],
        span: 10.0,
        terms: terms![|x, c| 0 => c[0] * x[0]],
    },
    OdeSystem {
        number: 3,
        parameters: &[0.79, 74.3],
        starts: [&[7.3], &[21.0]],
        span: 10.0,
        terms: terms![|x, c| 0 => c[0] * x[0], 0 => -c[0] / c[1] * x[0] * x[0]],
    },
    OdeSystem {
        number: 4,
        parameters: &[0.5, 0.96],
        starts: [&[0.8], &[0.02]],
        span: 10.0,
        terms: terms![|x, c| 0 (2) => 1.0 / (1.0 + exp(c[0] - x[0] / c[1])), 0 => -0.5],
    },
    OdeSystem {
        number: 5,
        parameters: &[9.81, 0.0021175],
        starts: [&[0.5], &[73.0]],
        span: 10.0,
        terms: terms![|x, c| 0 => c[0], 0 => -c[1] * x[0] * x[0]],
    },
    OdeSystem {
        number: 6,
        parameters: &[2.1, 0.5],
        starts: [&[0.13], &[2.24]],
        span: 10.0,
        terms: terms![|x, c| 0 => c[0] * x[0], 0 => -c[1] * x[0] * x[0]],
    },
    OdeSystem {
        number: 7,
        parameters: &[0.032, 2.29],
        starts: [&[1.73], &[9.5]],
        span: 10.0,
        terms: terms![|x, c| 0 (1) => c[0] * x[0] * log(c[1] * x[0])],
    },
    OdeSystem {
        number: 8,
        parameters: &[0.14, 130.0, 4.4],
        starts: [&[6.123], &[2.1]],
        span: 10.0,
        terms: terms![|x, c|
            0 => -c[0] * x[0],
            0 => c[0] * (1.0 / c[1] + 1.0 / c[2]) * x[0] * x[0],
            0 => -c[0] / (c[1] * c[2]) * x[0] * x[0] * x[0]
        ],
    },
    OdeSystem {
        number: 9,
        parameters: &[0.32, 0.28],
        starts: [&[0.14], &[0.55]],
        span: 10.0,
        terms: terms![|x, c| 0 => c[0], 0 => -c[0] * x[0], 0 => -c[1] * x[0]],
    },
    OdeSystem {
        number: 10,
        parameters: &[0.2, 1.2],
        starts: [&[0.83], &[0.34]],
        span: 10.0,
        terms: terms![|x, c|
            0 (1) => c[0] * (1.0 - x[0]) * pow(x[0].max(0.0), c[1]),
            0 (1) => -(1.0 - c[0]) * x[0] * pow((1.0 - x[0]).max(0.0), c[1])
        ],
    },
    OdeSystem {
        number: 11,
        parameters: &[],
        starts: [&[3.4], &[1.6]],
        span: 10.0,
        terms: terms![|x, c| 0 => -x[0] * x[0] * x[0]],
    },
    OdeSystem {
        number: 12,
        parameters: &[1.8, 0.1107],
        starts: [&[11.0], &[1.3]],
        span: 10.0,
        terms: terms![|x, c| 0 => c[0] * x[0], 0 => -c[1] * x[0] * x[0]],
    },
    OdeSystem {
        number: 13,
        parameters: &[0.0981, 9.7],
        starts: [&[3.1], &[2.4]],
        span: 10.0,
        terms: terms![|x, c| 0 => c[0] * c[1] * sin(x[0]) * cos(x[0]), 0 => -c[0] * sin(x[0])],
    },
    OdeSystem {
        number: 14,
        parameters: &[0.78, 81.0, 21.2, 0.9],
        starts: [&[2.76], &[23.3]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0] * x[0],
            0 => -c[0] / c[1] * x[0] * x[0],
            0 (1) => -c[3] * x[0] * x[0] / (c[2] * c[2] + x[0] * x[0])
        ],
    },
    OdeSystem {
        number: 15,
        parameters: &[0.4, 95.0],
        starts: [&[44.3], &[4.5]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0] * x[0],
            0 => -c[0] / c[1] * x[0] * x[0],
            0 (1) => -x[0] * x[0] / (1.0 + x[0] * x[0])
        ],
    },
    OdeSystem {
        number: 16,
        parameters: &[0.1, -0.04, 0.001],
        starts: [&[0.94], &[1.65]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0] * x[0],
            0 => -c[1] * x[0] * x[0] * x[0],
            0 => -c[2] * x[0] * x[0] * x[0] * x[0] * x[0]
        ],
    },
    OdeSystem {
        number: 17,
        parameters: &[0.4, 100.0, 0.3],
        starts: [&[14.3], &[34.2]],
        span: 10.0,
        terms: terms![|x, c| 0 => c[0] * x[0], 0 => -c[0] / c[1] * x[0] * x[0], 0 => -c[2]],
    },
    OdeSystem {
        number: 18,
        parameters: &[0.4, 100.0, 0.24, 50.0],
        starts: [&[21.1], &[44.1]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0] * x[0],
            0 => -c[0] / c[1] * x[0] * x[0],
            0 (1) => -c[2] * x[0] / (c[3] + x[0])
        ],
    },
    OdeSystem {
        number: 19,
        parameters: &[0.08, 0.8],
        starts: [&[0.13], &[0.03]],
        span: 10.0,
        terms: terms![|x, c| 0 => x[0], 0 => -x[0] * x[0], 0 (1) => -c[0] * x[0] / (c[1] + x[0])],
    },
    OdeSystem {
        number: 20,
        parameters: &[0.1, 0.55],
        starts: [&[0.002], &[0.25]],
        span: 10.0,
        terms: terms![|x, c| 0 => c[0], 0 => -c[1] * x[0], 0 (1) => x[0] * x[0] / (1.0 + x[0] * x[0])],
    },
    OdeSystem {
        number: 21,
        parameters: &[1.2, 0.2],
        starts: [&[0.0], &[0.8]],
        span: 10.0,
        terms: terms![|x, c| 0 => c[0], 0 => -c[1] * x[0], 0 (1) => -exp(-x[0])],
    },
    OdeSystem {
        number: 22,
        parameters: &[1.4, 0.4, 123.0, 0.89],
        starts: [&[3.1], &[6.3]],
        span: 10.0,
        terms: terms![|x, c|
            0 => c[0],
            0 (2) => c[1] * pow(x[0], 5.0) / (c[2] + pow(x[0], 5.0)),
            0 => -c[3] * x[0]
        ],
    },
    OdeSystem {
        number: 23,
        parameters: &[0.21],
        starts: [&[-2.74], &[1.65]],
        span: 10.0,
        terms: terms![|x, c| 0 => c[0], 0 => -sin(x[0])],
    },
];
