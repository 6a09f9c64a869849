//! How often the formula of a generated law is found from its noisy curve. Arguments: `--seed S`, `--laws N`, `--details`, and
//! `--cases FILE`, which writes the decidable cases with these answers as lines of JSON for other programs
//! (`benchmark/rivals/formula.py`).
//!
//! The laws come from a generator that shares no code with the search: half of them are laws of the literature, half are random
//! expressions. A law is decidable where its log Bayes factor over every shorter formula exceeds 3.

#![expect(clippy::unwrap_used, reason = "a study may panic as tests do")]

use std::sync::Arc;
use std::time::Instant;

use equation::{Answer, FormulaLibrary, Host, Link, LocatedCurve, Tree, fitted, search};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

const POINTS: usize = 30;

/// Random numbers (Steele and others 2014, splitmix64).
struct Random(u64);

impl Random {
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn pick(&mut self, count: usize) -> usize {
        (self.share() * count as f64) as usize
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.share()).ln()).sqrt() * (std::f64::consts::TAU * self.share()).cos()
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }
}

/// The value of a law by its variable and its parameters.
type LawValue = Box<dyn Fn(f64, &[f64]) -> f64 + Sync + Send>;

/// A generated law: its values by its parameters.
struct Law {
    name: String,
    value: LawValue,
    parameters: Vec<f64>,
}

/// A law of the literature.
fn known(random: &mut Random) -> Law {
    type Value = fn(f64, &[f64]) -> f64;
    const LAWS: [(&str, Value, usize); 22] = [
        ("a x", |x, p| p[0] * x, 1),
        ("a x^2", |x, p| p[0] * x * x, 1),
        ("a sqrt x", |x, p| p[0] * x.sqrt(), 1),
        ("a / x", |x, p| p[0] / (x + 0.0), 1),
        ("a x^b", |x, p| p[0] * x.powf(0.3 + 2.0 * p[1]), 2),
        ("a (1 - exp(-x/s))", |x, p| p[0] * (1.0 - (-x / p[1]).exp()), 2),
        ("a exp(-x/s)", |x, p| p[0] * (-x / p[1]).exp(), 2),
        ("a x/(x+s)", |x, p| p[0] * x / (x + p[1]), 2),
        ("a/(x+s)", |x, p| p[0] / (x + p[1]), 2),
        ("a ln(1+x/s)", |x, p| p[0] * (1.0 + x / p[1]).ln(), 2),
        ("a tanh(x/s)", |x, p| p[0] * (x / p[1]).tanh(), 2),
        ("a (x+s)", |x, p| p[0] * (x + p[1]), 2),
        ("a step(x > s)", |x, p| if x > p[1] { p[0] } else { 0.0 }, 2),
        ("a x exp(-x/s)", |x, p| p[0] * x * (-x / p[1]).exp(), 2),
        ("a x^2/(x^2+s)", |x, p| p[0] * x * x / (x * x + p[1] * p[1]), 2),
        (
            "a exp(-(x/s)^2)",
            |x, p| p[0] * (-(x / p[1]) * (x / p[1])).exp(),
            2,
        ),
        (
            "a exp(-((x-c)/w)^2)",
            |x, p| p[0] * (-((x - p[2]) / (0.3 * p[1] + 0.05)).powi(2)).exp(),
            3,
        ),
        ("a (1+x/s)^b", |x, p| p[0] * (1.0 + x / p[1]).powf(-2.0 * p[2]), 3),
        ("a (c + exp(-x/s))", |x, p| p[0] * (p[2] + (-x / p[1]).exp()), 3),
        ("a (x + c x^2)", |x, p| p[0] * (x + 2.0 * p[1] * x * x), 2),
        (
            "a tanh((x-c)/w)",
            |x, p| p[0] * ((x - p[2]) / (0.3 * p[1] + 0.03)).tanh(),
            3,
        ),
        (
            "a x^b exp(-x/s)",
            |x, p| p[0] * x.powf(2.0 * p[2]) * (-x / p[1]).exp(),
            3,
        ),
    ];
    let (name, value, count) = LAWS[random.pick(LAWS.len())];
    let mut parameters = vec![random.normal()];
    for _ in 1..count {
        parameters.push((random.between(0.08_f64.ln(), 1.2_f64.ln())).exp());
    }
    Law {
        name: name.to_owned(),
        value: Box::new(value),
        parameters,
    }
}

/// A random expression.
enum Node {
    X,
    Scaled(usize),
    Shifted(usize),
    Power(Box<Node>, usize),
    Unary(u8, Box<Node>),
    Binary(u8, Box<Node>, Box<Node>),
}

