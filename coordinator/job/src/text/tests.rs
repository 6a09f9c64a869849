//! What each change of a text leaves alone; and that a change of the value is the same as that of the text.

use inference::StageMethod;

use super::*;
use crate::facts::{foreign_effects, is_earlier_search};
use crate::named_files::NamedFile;
use crate::{Job, PlainParameter};

const CONTINUED: &str = r#"# why
[model]
kind = "scm" # here
effects = ["hard_pan", "slip_sinkage"]
effect_files = ["mine.toml", "yours.toml"]
[priors]
n = 1.1
"slip_sinkage.exponent_slope" = { uniform = [0.0, 1.0] }
"mine.a.front" = 0.5
[sampler]
particles = 50
seed = 7
point_estimates = ["ga"]
[discovery]
apply = "auto"
"#;

fn job_of_two_files() -> FileSet {
    let file = |name: &str| format!("name = \"{name}\"\nshear = \"tau\"\n");
    FileSet {
        toml: CONTINUED.into(),
        files: [("mine.toml", "mine"), ("yours.toml", "yours")]
            .map(|(file_name, effect)| (file_name.to_owned(), file(effect)))
            .into(),
    }
}

#[test]
fn what_goes_on_asks_for_nothing_beside_itself() {
    let continued = continued_job("job.toml", &job_of_two_files()).unwrap();
    let parsed = Job::parse("job.toml", &continued.toml).unwrap();
    assert!(parsed.point_estimates.is_empty());
    assert_eq!(
        parsed.discovery,
        Job::parse("job.toml", "[model]\nkind = \"scm\"\n")
            .unwrap()
            .discovery
    );
    assert!(
        continued.toml.contains("particles = 50\nseed = 7\n"),
        "{}",
        continued.toml
    );
}

#[test]
fn a_dropped_effect_leaves_no_line_behind() {
    let names = ["slip_sinkage", "mine"].map(String::from);
    let without = without_effects("job.toml", &job_of_two_files(), &names).unwrap();
    for name in names {
        assert!(!without.toml.contains(&name), "{}", without.toml);
    }
    let parsed = Job::parse("job.toml", &without.toml).unwrap();
    assert_eq!(parsed.model.effects, ["hard_pan"]);
    assert_eq!(parsed.named_files(), ["yours.toml"]);
    assert_eq!(without.files.keys().collect::<Vec<_>>(), ["yours.toml"]);
    assert!(
        without
            .toml
            .starts_with("# why\n[model]\nkind = \"scm\" # here\n")
    );
}

const SEARCHED: &str = r#"# why
[model]
kind = "scm" # here
effects = ["hard_pan"]
[sampler]
particles = 50
seed = 7
point_estimates = ["ga"]
[discovery]
apply = "auto"
"#;

fn searched() -> FileSet {
    FileSet {
        toml: SEARCHED.into(),
        files: [("mine.toml".to_owned(), String::new())].into(),
    }
}

#[test]
fn a_search_had_the_seed_and_the_model_and_asked_for_nothing() {
    let search = earlier_search("job.toml", &searched()).unwrap();
    let expected = SEARCHED
        .replace("particles = 50\n", "")
        .replace("point_estimates = [\"ga\"]\n", "algorithm = \"discovery\"\n")
        .replace("[discovery]\napply = \"auto\"\n", "");
    assert_eq!(search.toml, expected);
    assert!(is_earlier_search(&search.toml) && !is_earlier_search(SEARCHED));
    assert_eq!(search.files, searched().files);
    let continued = continued_job("job.toml", &searched()).unwrap();
    let again = earlier_search("job.toml", &continued).unwrap();
    assert_eq!(again.toml, expected, "equal models have equal searches");
}

