//! Values of formulas, at one point and in blocks.

use formula::block::{BLOCK, Block};
use formula::variable::Variables;
use formula::{Effect, Hook, Variable};

/// Returns an effect whose pressure is a formula, with parameters a = 0.3 and b = −2.
fn effect(formula: &str) -> Effect {
    let text = format!(
        "name = \"toy\"\nsummary = \"a toy\"\nsource = \"none\"\npressure = \"{formula}\"\ntorque = \"torque * a * b\"\n\
         [parameters.a]\nunit = \"1\"\nneutral = 0.0\nprior = 1.0\n[parameters.b]\nunit = \"1\"\nneutral = 0.0\nprior = 1.0\n"
    );
    Effect::read(&text).unwrap_or_else(|e| panic!("{formula}: {e}"))
}

const PARAMETERS: [f64; 2] = [0.3, -2.0];

/// Evaluates the formula at one point, with nothing that differs from point to point.
fn at_one_point(formula: &str, variables: &[f64; Variable::COUNT]) -> f64 {
    let program = effect(formula)
        .program(Hook::Pressure, Variables::default())
        .unwrap();
    program.settle(variables, &PARAMETERS, &mut Vec::new()).unwrap()
}

#[test]
fn operators_bind_as_in_mathematics() {
    let mut variables = [0.0; Variable::COUNT];
    variables[Variable::Slip as usize] = 0.2;
    for (formula, value) in [
        ("1 + 2 * 3", 7.0),
        ("(1 + 2) * 3", 9.0),
        ("8 / 4 / 2", 1.0),
        ("7 - 4 - 2", 1.0),
        ("2 ^ 3 ^ 2", 512.0),
        ("-2 ^ 2", -4.0),
        ("(-2) ^ 2", 4.0),
        ("2 ^ -1", 0.5),
        ("- -3", 3.0),
        ("2e-1 + .5", 0.7),
        ("min(3, 2) + max(3, 2)", 5.0),
        ("pow(2, 3)", 8.0),
        ("if(slip > 0.1, 5, 6)", 5.0),
        ("if(slip <= 0.1, 5, 6)", 6.0),
        ("if(slip == 0.2, 5, 6)", 5.0),
        ("if(slip != 0.2, 5, 6)", 6.0),
        ("1 * (abs(-3) + sqrt(9) + exp(0) + log(1))", 7.0),
        ("1 * (cos(0) + sin(0) + tan(0) + tanh(0))", 1.0),
        ("10 * a + 1 * b", 1.0),
        ("1 * cos(pi)", -1.0),
    ] {
        let actual = at_one_point(formula, &variables);
        // a power is an exponential of a logarithm
        let tolerance = if formula.contains(['^', 'w']) {
            4e-15 * f64::abs(value)
        } else {
            1e-15
        };
        assert!(
            (actual - value).abs() <= tolerance,
            "{formula} = {actual}, not {value}"
        );
    }
}

