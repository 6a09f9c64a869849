//! Generates formulas, effect files and points from bytes, and checks the results of the crate.
//!
//! All choices come from the given bytes, so that proptest can shrink them and a run can be repeated.

use formula::block::{BLOCK, Block};
use formula::variable::Variables;
use formula::{Effect, Hook, Variable};

/// A source of choices, one byte each; 0, the simplest choice, when the bytes are used up.
#[derive(Debug)]
pub(crate) struct Dice<'a>(pub(crate) &'a [u8]);

impl Dice<'_> {
    fn byte(&mut self) -> u8 {
        match self.0.split_first() {
            Some((&first, rest)) => {
                self.0 = rest;
                first
            }
            None => 0,
        }
    }

    /// Returns a number below `count`, which is at most 65536.
    fn below(&mut self, count: usize) -> usize {
        let high = if count > 256 { self.byte() } else { 0 };
        (usize::from(high) << 8 | usize::from(self.byte())) % count
    }

    fn one<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }

    /// Returns a number, possibly an awkward one.
    fn value(&mut self) -> f64 {
        const AWKWARD: [f64; 20] = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            0.5,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NAN,
            f64::MIN_POSITIVE,
            5e-324,
            1e-320,
            f64::MAX,
            f64::MIN,
            700.0,
            -700.0,
            709.9,
            -745.2,
            1e308,
            1e17,
            0.02,
        ];
        match self.below(4) {
            0 => f64::from(self.byte()) * 0.01,
            1 => self.one(&AWKWARD),
            2 => f64::from_bits(u64::from_be_bytes(core::array::from_fn(|_| self.byte()))),
            _ => (f64::from(self.byte()) - 128.0) * 0.37,
        }
    }
}

const NUMBERS: [&str; 12] = [
    "1", "2", "0.5", "0", "3", "1e-3", ".25", "7.", "1e300", "2E+2", "700", "5e-324",
];

/// Names, for the greater part with a unit that fits everywhere.
const NAMES: [&str; 14] = [
    "a",
    "b",
    "slip",
    "position",
    "(p * 1)",
    "(z * 1)",
    "(v_t * 1)",
    "k_star",
    "pi",
    "p",
    "z",
    "tau_max",
    "one",
    "two",
];

const FUNCTIONS: [&str; 8] = ["exp", "log", "sqrt", "tanh", "abs", "sin", "cos", "tan"];

const COMPARISONS: [&str; 6] = ["<", "<=", ">", ">=", "==", "!="];

/// Generates a formula by the grammar; its names and units may not fit.
pub(crate) fn formula(dice: &mut Dice<'_>, depth: u32) -> String {
    if depth == 0 {
        return dice.one(&NAMES).to_owned();
    }
    let next = |dice: &mut Dice<'_>| formula(dice, depth - 1);
    match dice.below(14) {
        0 | 1 => dice.one(&NAMES).to_owned(),
        2 => dice.one(&NUMBERS).to_owned(),
        3..=7 => {
            let sign = dice.one(&[" + ", "-", " * ", "/", " ^ ", "^2 * ", "^0.5 + "]);
            format!("{}{sign}{}", next(dice), next(dice))
        }
        8 => format!("-{}", next(dice)),
        9 => format!("({})", next(dice)),
        10 | 11 => format!("{}({})", dice.one(&FUNCTIONS), next(dice)),
        12 => format!(
            "{}({}, {})",
            dice.one(&["min", "max", "pow"]),
            next(dice),
            next(dice)
        ),
        _ => {
            let comparison = dice.one(&COMPARISONS);
            let parts: Vec<String> = (0..4).map(|_| next(dice)).collect();
            format!(
                "if({} {comparison} {}, {}, {})",
                parts[0], parts[1], parts[2], parts[3]
            )
        }
    }
}

/// Generates an effect file by the format; its names and units may not fit.
pub(crate) fn file(dice: &mut Dice<'_>) -> String {
    let mut text = "name = \"toy\"\nsummary = \"a toy\"\nsource = \"none\"\n".to_owned();
    let mut used = String::new();
    for hook in [
        Hook::Pressure,
        Hook::Shear,
        Hook::ShearLimit,
        Hook::Torque,
        Hook::Slip,
    ] {
        if hook == Hook::Pressure || dice.below(6) == 0 {
            let formula = formula(dice, 5);
            used += &formula;
            text += &match dice.below(4) {
                0 => format!("{} = \"\"\"\n{formula}\"\"\"\r\n", hook.name()),
                1 => format!("{} = '''{formula}''' # é\n", hook.name()),
                _ => format!("{} = \"{formula}\"\n", hook.name()),
            };
        }
    }
    text += "[definitions]\n";
    for (name, replacement) in [("one", "two"), ("two", "three")] {
        if used.contains(name) {
            let formula = formula(dice, 3).replace(name, replacement).replace("three", "1");
            used += &formula;
            text += &format!("{name} = \"{formula}\"\n");
        }
    }
    for name in ["a", "b"] {
        let alone = |part: &str| part == name;
        if used
            .split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
            .any(alone)
        {
            let unit = dice.one(&["1", "1", "1", "m", "deg"]);
            text += &format!(
                "[parameters.{name}]\nunit = \"{unit}\"\nneutral = 0\nprior = {{ uniform = [0, 1] }}\n"
            );
        }
    }
    text
}