#[test]
fn this_version_reads_its_model_and_not_its_algorithm() {
    let search = earlier_search("job.toml", &searched()).unwrap();
    let refused = Job::parse("job.toml", &search.toml).unwrap_err().to_string();
    assert!(refused.contains("unknown algorithm \"discovery\""), "{refused}");
    let model = searched_model("job.toml", &search).unwrap();
    let parsed = Job::parse("job.toml", &model.toml).unwrap();
    assert_eq!(parsed.model.effects, ["hard_pan"]);
    assert_eq!(parsed.algorithm.seed(), 7);
}

#[test]
fn another_kind_leaves_the_settings_of_its_own() {
    let job = "[model]\nkind = \"scm\" # three dimensions\ndem_spacing_m = 0.005\nflow_fraction = 0.2\ncohesion_pa = 5.0\n";
    let with_setting = |toml: &str, name| changed(toml, ModelChange::Turn(ModelSwitch::find(name).unwrap()));
    let turned = |name| with_setting(job, name).unwrap();
    assert_eq!(
        turned("kind_quasi_static"),
        "[model]\nkind = \"quasi_static\"\ncohesion_pa = 5.0\n"
    );
    let rolled = "[model]\nkind = \"quasi_static\"\ngrousers = \"rolled\"\n";
    assert_eq!(
        with_setting(rolled, "kind_scm").unwrap(),
        "[model]\nkind = \"scm\"\n"
    );
    let node = turned("displacement_node");
    assert!(
        node.ends_with("cohesion_pa = 5.0\ndisplacement = \"node\"\n"),
        "{node}"
    );
}

const EXTENDED: &str = "# why\n[model]\nkind = \"scm\" # here\neffects = [\"hard_pan\"]\n\n[priors]\nn = 1.1\n\n[sampler]\nseed = 3\n";

fn alone(toml: &str) -> FileSet {
    FileSet {
        toml: toml.to_owned(),
        ..FileSet::default()
    }
}

/// Returns the text of a job with a change of its model.
fn changed(toml: &str, change: ModelChange) -> Result<String, String> {
    let addition = Addition {
        changes: vec![change],
        ..Addition::default()
    };
    let job = extended_job("job.toml", &alone(toml), &addition);
    job.map(|job| job.toml).map_err(|e| e.to_string())
}

/// Returns an effect of the catalogue, one in a file, and lines under `[priors]`.
fn addition(priors: &[(&str, &str)]) -> Addition {
    let read = |(name, value): &(&str, &str)| ((*name).to_owned(), value.parse().unwrap());
    Addition {
        effects: vec!["adhesion".into()],
        files: vec![("mine.toml".into(), NamedFile::new("mine".into()))],
        priors: priors.iter().map(read).collect(),
        ..Addition::default()
    }
}

fn extended(toml: &str, priors: &[(&str, &str)]) -> Result<String, String> {
    let job = extended_job("job.toml", &alone(toml), &addition(priors));
    job.map(|job| job.toml).map_err(|e| e.to_string())
}

#[test]
fn additions_join_those_of_the_job_and_leave_the_rest_as_it_is() {
    let added = extended(
        EXTENDED,
        &[("hard_pan.x.w", "{ half_normal = 25.0 }"), ("a.b", "0.5")],
    )
    .unwrap();
    let expected = EXTENDED
        .replace(
            "[\"hard_pan\"]",
            "[\"hard_pan\", \"adhesion\"]\neffect_files = [\"mine.toml\"]",
        )
        .replace(
            "n = 1.1\n",
            "n = 1.1\n\"hard_pan.x.w\" = { half_normal = 25.0 }\n\"a.b\" = 0.5\n",
        );
    assert_eq!(added, expected);
    let same = extended_job("job.toml", &alone(EXTENDED), &Addition::default()).unwrap();
    assert_eq!(same.toml, EXTENDED);
}