impl Node {
    fn random(random: &mut Random, nodes: usize, parameters: &mut Vec<f64>, may_transcend: bool) -> Node {
        let place = parameters.len();
        let coefficient = |random: &mut Random| {
            let size = random.between(0.4_f64.ln(), 9.0_f64.ln()).exp();
            if random.share() < 0.5 { size } else { -size }
        };
        if nodes <= 2 {
            return Node::X;
        }
        if nodes <= 3 || random.share() < 0.2 {
            return match random.pick(5) {
                0 | 1 => {
                    parameters.push(coefficient(random));
                    Node::Scaled(place)
                }
                2 => {
                    parameters.push(coefficient(random) / 5.0);
                    Node::Shifted(place)
                }
                3 => {
                    parameters.push(random.between(-1.5, 2.5));
                    Node::Power(Box::new(Node::X), place)
                }
                _ => Node::X,
            };
        }
        match random.pick(3) {
            0 if may_transcend => {
                let op = random.pick(3) as u8;
                Node::Unary(op, Box::new(Node::random(random, nodes - 1, parameters, false)))
            }
            1 => {
                let op = 3 + random.pick(2) as u8;
                Node::Unary(
                    op,
                    Box::new(Node::random(random, nodes - 1, parameters, may_transcend)),
                )
            }
            _ => {
                let left = 1 + random.pick(nodes - 2);
                let op = random.pick(4) as u8;
                let a = Node::random(random, left, parameters, may_transcend);
                let b = Node::random(random, nodes - 1 - left, parameters, may_transcend);
                Node::Binary(op, Box::new(a), Box::new(b))
            }
        }
    }

    fn value(&self, x: f64, p: &[f64]) -> f64 {
        match self {
            Node::X => x,
            Node::Scaled(k) => p[*k] * x,
            Node::Shifted(k) => x + p[*k],
            Node::Power(base, k) => base.value(x, p).powf(p[*k]),
            Node::Unary(op, inner) => {
                let y = inner.value(x, p);
                match op {
                    0 => y.exp(),
                    1 => y.ln(),
                    2 => y.tanh(),
                    3 => y.sqrt(),
                    _ => y * y,
                }
            }
            Node::Binary(op, a, b) => {
                let (a, b) = (a.value(x, p), b.value(x, p));
                match op {
                    0 => a + b,
                    1 => a - b,
                    2 => a * b,
                    _ => a / b,
                }
            }
        }
    }

    fn text(&self) -> String {
        match self {
            Node::X => "x".into(),
            Node::Scaled(_) => "c x".into(),
            Node::Shifted(_) => "(x + c)".into(),
            Node::Power(base, _) => format!("({})^c", base.text()),
            Node::Unary(op, inner) => format!(
                "{}({})",
                ["exp", "log", "tanh", "sqrt", "sq"][*op as usize],
                inner.text()
            ),
            Node::Binary(op, a, b) => format!(
                "({} {} {})",
                a.text(),
                ["+", "-", "*", "/"][*op as usize],
                b.text()
            ),
        }
    }
}

fn composed(random: &mut Random) -> Law {
    let mut parameters = vec![random.normal()];
    let nodes = 3 + random.pick(5);
    let node = Node::random(random, nodes, &mut parameters, true);
    Law {
        name: format!("a {}", node.text()),
        value: Box::new(move |x, p| p[0] * node.value(x, p)),
        parameters,
    }
}

/// A truth with noisy measurements.
struct Case {
    name: String,
    points: Vec<f64>,
    exact: Vec<f64>,
    size: f64,
    truth: Arc<Tree>,
    noise: Vec<f64>,
}

impl Case {
    /// Draws a law that varies and whose formula is in the library; `None` for another draw.
    fn draw(random: &mut Random, library: &FormulaLibrary) -> Option<Case> {
        let law = if random.share() < 0.5 {
            known(random)
        } else {
            composed(random)
        };
        let is_log = random.share() < 0.5;
        let points: Vec<f64> = (0..POINTS)
            .map(|i| i as f64 / (POINTS - 1) as f64)
            .map(|share| {
                if is_log {
                    30.0_f64.powf(share - 1.0)
                } else {
                    0.02 + 0.98 * share
                }
            })
            .collect();
        let exact: Vec<f64> = points.iter().map(|x| (law.value)(*x, &law.parameters)).collect();
        let noise = (0..POINTS).map(|_| random.normal()).collect();
        let mean = exact.iter().sum::<f64>() / POINTS as f64;
        let size = (exact.iter().map(|y| y * y).sum::<f64>() / POINTS as f64).sqrt();
        let spread = (exact.iter().map(|y| (y - mean) * (y - mean)).sum::<f64>() / POINTS as f64).sqrt();
        if !size.is_finite()
            || size < 1e-3
            || spread < 0.1 * size
            || exact.iter().any(|y| y.abs() > 8.0 * size)
        {
            return None;
        }
        let mut case = Case {
            name: law.name,
            points,
            exact,
            size,
            truth: Arc::new(Tree::variable()),
            noise,
        };
        // The formula that gives the exact curve with the fewest parameters and nodes.
        let sharp = case.curve(1e-5, 0.0);
        let mut exact: Vec<_> = search(&sharp, library).formulas;
        exact.retain(|formula| formula.misfit < 5.0);
        exact.sort_by_key(|formula| (formula.parameters(), formula.tree.size));
        case.truth = exact.first()?.tree.clone();
        Some(case)
    }