/// Returns the text with some mistakes.
pub(crate) fn mutated(text: &str, dice: &mut Dice<'_>) -> String {
    const PIECES: [&str; 24] = [
        "(",
        ")",
        "^",
        "**",
        "-",
        "1e999",
        "1e-999",
        "é",
        "\u{0}",
        "\"",
        "\"\"\"",
        "\n",
        "\r\n",
        "\\u00e9",
        "[",
        "]]",
        "{a=",
        "if(",
        ",",
        "<",
        "\u{feff}",
        "[parameters.a.a.a.a.a.a.a]\n",
        "((((((((((((((((((((((((((((((",
        "tau",
    ];
    let mut characters: Vec<char> = text.chars().collect();
    for _ in 0..=dice.below(4) {
        let at = dice.below(characters.len().clamp(1, 60_000));
        let end = (at + dice.below(12)).min(characters.len());
        match dice.below(4) {
            0 => drop(characters.drain(at.min(end)..end)),
            1 => {
                let piece: Vec<char> = dice.one(&PIECES).chars().collect();
                characters.splice(at.min(end)..at.min(end), piece);
            }
            2 => {
                let piece = characters[at.min(end)..end].repeat(1 + dice.below(200));
                characters.splice(end..end, piece);
            }
            _ => {
                if let Some(character) = characters.get_mut(at) {
                    *character = char::from(dice.byte());
                }
            }
        }
    }
    characters.into_iter().collect()
}

/// Generates a text: a file by the format, one with mistakes, a formula of any characters, or any text.
pub(crate) fn anything(dice: &mut Dice<'_>) -> String {
    match dice.below(5) {
        0 => file(dice),
        1 | 2 => mutated(&file(dice), dice),
        3 => {
            let formula = mutated(&formula(dice, 6), dice);
            let head = "name = \"toy\"\nsummary = \"a toy\"\nsource = \"none\"\npressure = '''";
            format!("{head}{formula}'''\n[parameters.a]\nunit = \"1\"\nneutral = 0\nprior = 1\n")
        }
        _ => String::from_utf8_lossy(dice.0).into_owned(),
    }
}

/// Reads a text; an error must be one line with a valid place.
pub(crate) fn check_read(text: &str) -> Option<Effect> {
    match Effect::read(text) {
        Ok(effect) => Some(effect),
        Err(error) => {
            let shown = error.to_string();
            assert!(
                !shown.contains('\n') && !shown.is_empty(),
                "{shown:?} of {text:?}"
            );
            assert!(shown.chars().count() < 3000 + text.len(), "{shown:?}");
            if let (Some(line), Some(column)) = (error.line, error.column) {
                let line_text = text.split('\n').nth(line - 1);
                let line_text = line_text.unwrap_or_else(|| panic!("no line {line} in {text:?}"));
                assert!(column <= line_text.chars().count() + 1, "{shown:?} of {text:?}");
            }
            None
        }
    }
}

/// Checks that an effect has the same bits at one point and in blocks, for any choice of the variables that differ from
/// point to point. Returns the number of values compared.
pub(crate) fn check_evaluation(effect: &Effect, dice: &mut Dice<'_>) -> usize {
    let parameters: Vec<f64> = effect.parameters.iter().map(|_| dice.value()).collect();
    let mut compared = 0;
    for hook in effect.hooks() {
        let points = 1 + dice.below(BLOCK.min(40));
        let table: Vec<[f64; Variable::COUNT]> = {
            let first: [f64; Variable::COUNT] = core::array::from_fn(|_| dice.value());
            let point = |_| {
                let mut point = first;
                point[..Variable::LOCAL]
                    .iter_mut()
                    .for_each(|value| *value = dice.value());
                point
            };
            (0..points).map(point).collect()
        };
        let local = (0..Variable::LOCAL).filter(|_| dice.below(4) > 0);
        let local = local.fold(Variables::default(), |set, place| set.with(Variable::ALL[place]));
        compared += compare(effect, hook, local, &parameters, &table);
    }
    compared
}

