//! The report as one page: its sections in reading order.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::{script, section};
use crate::study::Study;

/// Light, dark and paper.
const STYLE: &str = include_str!("style.css");

/// The report as one HTML page.
pub fn page(study: &Study) -> String {
    let calibration = &study.lead;
    let comparison = calibration.comparison();
    let diagnostics = calibration.diagnostics(&comparison);
    let (parameters, method) = match &calibration.estimate {
        Some(estimate) => (
            section::estimate(calibration, estimate),
            match estimate.sd {
                Some(_) => ("fit", "Fit", section::fit(calibration, estimate)),
                None => ("search", "Search", section::fit(calibration, estimate)),
            },
        ),
        None => (
            section::parameters(calibration),
            match &calibration.approximated {
                Some(mode) => ("fit", "Fit", section::fit(calibration, mode)),
                None => ("stages", "Sampler", section::stages(calibration)),
            },
        ),
    };
    let mut sections: Vec<(&str, &str, Markup)> = vec![
        (
            "comparison",
            "Model against measurement",
            section::comparison(calibration, &comparison),
        ),
        (
            "errors",
            "Errors by channel",
            html! { (section::errors(calibration, &comparison)) (section::groups(&comparison)) (section::ledger(study).unwrap_or_default()) },
        ),
        ("parameters", "Parameters", parameters),
        method,
    ];
    // A point has no spread to diagnose by.
    if diagnostics.sampler.is_some() {
        let after_parameters = [
            ("diagnostics", "Diagnostics", section::diagnostics(&diagnostics)),
            (
                "rejections",
                "Rejections by region of the prior",
                section::rejections(&diagnostics.rejections),
            ),
        ];
        sections.splice(3..3, after_parameters);
    }
    if !study.point_estimates.is_empty() {
        sections.push((
            "beside",
            "Point estimates",
            section::point_estimates(&study.point_estimates),
        ));
    }
    if let Some(discovery) = section::discovery(study) {
        sections.push(("discovery", "Missing effects", discovery));
    }
    let figures = study.figures();
    if !figures.is_empty() {
        sections.push(("figures", "Figures", section::figures(&figures)));
    }
    sections.push(("provenance", "Provenance", section::provenance(calibration)));
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { "Calibration report: " (calibration.experiment) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    h1 { "Calibration report: " (calibration.experiment) }
                    p.subtitle { (section::subtitle(calibration)) }
                    nav {
                        @for (id, title, _) in &sections { a href={ "#" (id) } { (title) } " " }
                    }
                }
                main {
                    (section::verdict(study, &comparison))
                    @for (id, title, body) in &sections {
                        section id=(id) { h2 { (title) } (body) }
                    }
                }
                @if !figures.is_empty() { (script::scripts(&figures)) }
            }
        }
    };
    markup.into_string()
}

#[cfg(test)]
mod tests {
    use crate::finished_calibration::FinishedCalibration;
    use crate::fixture;
    use crate::study::Study;

    fn page(calibration: FinishedCalibration) -> String {
        super::page(&Study::from(calibration))
    }

    #[test]
    fn names_of_users_are_escaped_everywhere() {
        let page = super::page(&fixture::study());
        assert!(
            page.contains("&lt;script&gt;"),
            "the hostile names of the fixture are shown"
        );
        // The only scripts are ours: the numbers of the figures and the modules that draw them.
        let ours = ["<script type=\"application/json\"", "<script type=\"module\">"];
        assert_eq!(page.matches("<script").count(), ours.len(), "and never as markup");
        assert!(ours.iter().all(|script| page.contains(script)));
        assert_eq!(page.matches("</script").count(), ours.len());
        assert!(!page.contains("<i>bold"), "nor in the text of the job");
    }

    #[test]
    fn the_page_needs_nothing_from_elsewhere() {
        let page = page(fixture::calibration());
        for word in ["http://", "https://", "src=", "@import", "url("] {
            assert!(!page.contains(word), "{word}");
        }
    }

    #[test]
    fn no_number_is_missing_from_a_picture() {
        for calibration in [
            fixture::calibration(),
            fixture::without_holdout(),
            fixture::all_rejected(),
            fixture::fit(),
            fixture::search(),
        ] {
            let page = page(calibration);
            for word in ["NaN", "inf ", "inf\"", "-inf"] {
                assert!(!page.contains(word), "{word}");
            }
        }
    }

    #[test]
    fn equal_calibrations_give_equal_pages() {
        assert_eq!(page(fixture::calibration()), page(fixture::calibration()));
    }

    #[test]
    fn a_fit_shows_its_point_and_claims_no_distribution() {
        let page = page(fixture::fit());
        for words in [
            "AT BOUND",
            "no step improves the posterior",
            "lm with at most 200 evaluations",
            "interpolation",
        ] {
            assert!(page.contains(words), "{words}");
        }
        for words in [
            "posterior mean",
            "posterior-mean",
            "predictive intervals contain",
            "equilibrium",
            "log-evidence",
            "90 % ",
        ] {
            assert!(!page.contains(words), "{words}");
        }
    }

    #[test]
    fn a_search_that_was_cut_short_says_so_and_has_no_standard_deviations() {
        let estimate = fixture::search().point_estimate().unwrap();
        let page = page(fixture::search());
        for words in [
            "ga with at most 200 generations of 100",
            "its last generation was reached",
            "allow more generations",
            "there are no standard deviations",
        ] {
            assert!(page.contains(words), "{words}");
        }
        assert!(!page.contains("Laplace") && !page.contains("no information"));
        assert!(estimate.sd.is_none() && estimate.history.len() == 1);
    }

    #[test]
    fn without_holdout_the_report_says_what_that_means() {
        assert!(page(fixture::without_holdout()).contains("No run was held out"));
        assert!(!page(fixture::calibration()).contains("No run was held out"));
    }

    #[test]
    fn the_model_s_limits_and_the_likelihood_s_departure_are_always_stated() {
        let page = page(fixture::calibration());
        assert!(page.contains("Grousers are not modelled here"));
        assert!(page.contains("lack 1/sigma"));
    }

    #[test]
    fn a_grown_study_shows_its_ledger_and_its_searches() {
        let study = fixture::grown();
        let page = super::page(&study);
        assert!(page.contains("<h3>Error ledger</h3>"));
        let (_, discovery) = page.split_once("id=\"discovery\"").unwrap();
        for words in [
            "The data name slip_sinkage.",
            "coordinator extend 1 --effect slip_sinkage",
            "shear depends on slip (step",
            "aria-label=\"correction of shear by slip\"",
            "a plate test at 80 N",
        ] {
            assert!(discovery.contains(words), "{words}");
        }
        assert_eq!(page.matches("<script").count(), 2, "names are escaped here, too");
        let summary = study.summary();
        assert_eq!(summary.calibrations.len(), 2);
        assert_eq!(summary.discovery.unwrap().rounds.len(), 1);
        assert!(!super::page(&fixture::study()).contains("id=\"discovery\""));
    }

    #[test]
    fn a_search_beside_a_sample_has_its_point_and_its_tables() {
        let page = super::page(&fixture::study());
        let (_, beside) = page.split_once("id=\"beside\"").unwrap();
        for words in [
            "ga with at most 200 generations of 100",
            "AT BOUND",
            "in units of",
            "Table of all runs",
        ] {
            assert!(beside.contains(words), "{words}");
        }
        assert!(page.contains("log-evidence"), "and the sample stands there too");
    }
}