#[test]
fn a_parameter_is_freed_wherever_it_is_held() {
    let prior: toml::Value = "{ half_normal = 500.0 }".parse().unwrap();
    let free = |toml: &str| changed(toml, ModelChange::Free("cohesion_pa".into(), prior.clone()));
    let expected = "[model]\n[priors]\nn = 1.1\ncohesion_pa = { half_normal = 500.0 }\n";
    for held in [
        "[model]\n[priors]\nn = 1.1\n",
        "[model]\ncohesion_pa = 0.0\n[priors]\nn = 1.1\n",
        "[model]\n[priors]\ncohesion_pa = 0\nn = 1.1\n",
    ] {
        assert_eq!(free(held).unwrap(), expected);
    }
    let twice = free(expected).unwrap_err();
    assert_eq!(twice, "job.toml: cohesion_pa is already under [priors]");
}

#[test]
fn what_cannot_be_added_is_said() {
    let twice = extended(EXTENDED, &[("n", "1.2")]).unwrap_err();
    assert_eq!(twice, "job.toml: n is already under [priors]");
    let none = extended("[priors]\nn = 1.1\n", &[]).unwrap_err();
    assert_eq!(none, "job.toml: [model] is missing");
    let no_list = extended("[model]\neffects = 1\n", &[]).unwrap_err();
    assert_eq!(no_list, "job.toml: effects must be a list");
}

const COMPARED: &str = "experiment = \"e.toml\"\n\n[[models]]\nkind = \"quasi_static\"\nn = 1.0\n\n[[models]]\nkind = \"rft\"\n[models.priors]\nsurface_friction = 0.4\n\"noise.torque_n_m\" = { half_normal = 1.0 }\n\n[priors]\nlog10_p_ref = { uniform = [4.0, 6.0] } # stiff\nkappa = 0.0\nn = 1.1\nfriction_angle_deg = { uniform = [20.0, 40.0] }\n\"noise.torque_n_m\" = { half_normal = 0.5 }\n\n[sampler]\nseed = 3\n";

fn compared() -> FileSet {
    FileSet {
        toml: COMPARED.into(),
        ..FileSet::default()
    }
}

#[test]
fn each_model_alone_has_its_parameters_in_the_order_of_the_whole_job() {
    let models = Job::parse_models("job.toml", COMPARED).unwrap();
    assert_eq!(models.others.len(), 1);
    for (number, whole) in [&models.first, &models.others[0]].into_iter().enumerate() {
        let alone = Job::parse(
            "job.toml",
            &model_job("job.toml", &compared(), number).unwrap().toml,
        )
        .unwrap();
        let names = |job: &Job| {
            job.priors
                .iter()
                .map(|p| (p.name.clone(), p.value.clone()))
                .collect::<Vec<_>>()
        };
        assert_eq!(names(&alone), names(whole));
        assert_eq!((&alone.model, alone.algorithm), (&whole.model, whole.algorithm));
        assert_eq!((whole.models, alone.models), (2, 1));
    }
    let priors = &models.others[0].priors;
    let names: Vec<&str> = priors.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(
        names,
        ["surface_friction", "noise.torque_n_m"],
        "nothing of a Bekker soil"
    );
    assert_eq!(priors[0].line, Some(10));
    let first: Vec<&str> = models.first.priors.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(
        first,
        ["log10_p_ref", "kappa", "friction_angle_deg", "noise.torque_n_m"],
        "n is fixed there"
    );
}

#[test]
fn a_job_of_one_model_is_left_alone() {
    let job = FileSet {
        toml: "[model]\nkind = \"scm\" # here\n".into(),
        ..FileSet::default()
    };
    assert_eq!(model_job("job.toml", &job, 0).unwrap(), job);
}

#[test]
fn mistakes_of_a_later_model_have_their_line() {
    let broken = |from: &str, to: &str| {
        let error = Job::parse("job.toml", &COMPARED.replacen(from, to, 1)).unwrap_err();
        error.to_string()
    };
    assert_eq!(
        broken("kind = \"rft\"", "kind = \"rtf\""),
        "job.toml line 7: [[models]] unknown kind \"rtf\"; the nearest known is \"rft\""
    );
    assert_eq!(
        broken("kappa = 0.0", "bearing_credit = 0.3"),
        "job.toml line 15: bearing_credit is a parameter of none of quasi_static, rft"
    );
    assert!(broken("[[models]]\nkind = \"rft\"", "[model]\nkind = \"rft\"").contains("exclude each other"));
    let one = "[[models]]\nkind = \"scm\"\n";
    let error = Job::parse("job.toml", one).unwrap_err().to_string();
    assert!(error.contains("takes 2 to 8"), "{error}");
}