fn compare(
    effect: &Effect,
    hook: Hook,
    local: Variables,
    parameters: &[f64],
    table: &[[f64; Variable::COUNT]],
) -> usize {
    let at_one = effect
        .program(hook, Variables::default())
        .expect("the hook has a formula");
    let in_blocks = effect.program(hook, local).expect("the hook has a formula");
    assert_eq!(at_one.uses(), in_blocks.uses());
    // variables that are equal at all points have the value of the first point
    let shared = |point: &[f64; Variable::COUNT]| {
        core::array::from_fn(|place| {
            let differs = local.contains(Variable::ALL[place]);
            if differs { point[place] } else { table[0][place] }
        })
    };
    let (mut block, mut scalars, mut settled_scalars) = (Block::default(), Vec::new(), Vec::new());
    for variable in local.iter() {
        let column = block.column_mut(variable);
        column
            .iter_mut()
            .zip(table)
            .for_each(|(value, point)| *value = point[variable as usize]);
    }
    let settled = in_blocks.settle(&table[0], parameters, &mut scalars);
    // the column that the formula replaces, whether or not the hook is at nodes
    let target = if (hook.target() as usize) < Variable::LOCAL {
        hook.target()
    } else {
        Variable::P
    };
    block.replace(target, &in_blocks, &scalars, table.len());
    for (actual, point) in block.column(target).iter().zip(table) {
        let expected = at_one
            .settle(&shared(point), parameters, &mut settled_scalars)
            .expect("nothing differs");
        let same =
            |actual: f64| actual.to_bits() == expected.to_bits() || actual.is_nan() && expected.is_nan();
        assert!(
            same(*actual) && settled.is_none_or(same),
            "{actual:e}, not {expected:e} at {point:?} with {parameters:?} of {}",
            effect.text
        );
    }
    table.len()
}

/// Generates a formula of operations that are exact to the last bit, with its value at given z, `v_t` and slip, and its
/// binding strength: 0 sum, 1 product, 2 sign, 3 power, 4 anything else.
pub(crate) fn exact(dice: &mut Dice<'_>, depth: u32, values: [f64; 3]) -> (String, u8, f64) {
    if depth == 0 {
        let place = dice.below(3);
        return (
            ["(z * 1)", "(v_t * 1)", "(slip * 1)"][place].to_owned(),
            4,
            values[place],
        );
    }
    let next = |dice: &mut Dice<'_>, least: u8| {
        let (text, level, value) = exact(dice, depth - 1, values);
        (if level < least { format!("({text})") } else { text }, value)
    };
    match dice.below(9) {
        0 | 1 => {
            let ((a, x), (b, y)) = (next(dice, 0), next(dice, 1));
            if dice.below(2) == 0 {
                (format!("{a} + {b}"), 0, x + y)
            } else {
                (format!("{a} - {b}"), 0, x - y)
            }
        }
        2 | 3 => {
            let ((a, x), (b, y)) = (next(dice, 1), next(dice, 2));
            if dice.below(2) == 0 {
                (format!("{a} * {b}"), 1, x * y)
            } else {
                (format!("{a}/{b}"), 1, x / y)
            }
        }
        4 => {
            let (a, x) = next(dice, 2);
            (format!("-{a}"), 2, -x)
        }
        5 => {
            let (a, x) = next(dice, 4);
            if dice.below(2) == 0 {
                (format!("{a}^2"), 3, x * x)
            } else {
                (format!("{a}^0.5"), 3, x.sqrt())
            }
        }
        6 => {
            let ((a, x), (b, y)) = (next(dice, 0), next(dice, 0));
            let nan = x.is_nan() || y.is_nan();
            let (smaller, greater) = (if x < y { x } else { y }, if x > y { x } else { y });
            match (dice.below(2), nan) {
                (0, nan) => (format!("min({a}, {b})"), 4, if nan { f64::NAN } else { smaller }),
                (_, nan) => (format!("max({a}, {b})"), 4, if nan { f64::NAN } else { greater }),
            }
        }
        7 => {
            let (a, x) = next(dice, 0);
            (format!("abs({a})"), 4, x.abs())
        }
        _ => {
            let parts: [(String, f64); 4] = core::array::from_fn(|_| next(dice, 0));
            let [(a, w), (b, x), (c, y), (d, z)] = parts;
            let place = dice.below(COMPARISONS.len());
            let holds = [w < x, w <= x, w > x, w >= x, w == x, w != x][place];
            (
                format!("if({a} {} {b}, {c}, {d})", COMPARISONS[place]),
                4,
                if holds { y } else { z },
            )
        }
    }
}

/// Reads a formula of exact operations and compares its value with the generator's.
pub(crate) fn check_exact(dice: &mut Dice<'_>) {
    let values = [dice.value(), dice.value(), dice.value()];
    let (formula, _, expected) = exact(dice, 5, values);
    let text = format!("name = \"toy\"\nsummary = \"a toy\"\nsource = \"none\"\npressure = \"{formula}\"\n");
    if formula.chars().count() > 2000 {
        return;
    }
    let effect = Effect::read(&text).unwrap_or_else(|e| panic!("{e}: {formula}"));
    let mut point = [0.0; Variable::COUNT];
    for (variable, value) in [Variable::Z, Variable::Vt, Variable::Slip]
        .into_iter()
        .zip(values)
    {
        point[variable as usize] = value;
    }
    let program = effect
        .program(Hook::Pressure, Variables::default())
        .expect("it has a pressure");
    let actual = program
        .settle(&point, &[], &mut Vec::new())
        .expect("nothing differs");
    let same = actual.to_bits() == expected.to_bits() || actual.is_nan() && expected.is_nan();
    assert!(same, "{formula} at {values:?} is {actual:e}, not {expected:e}");
}