    /// The curve with noise.
    fn curve(&self, share: f64, noisy: f64) -> LocatedCurve {
        let sd = share * self.size;
        let values: Vec<f64> = self
            .exact
            .iter()
            .zip(&self.noise)
            .map(|(y, e)| y + noisy * sd * e)
            .collect();
        let mut covariance = vec![0.0; POINTS * POINTS];
        for i in 0..POINTS {
            covariance[i * (POINTS + 1)] = sd * sd;
        }
        LocatedCurve::new(Host::Addition, &self.points, &values, &covariance).unwrap()
    }

    /// Whether a formula is the truth: it gives the exact curve with as few parameters.
    fn is_true(&self, tree: &Arc<Tree>) -> bool {
        let is_small = tree.constants <= self.truth.constants;
        let exact = fitted(&self.curve(1e-4, 0.0), tree, Link::Proportional);
        is_small && exact.is_some_and(|exact| exact.misfit < 5.0)
    }
}

/// What the search says of a case.
struct Judged {
    name: String,
    is_decidable: bool,
    probability: f64,
    is_in_class: bool,
    is_simplest: bool,
    members: usize,
    truth: String,
    said: String,
    seconds: f64,
}

fn judge(case: &Case, library: &FormulaLibrary, share: f64) -> Judged {
    let curve = case.curve(share, 1.0);
    let begin = Instant::now();
    let answer: Answer = search(&curve, library);
    let seconds = begin.elapsed().as_secs_f64();
    let length = |tree: &Tree| tree.size + tree.constants;
    let truth = fitted(&curve, &case.truth, Link::Proportional).map_or(f64::NEG_INFINITY, |t| t.log_evidence);
    let shorter = answer
        .formulas
        .iter()
        .filter(|f| length(&f.tree) < length(&case.truth));
    let rival = shorter.map(|f| f.log_evidence).fold(f64::NEG_INFINITY, f64::max);
    let class = &answer.classes[0];
    let simplest = &answer.formulas[answer.simplest(class)].tree;
    Judged {
        name: case.name.clone(),
        is_decidable: truth - rival > 3.0,
        probability: class.probability,
        is_in_class: class
            .members
            .iter()
            .any(|k| case.is_true(&answer.formulas[*k].tree)),
        is_simplest: case.is_true(simplest),
        members: class.members.len(),
        truth: case.truth.to_string(),
        said: simplest.to_string(),
        seconds,
    }
}

/// Writes a case with the answer as a line of JSON, for programs that are compared.
fn line(case: &Case, share: f64, judged: &Judged) -> String {
    let curve: Vec<f64> = case
        .exact
        .iter()
        .zip(&case.noise)
        .map(|(y, e)| y + share * case.size * e)
        .collect();
    format!(
        "{{\"law\": {:?}, \"noise\": {share:?}, \"sd\": {:?}, \"points\": {:?}, \"values\": {curve:?}, \"exact\": {:?}, \
         \"constants\": {}, \"in_class\": {}, \"simplest\": {}, \"members\": {}, \"probability\": {:?}, \"seconds\": {:?}}}\n",
        case.name,
        share * case.size,
        case.points,
        case.exact,
        1 + case.truth.constants,
        judged.is_in_class,
        judged.is_simplest,
        judged.members,
        judged.probability,
        judged.seconds,
    )
}

