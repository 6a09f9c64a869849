//! An experiment in which typical values replace properties that its files leave unstated.

use shared::experiment::Experiment;
use shared::file::{FileError, FileSet};
use toml_edit::{DocumentMut, Item, Table, TableLike, value};

/// Bulk density of dry sand between loose and dense `[kg/m^3]`.
const DENSITY_KG_M3: f64 = 1500.0;
/// Length of the source paper's bin `[m]`.
const BIN_LENGTH_M: f64 = 1.5;
/// Grousers of rover wheels: 12 of 0.07 R to 24 of 0.09 R.
const GROUSERS: i64 = 16;
const GROUSER_HEIGHT: f64 = 0.08;
/// Thickness of the grousers; no effect of `quasi_static` depends on it.
const GROUSER_THICKNESS: f64 = 0.016;

/// A property of the test site that an experiment may leave unstated and effects may need.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SiteProperty {
    /// Density of a soil.
    Density,
    /// Grousers of a wheel.
    Grousers,
    /// Length of the bin.
    BinLength,
}

/// A property that the experiment leaves unstated.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnstatedProperty {
    /// The property.
    pub property: SiteProperty,
    /// A sentence that names the unstated property and its assumed value.
    pub why: String,
    /// The line of the experiment that would state the property.
    pub needs: String,
}

/// An experiment in which typical values replace properties that its files leave unstated.
#[derive(Debug, Clone)]
pub struct AssumedExperiment {
    /// The experiment with those values.
    pub experiment: Experiment,
    /// The properties that have typical values.
    pub unstated: Vec<UnstatedProperty>,
}

impl AssumedExperiment {
    /// States the density of the runs' soil, the grousers of every wheel and the length of the bin if the experiment does not.
    ///
    /// A wheel with `grouser_count = 0` is smooth and stays so, as does a surface mesh. A model that rolls grousers rolls those that are
    /// declared: for it, they are never assumed.
    ///
    /// # Arguments
    /// - `files`, `experiment`: the experiment as texts, which say what it states, and as a value.
    /// - `is_smooth`: whether the model rolls smooth rims, whatever grousers are declared.
    ///
    /// # Errors
    /// [`FileError`] if the files are not an experiment.
    pub fn new(
        name: &str,
        files: &FileSet,
        experiment: &Experiment,
        is_smooth: bool,
    ) -> Result<Self, FileError> {
        let mut document: DocumentMut = files
            .toml
            .parse()
            .map_err(|e: toml_edit::TomlError| FileError::whole(name, e.to_string()))?;
        let mut unstated = Vec::new();
        for (soil, properties) in &experiment.soils {
            if properties.density_kg_m3.is_none()
                && experiment.runs.iter().any(|run| run.soil == *soil)
                && let Some(table) = table(document.get_mut("soil"), soil)
            {
                table.insert("density_kg_m3", value(DENSITY_KG_M3));
                unstated.push(UnstatedProperty {
                    property: SiteProperty::Density,
                    why: format!(
                        "the density of soil {soil} is not stated; {DENSITY_KG_M3} kg/m^3 is assumed"
                    ),
                    needs: format!("density_kg_m3 under [soil.{soil}]"),
                });
            }
        }
        for (wheel, geometry) in &experiment.wheels {
            if !is_smooth || geometry.mesh.is_some() {
                continue;
            }
            if let Some(table) = table(document.get_mut("wheel"), wheel)
                && !table.contains_key("grouser_count")
                && !table.contains_key("grouser_height_m")
            {
                let height_m = GROUSER_HEIGHT * geometry.radius_m;
                table.insert("grouser_count", value(GROUSERS));
                table.insert("grouser_height_m", value(height_m));
                table.insert(
                    "grouser_thickness_m",
                    value(GROUSER_THICKNESS * geometry.radius_m),
                );
                unstated.push(UnstatedProperty {
                    property: SiteProperty::Grousers,
                    why: format!(
                        "the grousers of wheel {wheel} are not stated; {GROUSERS} of {:.1} mm are assumed",
                        1e3 * height_m
                    ),
                    needs: format!(
                        "grouser_count and grouser_height_m under [wheel.{wheel}] (grouser_count = 0: a smooth rim)"
                    ),
                });
            }
        }
        if experiment.rig.bin_length_m.is_none()
            && let Some(rig) = document
                .entry("rig")
                .or_insert(Item::Table(Table::new()))
                .as_table_like_mut()
        {
            rig.insert("bin_length_m", value(BIN_LENGTH_M));
            unstated.push(UnstatedProperty {
                property: SiteProperty::BinLength,
                why: format!("the length of the bin is not stated; {BIN_LENGTH_M} m is assumed"),
                needs: "bin_length_m under [rig]".into(),
            });
        }
        let files = FileSet {
            toml: document.to_string(),
            files: files.files.clone(),
        };
        Ok(Self {
            experiment: Experiment::parse(name, &files)?,
            unstated,
        })
    }
}

fn table<'d>(tables: Option<&'d mut Item>, name: &str) -> Option<&'d mut dyn TableLike> {
    tables?.as_table_like_mut()?.get_mut(name)?.as_table_like_mut()
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.a]\nradius_m = 0.1\nwidth_m = 0.1\n\
        [wheel.b]\nradius_m = 0.1\nwidth_m = 0.1\ngrouser_count = 0\n\
        [soil.s]\n[soil.t]\n[noise]\ndrawbar_pull_n = 1.0\n";
    const RUNS: &str = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,use\n\
        1,a,s,0.2,100,0.01,20,fit\n2,b,s,0.2,100,0.01,20,fit\n";

    fn assumed(is_smooth: bool) -> (Experiment, Vec<UnstatedProperty>) {
        let files = FileSet {
            toml: EXPERIMENT.into(),
            files: [("runs.csv".to_owned(), RUNS.to_owned())].into(),
        };
        let stated = Experiment::parse("experiment.toml", &files).unwrap();
        let assumed = AssumedExperiment::new("experiment.toml", &files, &stated, is_smooth).unwrap();
        (assumed.experiment, assumed.unstated)
    }

    #[test]
    fn what_is_stated_stays_and_the_rest_is_assumed() {
        let (with, unstated) = assumed(true);
        assert_eq!(with.soils["s"].density_kg_m3, Some(DENSITY_KG_M3));
        // no run is in it
        assert_eq!(with.soils["t"].density_kg_m3, None);
        assert_eq!(
            (with.wheels["a"].grouser_count, with.wheels["b"].grouser_count),
            (16, 0)
        );
        let needs: Vec<&str> = unstated.iter().map(|u| u.needs.as_str()).collect();
        assert_eq!(needs[0], "density_kg_m3 under [soil.s]");
        assert!(
            needs[1].contains("[wheel.a] (grouser_count = 0: a smooth rim)"),
            "{needs:?}"
        );
        assert_eq!(needs[2..], ["bin_length_m under [rig]"]);
    }

    #[test]
    fn a_wheel_whose_grousers_roll_is_as_it_is_declared() {
        let (with, unstated) = assumed(false);
        assert_eq!(with.wheels["a"].grouser_count, 0);
        assert!(unstated.iter().all(|u| u.property != SiteProperty::Grousers));
    }
}