const LISTED: &str = "[model]\nkind = \"scm\"\neffects = [\"mine@2\", \"adhesion\", \"yours\"] # why\n";

fn user_effect(named: &str, name: &str, version: i64) -> ServiceEffect {
    ServiceEffect::new(named.to_owned(), name, version, format!("text of {name}"))
}

#[test]
fn effects_of_a_service_become_files_of_the_job() {
    let foreign: Vec<String> = foreign_effects(LISTED).into_iter().collect();
    assert_eq!(foreign, ["mine@2", "yours"]);
    let job = FileSet {
        toml: LISTED.to_owned(),
        ..FileSet::default()
    };
    let effects = [user_effect("mine@2", "mine", 2), user_effect("yours", "yours", 7)];
    let with = with_service_effects("job.toml", job.clone(), &effects).unwrap();
    let expected = "[model]\nkind = \"scm\"\neffects = [ \"adhesion\"] # why\neffect_files = [\"mine@2.toml\", \"yours@7.toml\"]\n";
    assert_eq!(with.toml, expected);
    assert_eq!(with.files["yours@7.toml"], "text of yours");
    let without = without_service_effects("job.toml", LISTED, &effects).unwrap();
    assert_eq!(without.lines().count(), LISTED.lines().count());
    assert_eq!(with_service_effects("job.toml", job, &[]).unwrap().toml, LISTED);
    let again = with_service_effects("job.toml", with, &effects[..1]).unwrap_err();
    assert_eq!(again.to_string(), "job.toml: file \"mine@2.toml\" exists already");
}

const SAMPLED: &str = "# why\n[model]\nkind = \"scm\" # here\n[sampler]\nparticles = 50\nmoves = [2, 4]\nseed = 7\npoint_estimates = [\"ga\", \"lm\"]\n";

#[test]
fn a_point_estimate_has_the_job_s_seed_and_the_usual_settings() {
    let job = Job::parse("job.toml", SAMPLED).unwrap();
    let names: Vec<&str> = job.point_estimates.iter().map(AlgorithmSettings::name).collect();
    assert_eq!(names, ["ga", "lm"]);
    for algorithm in &job.point_estimates {
        let text = point_job("job.toml", &alone(SAMPLED), algorithm).unwrap().toml;
        let derived = Job::parse("job.toml", &text).unwrap();
        assert_eq!((derived.algorithm, derived.algorithm.seed()), (*algorithm, 7));
        assert!(derived.point_estimates.is_empty(), "it has none beside it");
        assert!(
            text.starts_with("# why\n[model]\nkind = \"scm\" # here\n"),
            "{text}"
        );
    }
}

#[test]
fn without_a_seed_the_usual_one_is_the_same_for_all() {
    let job = SAMPLED.replace("seed = 7\n", "");
    let parsed = Job::parse("job.toml", &job).unwrap();
    for algorithm in &parsed.point_estimates {
        let text = point_job("job.toml", &alone(&job), algorithm).unwrap();
        assert_eq!(Job::parse("job.toml", &text.toml).unwrap().algorithm, *algorithm);
    }
}

#[test]
fn what_is_no_point_estimate_is_refused_by_name() {
    for (list, reason) in [
        ("[\"gaa\"]", "[sampler] unknown point estimate \"gaa\""),
        ("[\"tmcmc\"]", "[sampler] unknown point estimate \"tmcmc\""),
        ("[\"lm\", \"lm\"]", "[sampler] point_estimates names lm twice"),
    ] {
        let job = SAMPLED.replace("[\"ga\", \"lm\"]", list);
        let error = Job::parse("job.toml", &job).unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    }
    let job = SAMPLED.replace("particles = 50\nmoves = [2, 4]", "algorithm = \"ga\"");
    let error = Job::parse("job.toml", &job).unwrap_err().to_string();
    assert!(
        error.contains("point_estimates belongs to algorithm tmcmc"),
        "{error}"
    );
}