#[test]
fn every_operation_agrees_with_one_point_at_a_time() {
    let points: Vec<f64> = (0..BLOCK)
        .map(|i| match i {
            0 => 0.0,
            1 => -0.0,
            2 => 1e-320,
            3 => 1e308,
            4 => -1e308,
            5 => 710.0,
            6 => -710.0,
            7 => f64::MIN_POSITIVE,
            8 => 1e-3,
            _ => (i as f64 - 64.0) * 0.137,
        })
        .collect();
    let local = Variables::new(&[Variable::Z, Variable::Vt]);
    for formula in [
        "z + v_t",
        "z - v_t",
        "z * v_t",
        "z / v_t",
        "z ^ v_t",
        "abs(z) ^ v_t",
        "z ^ 2",
        "abs(z) ^ 0.5",
        "z ^ 3",
        "2 ^ z",
        "z ^ a",
        "min(z, v_t)",
        "max(z, v_t)",
        "exp(z / 1) * 1",
        "log(z / 1) * 1",
        "sqrt(z)",
        "tanh(z / 1) * 1",
        "abs(z)",
        "sin(z / 1) * 1",
        "cos(z / 1) * 1",
        "tan(z / 1) * 1",
        "-z",
        "if(z < v_t, z, 1)",
        "if(z <= v_t, 1, z)",
        "if(z == v_t, 1, 0)",
        "if(z != v_t, 1, 0)",
        "a * b * 1",
        "v_t",
        "1 * a - z * b * 1",
    ] {
        let effect = effect(&formula.replace("v_t", "(v_t * 1)").replace('z', "(z * 1)"));
        let program = effect.program(Hook::Pressure, local).unwrap();
        let (mut block, mut scalars) = (Block::default(), Vec::new());
        let mut variables = [0.0; Variable::COUNT];
        program.settle(&variables, &PARAMETERS, &mut scalars);
        block.column_mut(Variable::Z).copy_from_slice(&points);
        let reversed: Vec<f64> = points.iter().rev().copied().collect();
        block.column_mut(Variable::Vt).copy_from_slice(&reversed);
        block.replace(Variable::P, &program, &scalars, BLOCK);
        let one = effect.program(Hook::Pressure, Variables::default()).unwrap();
        for i in 0..BLOCK {
            variables[Variable::Z as usize] = points[i];
            variables[Variable::Vt as usize] = reversed[i];
            let expected = one.settle(&variables, &PARAMETERS, &mut scalars).unwrap();
            let actual = block.column(Variable::P)[i];
            let same = actual == expected || actual.is_nan() && expected.is_nan();
            // the exponent multiplies the rounding of the logarithm
            let tolerance = 1e-14 * expected.abs() + if expected.abs() < 1e-300 { 1e-300 } else { 0.0 };
            let tolerance = if formula.contains('^') {
                20.0 * tolerance
            } else {
                tolerance
            };
            assert!(
                same || (actual - expected).abs() <= tolerance,
                "{formula} at {} and {}: {actual:e}, not {expected:e}",
                points[i],
                reversed[i]
            );
        }
    }
}

