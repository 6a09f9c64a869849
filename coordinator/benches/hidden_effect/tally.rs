//! Count what was found against what was hidden.

use std::fmt;

use inference::Likelihood;
use inference::discovery::Finding;

use crate::models::Models;
use crate::study::Case;

/// A log Bayes factor above this is a detection.
const DETECTED: f64 = 3.0;
/// A class is named above this probability.
const NAMED: f64 = 0.9;
/// Nats by which the truth must beat every rival outside its class for the targets to count.
const SEPARATED: f64 = 10.0;
/// Lower ends of the bins of stated probabilities.
const BINS: [f64; 4] = [0.0, 0.5, 0.8, 0.95];

/// How one experiment fared.
#[derive(Debug, Clone)]
pub(crate) struct Fate {
    is_hidden: bool,
    detected: bool,
    /// The most probable candidate is the truth, of its class; one of the best two is, of either class.
    name: bool,
    class: bool,
    two_names: bool,
    two_classes: bool,
    /// Whether the truth is alone in its class.
    alone: bool,
    /// Probability of the most probable class, none among them, and whether it is right.
    stated: f64,
    stated_right: bool,
    stated_none: bool,
    covered: bool,
    set_size: usize,
    /// What the screen alone would have said.
    screen_name: bool,
    screen_class: bool,
    /// Nats between the truth and its best rival outside its class, without noise.
    separation: Option<f64>,
    to_name: usize,
    to_confirm: usize,
}

/// Nats by which the best rival outside the truth's class falls short on noise-free data.
pub(crate) fn separation(hidden: usize, clear: &Finding, noise_free: &Likelihood) -> Option<f64> {
    let measured: Vec<f64> = noise_free.data().iter().map(|d| d.value).collect();
    let perfect = noise_free.log_likelihood(&measured, &[]).ok()?.value();
    let own = clear.of(Some(hidden))?.class;
    let rivals = clear.judged.iter().filter(|j| j.class != own);
    Some(perfect - rivals.map(|j| j.log_likelihood).fold(f64::NEG_INFINITY, f64::max))
}

impl Fate {
    pub(crate) fn new(hidden: Option<usize>, finding: &Finding, separation: Option<f64>) -> Self {
        let ranked = finding.ranked();
        let own = finding.of(hidden).map(|j| j.class);
        let is_own = |class: usize| Some(class) == own;
        let mut screened = ranked.clone();
        screened.sort_by(|a, b| b.screen_log_bayes_factor.total_cmp(&a.screen_log_bayes_factor));
        let classes = finding.judged.iter().map(|j| j.class).max().unwrap_or(0);
        let (best, stated) = (0..=classes)
            .map(|c| (c, finding.of_class(c)))
            .reduce(|a, b| if b.1 > a.1 { b } else { a })
            .unwrap_or((0, 1.0));
        Self {
            is_hidden: hidden.is_some(),
            detected: ranked.first().is_some_and(|j| j.log_bayes_factor > DETECTED),
            name: ranked.first().is_some_and(|j| j.candidate == hidden),
            class: ranked.first().is_some_and(|j| is_own(j.class)),
            two_names: ranked.iter().take(2).any(|j| j.candidate == hidden),
            two_classes: ranked.iter().take(2).any(|j| is_own(j.class)),
            alone: finding.judged.iter().filter(|j| is_own(j.class)).count() == 1,
            stated,
            stated_right: is_own(best),
            stated_none: best == 0,
            covered: finding.credible_set.iter().any(|c| is_own(*c)),
            set_size: finding.credible_set.len(),
            screen_name: screened.first().is_some_and(|j| j.candidate == hidden),
            screen_class: screened.first().is_some_and(|j| is_own(j.class)),
            separation,
            to_name: finding.spent.to_name(),
            to_confirm: finding.spent.to_confirm(),
        }
    }

    /// One line for one experiment.
    pub(crate) fn line(&self, models: &Models, case: &Case, finding: &Finding) -> String {
        let best: Vec<String> = finding
            .ranked()
            .iter()
            .take(3)
            .map(|j| {
                let name = models.name(j.candidate);
                format!(
                    "{name} {:.1} (screen {:.1}, c{})",
                    j.log_bayes_factor, j.screen_log_bayes_factor, j.class
                )
            })
            .collect();
        let own = finding.of(case.hidden);
        format!(
            "{:<26} {} {:7.1} (screen {:7.1}, c{}) sep {:7.1} | {} | base {:.1} nats below the truth, evaluations {} {} | truth {} fit {} base {}",
            models.name(case.hidden),
            match (self.detected, self.class) {
                (false, _) => "  -  ",
                (true, true) if self.name => "right",
                (true, true) => "class",
                (true, false) => "WRONG",
            },
            own.map_or(f64::NAN, |j| j.log_bayes_factor),
            own.map_or(f64::NAN, |j| j.screen_log_bayes_factor),
            own.map_or(0, |j| j.class),
            self.separation.unwrap_or(f64::NAN),
            best.join(", "),
            case.perfect() - finding.judged[0].log_likelihood,
            self.to_name,
            self.to_confirm,
            list(&case.truth),
            own.map_or(String::new(), |j| list(&j.theta)),
            list(&finding.judged[0].theta)
        )
    }
}