#[test]
fn the_model_stays_and_what_a_study_would_do_besides_goes() {
    let toml = "[model]\nkind = \"quasi_static\"\neffects = [\"adhesion\"]\n[sampler]\nparticles = 50\nseed = 7\npoint_estimates = [\"ga\"]\n[discovery]\napply = \"auto\"\n";
    let job = FileSet {
        toml: toml.into(),
        files: [("mine.toml".into(), "x".into())].into(),
    };
    let validated = |by_own| {
        let derived = validation_job("job.toml", &job, by_own).unwrap();
        assert_eq!(derived.files, job.files);
        assert!(
            derived.toml.contains("effects = [\"adhesion\"]") && !derived.toml.contains("auto"),
            "{}",
            derived.toml
        );
        Job::parse("job.toml", &derived.toml).unwrap()
    };
    let (fitted, sampled) = (validated(false), validated(true));
    assert!(
        matches!(fitted.algorithm, AlgorithmSettings::Fit(settings) if settings.draws > 0 && settings.seed == 7)
    );
    assert!(matches!(sampled.algorithm, AlgorithmSettings::Sample(settings) if settings.particles == 50));
    assert!(sampled.point_estimates.is_empty());
}

#[test]
fn names_are_added_once_and_nothing_else_changes() {
    let names = ["radius_m", "data_few"].map(str::to_owned);
    let job = "# mine\naccept = [\"data_few\"]\n[model]\nkind = \"scm\" # 3-D\n";
    assert_eq!(
        accepting_job("job.toml", job, &names).unwrap(),
        job.replace("[\"data_few\"]", "[\"data_few\", \"radius_m\"]")
    );
    let without = "# mine\n[model]\nkind = \"scm\"\n";
    let with = accepting_job("job.toml", without, &names).unwrap();
    let table: toml::Table = toml::from_str(&with).unwrap();
    assert_eq!(table["accept"].as_array().unwrap().len(), 2);
    assert_eq!(accepting_job("job.toml", without, &[]).unwrap(), without);
}

/// Everything that a change can change.
fn content(job: &Job) -> impl PartialEq + std::fmt::Debug {
    let priors: Vec<(String, toml::Value)> = job
        .priors
        .iter()
        .map(|entry| (entry.name.clone(), entry.value.clone()))
        .collect();
    (job.model.clone(), priors, job.algorithm, job.named_files())
}

#[test]
fn a_change_of_the_value_is_that_of_the_text() {
    let free = |name: &str| {
        let (prior, _) = PlainParameter::find(name)
            .and_then(PlainParameter::prior)
            .unwrap();
        ModelChange::Free(name.to_owned(), prior.clone())
    };
    let turn = |name: &str| ModelChange::Turn(ModelSwitch::find(name).unwrap());
    let model = "[model]\nkind = \"scm\"\neffects = [\"hard_pan\"]\nflow_fraction = 0.2\ncohesion_pa = 5.0\n";
    for priors in [
        "",
        "[priors]\nn = 1.1\ncohesion_pa = { half_normal = 3.0 }\n",
        "[priors]\nn = 1.1\n[priors.kappa]\nuniform = [0.0, 1.0]\n[priors.log10_p_ref]\nuniform = [4.0, 5.0]\n",
        "[priors]\nkappa.uniform = [0.0, 1.0]\nn = 1.1\n",
        "[priors]\nn = 1.1\nshear_velocity_m_s = 0.002\n",
        "[priors]\nzz = 1.0\nn = { uniform = [0.9, 1.2] }\n\"hard_pan.x\" = 0.5\nhard_pan.y = 0.5\n",
    ] {
        let job = alone(&format!("{model}{priors}"));
        let value = Job::read("job.toml", &job).unwrap();
        for changes in [
            vec![],
            vec![free("cohesion_pa")],
            vec![free("bearing_credit"), turn("displacement_node")],
            vec![turn("kind_quasi_static")],
            vec![turn("pressure_direction_vertical"), free("flow_fraction")],
            vec![turn("shear_velocity_zero")],
        ] {
            let addition = Addition {
                changes,
                ..addition(&[("hard_pan.x.w", "{ half_normal = 25.0 }"), ("a.b", "0.5")])
            };
            let text = extended_job("job.toml", &job, &addition);
            let text = text.and_then(|text| Job::read("job.toml", &text));
            let with = value.with("job.toml", &addition);
            match (&text, &with) {
                (Ok(text), Ok(with)) => assert_eq!(content(text), content(with), "{priors}{addition:?}"),
                (text, with) => assert_eq!(
                    text.as_ref().map(|_| ()).map_err(ToString::to_string),
                    with.as_ref().map(|_| ()).map_err(ToString::to_string),
                    "{priors}{addition:?}"
                ),
            }
        }
        let dropped = ["hard_pan".to_owned()];
        let text = without_effects("job.toml", &job, &dropped).unwrap();
        let text = Job::read("job.toml", &text).unwrap();
        let without = value.without("job.toml", &dropped).unwrap();
        assert_eq!(content(&text), content(&without), "{priors}");
    }
}