#[test]
fn a_block_may_be_short_and_used_again() {
    let program = effect("p * (1 + a * z) ^ b")
        .program(Hook::Pressure, Variables::new(&[Variable::P, Variable::Z]))
        .unwrap();
    let (mut block, mut scalars) = (Block::default(), Vec::new());
    program.settle(&[0.0; Variable::COUNT], &PARAMETERS, &mut scalars);
    for points in [1, 7, 8, 9, 128] {
        for i in 0..points {
            block.column_mut(Variable::P)[i] = 1e4;
            block.column_mut(Variable::Z)[i] = i as f64;
        }
        block.replace(Variable::P, &program, &scalars, points);
        for i in 0..points {
            let expected = 1e4 * (1.0 + 0.3 * i as f64).powi(-2);
            assert!((block.column(Variable::P)[i] / expected - 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn kinks_are_those_between_points() {
    let local = Variables::new(&[Variable::P, Variable::Z, Variable::Position]);
    for (formula, kinked) in [
        ("if(position > 0.5, 1.8 * p, p)", true),
        ("p * max(z / 1, 0.001)", true),
        ("if(slip > 0.3, 0.8 * p, p)", false), // one branch holds for all points
        ("p * if(slip > 0.3, 0.8, 1)", false),
        ("p * (exp(-z / 0.01) * 1)", false),
    ] {
        assert_eq!(
            effect(formula)
                .program(Hook::Pressure, local)
                .unwrap()
                .kinks()
                .meets(local),
            kinked,
            "{formula}"
        );
    }
}

#[test]
fn undefined_values_are_as_documented() {
    let mut variables = [0.0; Variable::COUNT];
    variables[Variable::Z as usize] = f64::NAN;
    variables[Variable::Vt as usize] = -0.0;
    let (nan, infinite) = (f64::NAN, f64::INFINITY);
    for (formula, value) in [
        ("min(NAN, 1)", nan),
        ("min(1, NAN)", nan),
        ("max(NAN, 1)", nan),
        ("max(1, NAN)", nan),
        ("if(NAN < 1, 2, 3)", 3.0),
        ("if(NAN >= 1, 2, 3)", 3.0),
        ("if(NAN == NAN, 2, 3)", 3.0),
        ("if(NAN != NAN, 2, 3)", 2.0),
        ("if(1 < 2, 2, NAN)", 2.0),
        ("if(ZERO == 0, 2, 3)", 2.0),
        ("0 ^ 0", 1.0),
        ("NAN ^ 0", 1.0),
        ("1 ^ NAN", 1.0),
        ("0 ^ 1.5", 0.0),
        ("0 ^ -1.5", infinite),
        ("(-2) ^ 3", -8.0),
        ("(-2) ^ 1.5", nan),
        ("(-4) ^ 0.5", nan),
        ("exp(709) / exp(709) * 1", 1.0),
        ("exp(710) * 1", infinite),
        ("exp(-700.1) * 1", 0.0),
        ("log(0) * 1", -infinite),
        ("log(-1) * 1", nan),
        ("sqrt(-1)", nan),
        ("1 / 0", infinite),
        ("1 / ZERO", -infinite),
        ("0 / 0", nan),
        ("tanh(1e9) * 1", 1.0),
        ("tanh(-1 / 0) * 1", -1.0),
        ("tanh(NAN) * 1", nan),
        ("1e300 * 1e300", infinite),
    ] {
        let names = formula.replace("NAN", "(z / 1)").replace("ZERO", "(v_t / 1)");
        let actual = at_one_point(&names, &variables);
        assert!(
            actual == value || actual.is_nan() && value.is_nan(),
            "{formula} = {actual}, not {value}"
        );
    }
}

#[test]
fn elementary_functions_agree_with_those_of_libm() {
    type Function = fn(f64) -> f64;
    let functions: [(&str, Function, f64); 4] = [
        ("exp(z / 1) * 1", libm::exp, 1e-15),
        ("log(abs(z / 1)) * 1", |x| libm::log(x.abs()), 1e-15),
        ("tanh(z / 1) * 1", libm::tanh, 1e-14),
        ("abs(z / 1)^1.7", |x| libm::pow(x.abs(), 1.7), 1e-14),
    ];
    let mut variables = [0.0; Variable::COUNT];
    for (formula, exact, tolerance) in functions {
        let effect = effect(formula);
        let program = effect.program(Hook::Pressure, Variables::default()).unwrap();
        for step in -2000..2000 {
            let x = f64::from(step) * 0.0137 + 0.001;
            variables[Variable::Z as usize] = x;
            let (actual, expected) = (
                program.settle(&variables, &PARAMETERS, &mut Vec::new()).unwrap(),
                exact(x),
            );
            let error = (actual / expected - 1.0).abs();
            assert!(
                error <= tolerance,
                "{formula} at {x}: {actual:e}, not {expected:e}"
            );
        }
    }
}

#[test]
fn signs_bind_less_than_powers_and_more_than_products() {
    let variables = [0.0; Variable::COUNT];
    for (formula, same) in [
        ("-a^2", "-(a^2)"),
        ("a^-b", "a^(-b)"),
        ("a^b^a", "a^(b^a)"),
        ("-a * b", "(-a) * b"),
        ("2 - -a", "2 + a"),
        ("a / b * 3", "(a / b) * 3"),
        ("-a^-b^-a", "-(a^(-(b^(-a))))"),
    ] {
        let [actual, expected] =
            [formula, same].map(|f| at_one_point(&format!("1 * ({f}) * b / b * a / a"), &variables));
        assert!(
            actual.to_bits() == expected.to_bits() || actual.is_nan(),
            "{formula}: {actual}, not {expected}"
        );
    }
}

#[test]
fn zero_of_either_sign_is_neutral() {
    let effect = effect("p * a * b");
    for (values, neutral) in [
        ([0.0, 0.0], true),
        ([-0.0, 0.0], true),
        ([0.0, 5e-324], false),
        ([f64::NAN, 0.0], false),
        ([0.0, f64::INFINITY], false),
    ] {
        assert_eq!(effect.is_neutral(&values), neutral, "{values:?}");
    }
}

#[test]
fn line_ends_of_windows_and_a_byte_order_mark_change_nothing() {
    let text =
        "name = \"toy\"\nsummary = \"a toy\"\nsource = \"none\"\npressure = \"\"\"\np\n  * 3\n\"\"\"\n";
    for text in [
        text.to_owned(),
        text.replace('\n', "\r\n"),
        format!("\u{feff}{text}"),
    ] {
        let effect = Effect::read(&text).unwrap_or_else(|e| panic!("{e}"));
        let program = effect.program(Hook::Pressure, Variables::default()).unwrap();
        let value = program
            .settle(&[2.0; Variable::COUNT], &[], &mut Vec::new())
            .unwrap();
        assert_eq!(value, 6.0);
    }
}