fn list(theta: &[f64]) -> String {
    let numbers: Vec<String> = theta.iter().map(|x| format!("{x:.4e}")).collect();
    format!("[{}]", numbers.join(" "))
}

/// All experiments.
#[derive(Debug, Default)]
pub(crate) struct Tally(Vec<Fate>);

impl Tally {
    pub(crate) fn add(&mut self, fate: Fate) {
        self.0.push(fate);
    }
}

/// `n of m (share)`.
fn share<'a>(fates: &[&'a Fate], holds: impl Fn(&'a Fate) -> bool) -> String {
    let count = fates.iter().filter(|f| holds(f)).count();
    format!(
        "{count} of {} ({:.3})",
        fates.len(),
        count as f64 / fates.len().max(1) as f64
    )
}

fn mean(values: impl Iterator<Item = usize> + Clone) -> String {
    let most = values.clone().max().unwrap_or(0);
    let count = values.clone().count().max(1);
    format!("{:.0} (most {most})", values.sum::<usize>() as f64 / count as f64)
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of = |holds: &dyn Fn(&Fate) -> bool| self.0.iter().filter(|fate| holds(fate)).collect::<Vec<_>>();
        let hidden = of(&|x| x.is_hidden);
        let detected = of(&|x| x.is_hidden && x.detected);
        let clear = of(&|x| x.is_hidden && x.detected && x.separation.is_some_and(|s| s >= SEPARATED));
        writeln!(
            f,
            "one effect hidden: detected {}",
            share(&hidden, |x| x.detected)
        )?;
        for (what, group) in [
            ("detected", &detected),
            ("detected and separated by 10 nats", &clear),
        ] {
            let alone: Vec<&Fate> = group.iter().copied().filter(|x| x.alone).collect();
            let named: Vec<&Fate> = group
                .iter()
                .copied()
                .filter(|x| x.stated > NAMED && !x.stated_none)
                .collect();
            writeln!(f, "of the {what}:")?;
            writeln!(f, "  right class            {}", share(group, |x| x.class))?;
            writeln!(f, "  right name             {}", share(group, |x| x.name))?;
            writeln!(f, "  right name, class of 1 {}", share(&alone, |x| x.name))?;
            writeln!(
                f,
                "  top two: class, name   {}, {}",
                share(group, |x| x.two_classes),
                share(group, |x| x.two_names)
            )?;
            writeln!(
                f,
                "  screen: class, name    {}, {}",
                share(group, |x| x.screen_class),
                share(group, |x| x.screen_name)
            )?;
            writeln!(
                f,
                "  right where P > .9     {}",
                share(&named, |x| x.stated_right)
            )?;
            writeln!(f, "  in the 95 % set        {}", share(group, |x| x.covered))?;
            let sizes = group.iter().map(|x| x.set_size).sum::<usize>() as f64;
            writeln!(
                f,
                "  size of that set       {:.2}",
                sizes / group.len().max(1) as f64
            )?;
        }
        let nothing = of(&|x| !x.is_hidden);
        let claim = |x: &Fate| x.detected && x.stated > NAMED && !x.stated_none;
        writeln!(f, "nothing hidden: claimed  {}", share(&nothing, claim))?;
        writeln!(f, "  some log BF > 3        {}", share(&nothing, |x| x.detected))?;
        let everything = of(&|_| true);
        writeln!(
            f,
            "in the 95 % set, all     {}",
            share(&everything, |x| x.covered)
        )?;
        for (k, low) in BINS.iter().enumerate() {
            let high = BINS.get(k + 1).copied().unwrap_or(f64::INFINITY);
            let bin = of(&|x| (*low..high).contains(&x.stated));
            let of_effects = of(&|x| (*low..high).contains(&x.stated) && !x.stated_none);
            writeln!(
                f,
                "stated P >= {low:.2}: right {}; of those that name an effect {}",
                share(&bin, |x| x.stated_right),
                share(&of_effects, |x| x.stated_right)
            )?;
        }
        let all = || self.0.iter();
        writeln!(f, "evaluations to name      {}", mean(all().map(|x| x.to_name)))?;
        write!(
            f,
            "evaluations to confirm   {}",
            mean(all().map(|x| x.to_confirm))
        )
    }
}