#[test]
fn a_metamodel_is_refused_in_a_new_job_and_read_as_moves_in_an_old_one() {
    let job = SAMPLED.replacen(
        "[sampler]\n",
        "[sampler]\nmetamodel_moves = 20 # by quasi_static\n",
        1,
    );
    let line = 1 + job
        .lines()
        .position(|line| line.starts_with("metamodel_moves"))
        .unwrap();
    let error = Job::parse("job.toml", &job).unwrap_err();
    assert_eq!(error.line, Some(line));
    assert!(error.message.contains("stages = \"emulated\""), "{error}");
    let old = without_metamodel("job.toml", &job).unwrap();
    let algorithm = Job::parse("job.toml", &old).unwrap().algorithm;
    assert!(
        matches!(algorithm, AlgorithmSettings::Sample(settings) if settings.stages == StageMethod::Moves)
    );
    // A job that has none stays as it is written.
    assert_eq!(without_metamodel("job.toml", SAMPLED).unwrap(), SAMPLED);
    let off = job.replacen("= 20", "= 0", 1);
    assert_eq!(without_metamodel("job.toml", &off).unwrap(), SAMPLED);
}

#[test]
fn a_candidate_has_its_file_and_stays_where_its_effect_leaves_the_model() {
    let job = FileSet {
        toml: "[model]\nkind = \"scm\"\n".into(),
        ..FileSet::default()
    };
    let mine = "name = \"mine\"\n".to_owned();
    let candidates = [("mine.toml".to_owned(), mine.clone())];
    let with = with_candidates("job.toml", &job, &candidates).unwrap();
    assert_eq!(
        with.toml,
        "[model]\nkind = \"scm\"\n\n[discovery]\ncandidate_files = [\"mine.toml\"]\n"
    );
    assert_eq!(with_candidates("job.toml", &with, &candidates).unwrap(), with);
    // A search goes on with the candidates of its job.
    assert_eq!(continued_job("job.toml", &with).unwrap(), with);
    let addition = |text: &str| Addition {
        files: vec![("mine.toml".into(), NamedFile::new(text.into()))],
        ..Addition::default()
    };
    let extended = extended_job("job.toml", &with, &addition(&mine)).unwrap();
    assert!(
        extended.toml.contains("effect_files = [\"mine.toml\"]"),
        "{}",
        extended.toml
    );
    let other = extended_job("job.toml", &with, &addition("name = \"other\"\n")).unwrap_err();
    assert_eq!(other.to_string(), "job.toml: file \"mine.toml\" exists already");
    let without = without_effects("job.toml", &extended, &["mine".into()]).unwrap();
    assert_eq!(without.files, with.files);
}
