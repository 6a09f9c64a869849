//! What formulas say beyond their range.

use equation::{Host, Limit, splitting};

use crate::setup::{answer, curve};

#[test]
fn laws_tend_to_what_their_formulas_say() {
    let saturating = curve(Host::Addition, 0.01, |x| 3.0 * (1.0 - (-x / 0.3).exp()));
    let best = &answer(&saturating).0.formulas[0];
    let Limit::Value(above) = best.limit_above(&saturating) else {
        panic!("{:?}", best.limit_above(&saturating));
    };
    assert!((above - 3.0).abs() < 0.05, "{above}");
    assert!(matches!(best.limit_below(&saturating), Some(Limit::Value(below)) if below.abs() < 0.01));
    let power = curve(Host::Addition, 0.001, |x| 2.0 * x.powf(1.5));
    let best = &answer(&power).0.formulas[0];
    assert!(
        matches!(best.limit_above(&power), Limit::Power { exponent, .. } if (exponent - 1.5).abs() < 0.05)
    );
}

#[test]
fn powers_have_the_exponent_of_the_variable_at_both_ends() {
    for power in [-0.3, 0.3] {
        let curve = curve(Host::Addition, 0.0005, |x| 2.0 * x.powf(power));
        let best = &answer(&curve).0.formulas[0];
        for limit in [Some(best.limit_above(&curve)), best.limit_below(&curve)] {
            assert!(
                matches!(limit, Some(Limit::Power { exponent, sign })
                    if (exponent - power).abs() < 0.05 && sign > 0.0),
                "{power}: {limit:?} of {}",
                best.tree
            );
        }
    }
}

#[test]
fn two_formulas_are_split_where_they_differ_most() {
    let curve = curve(Host::Addition, 0.1, |x| 1.0 - (-x / 0.6).exp());
    let answer = answer(&curve).0;
    let by_text = |text: &str| {
        answer
            .formulas
            .iter()
            .find(|formula| formula.tree.to_string() == text)
            .unwrap()
    };
    let (a, b) = (by_text("(1 - exp(c * x))"), by_text("sqrt(x)"));
    let condition = splitting(&curve, a, b).unwrap();
    assert!(
        condition.sds > 1.0 && (0.02..=2.0).contains(&condition.at),
        "{condition:?}"
    );
    for (formula, law) in [a, b].into_iter().zip(condition.laws) {
        assert!((formula.law(&curve, condition.at) - law).abs() < 1e-12);
    }
}