fn report(title: &str, judged: &[&Judged]) {
    let share = |test: &dyn Fn(&Judged) -> bool| {
        judged.iter().filter(|j| test(j)).count() as f64 / judged.len() as f64
    };
    let mut members: Vec<usize> = judged.iter().map(|j| j.members).collect();
    members.sort_unstable();
    println!(
        "{title}: {} laws; truth in class {:.3}, simplest {:.3}, median class {}, largest {}, P > .9 {:.2}",
        judged.len(),
        share(&|j| j.is_in_class),
        share(&|j| j.is_simplest),
        members[members.len() / 2],
        members[members.len() - 1],
        share(&|j| j.probability > 0.9),
    );
    for bin in [
        [0.0, 0.3],
        [0.3, 0.5],
        [0.5, 0.7],
        [0.7, 0.8],
        [0.8, 0.9],
        [0.9, 0.95],
        [0.95, 0.99],
        [0.99, 1.01],
    ] {
        let inside: Vec<_> = judged
            .iter()
            .filter(|j| (bin[0]..bin[1]).contains(&j.probability))
            .collect();
        if inside.is_empty() {
            continue;
        }
        let right = inside.iter().filter(|j| j.is_in_class).count();
        let mean = inside.iter().map(|j| j.probability).sum::<f64>() / inside.len() as f64;
        let [low, high] = interval(right, inside.len());
        let verdict = if (low..=high).contains(&mean) {
            ""
        } else {
            "  OUTSIDE"
        };
        println!(
            "  P {:.2} to {:.2}: mean {mean:.3}, right {right}/{} [{low:.2}, {high:.2}]{verdict}",
            bin[0],
            bin[1].min(1.0),
            inside.len()
        );
    }
}

/// The central 90 % interval of a share (Clopper and Pearson), by bisection.
fn interval(right: usize, all: usize) -> [f64; 2] {
    let tail = |p: f64, from: usize, to: usize| -> f64 {
        let mut term = (1.0 - p).powi(all as i32);
        let mut sum = if from == 0 { term } else { 0.0 };
        for k in 1..=to {
            term *= (all - k + 1) as f64 / k as f64 * p / (1.0 - p);
            if k >= from {
                sum += term;
            }
        }
        sum
    };
    let solve = |test: &dyn Fn(f64) -> bool| {
        let (mut low, mut high) = (1e-9, 1.0 - 1e-9);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if test(middle) { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    };
    let low = if right == 0 {
        0.0
    } else {
        solve(&|p| tail(p, right, all) < 0.05)
    };
    let high = if right == all {
        1.0
    } else {
        solve(&|p| tail(p, 0, right) > 0.05)
    };
    [low, high]
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let value = |name: &str| {
        arguments
            .iter()
            .position(|a| a == name)
            .and_then(|i| arguments.get(i + 1)?.parse::<usize>().ok())
    };
    let (seed, laws) = (value("--seed").unwrap_or(1), value("--laws").unwrap_or(200));
    let details = arguments.iter().any(|a| a == "--details");
    let library = FormulaLibrary::new(7, false);
    println!("formulas by size: {:?}", library.counts());
    let begin = Instant::now();
    let judged: Vec<(Case, [Judged; 2])> = (0..laws + laws / 2)
        .into_par_iter()
        .map(|index| {
            let mut random = Random((seed * 1_000_003 + index) as u64);
            let case = (0..).find_map(|_| Case::draw(&mut random, &library)).unwrap();
            let both = [0.01, 0.1].map(|share| judge(&case, &library, share));
            (case, both)
        })
        .collect();
    let mut lines = Vec::new();
    for (k, share) in [0.01, 0.1].into_iter().enumerate() {
        let of_noise = || judged.iter().map(|(case, both)| (case, &both[k]));
        let decidable_cases = of_noise().filter(|(_, judged)| judged.is_decidable).take(laws);
        lines.extend(decidable_cases.map(|(case, judged)| line(case, share, judged)));
        let judged: Vec<&Judged> = of_noise().map(|(_, judged)| judged).collect();
        if details {
            for j in judged.iter().filter(|j| !j.is_simplest) {
                println!(
                    "{:.2} {} {} {} | {} | truth {} | said {}",
                    j.probability, j.is_decidable, j.is_in_class, j.members, j.name, j.truth, j.said
                );
            }
        }
        let decidable: Vec<&Judged> = judged
            .iter()
            .filter(|j| j.is_decidable)
            .take(laws)
            .copied()
            .collect();
        report(&format!("noise {share}, decidable"), &decidable);
        report(&format!("noise {share}, all"), &judged);
        let seconds: f64 = judged.iter().map(|j| j.seconds).sum::<f64>() / judged.len() as f64;
        println!(
            "  {seconds:.2} s a search; {:.0} s in all",
            begin.elapsed().as_secs_f64()
        );
    }
    let file = arguments.iter().position(|a| a == "--cases");
    if let Some(file) = file.and_then(|i| arguments.get(i + 1)) {
        std::fs::write(file, lines.concat()).unwrap();
    }
}
