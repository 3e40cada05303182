//! The cells of a plan, each made from its number when it is needed.

use std::collections::BTreeMap;
use std::mem;

use frixel_hil_sim::TouchConfig;
use frixel_scene::{FileKind, NamedProfile, Profile, Screen, SharedFiles};
use serde::{Deserialize, Serialize};

use super::parameter::with_fields;
use super::plan::Places;
use super::{Cell, CellError, Plan, PlanError, json};
use crate::hash::sha256;

/// Digits of a hash that make a key.
const KEY_DIGITS: usize = 32;

/// A scene file with the files that it names.
#[derive(Clone, Debug)]
pub struct Source {
    name: String,
    text: String,
    files: SharedFiles,
    sha256: String,
}

impl Source {
    /// A scene of this name and text, which names these files.
    pub fn new(name: &str, text: String, files: BTreeMap<String, Vec<u8>>) -> Self {
        let hashes: BTreeMap<&String, String> = files.iter().map(|(name, bytes)| (name, sha256(bytes))).collect();
        let sha256 = sha256(json(&(&text, hashes)).as_bytes());
        Self { name: name.to_owned(), text, files: files.into(), sha256 }
    }
}

/// A plan with hashes of the scenes that it names: the data on which the keys of its cells depend.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Index {
    /// Version of frixel. Results may differ between versions.
    version: String,
    plan: Plan,
    /// SHA-256 of each scene with its files.
    scenes: Vec<String>,
    screens: Vec<NamedProfile>,
    touch: Vec<NamedProfile>,
}

impl Index {
    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.plan.cells()
    }

    /// The key of a cell: equal for equal cells, and different for different ones.
    pub fn key(&self, number: usize) -> String {
        let Self { version, plan, scenes, screens, touch } = self;
        let place = plan.place(number);
        let strokes = (plan.stroke, plan.strokes, plan.seeds, plan.seconds, plan.median_speed_mm_per_s, plan.ideal);
        let scene = (plan.scenes.get(place.scene), scenes.get(place.scene), &place.parameters);
        let world = (screens.get(place.screen), touch.get(place.touch), place.person);
        let mut digits = sha256(json(&(version, scene, world, strokes)).as_bytes());
        digits.truncate(KEY_DIGITS);
        digits
    }
}

/// A plan with the contents of all files that it names.
#[derive(Clone, Debug)]
pub struct Sweep {
    index: Index,
    scenes: Vec<Source>,
    places: Places,
}

impl Sweep {
    /// Reads the files of a plan. `scene` reads a scene file with the files that it names, and `text` the file of a
    /// screen or a touch source, each by the name that the plan has for it.
    pub fn new<E>(
        mut plan: Plan,
        scene: impl Fn(&str) -> Result<Source, E>,
        text: impl Fn(FileKind, &str) -> Result<String, E>,
    ) -> Result<Self, E> {
        let places = mem::take(&mut plan.places);
        let scenes: Vec<Source> = plan.scenes.iter().map(|name| scene(name)).collect::<Result<_, _>>()?;
        let index = Index {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scenes: scenes.iter().map(|scene| scene.sha256.clone()).collect(),
            screens: named::<Screen, E>(&plan.screens, &text)?,
            touch: named::<TouchConfig, E>(&plan.touch, &text)?,
            plan,
        };
        Ok(Self { index, scenes, places })
    }

    /// The keys of the cells.
    pub fn index(&self) -> &Index {
        &self.index
    }

    /// Subject of a cell's error, after the plan's line of the parameter at fault, if any.
    pub fn blame(&self, cell: &Cell, error: &CellError) -> String {
        let place = cell.blamed(error).map_or(String::new(), |path| self.places.of_parameter(path) + ": ");
        place + &cell.subject(error)
    }

    /// The numbers of a few cells that have each scene, screen and touch source, each value of a list, and both ends of
    /// a range. A mistake in one of these is found before anything is played; one in a combination when it is played.
    pub fn samples(&self) -> Vec<usize> {
        self.index.plan.samples()
    }

    /// A cell by its number, from 0, in the order of the lists: people vary fastest.
    pub fn cell(&self, number: usize) -> Result<Cell, PlanError> {
        let Index { version, plan, screens, touch, .. } = &self.index;
        let place = plan.place(number);
        let (Some(scene), Some(touch)) = (self.scenes.get(place.scene), touch.get(place.touch)) else {
            return Err(PlanError(format!("the plan has no cell {number}")));
        };
        Ok(Cell {
            key: self.index.key(number),
            version: version.clone(),
            scene: scene.name.clone(),
            text: with_fields(&scene.text, &scene.name, &place.parameters, &self.places)?,
            parameters: place.parameters,
            files: scene.files.clone(),
            screen: screens.get(place.screen).cloned(),
            touch: touch.clone(),
            person: place.person,
            stroke: plan.stroke,
            strokes: plan.strokes,
            seeds: plan.seeds,
            seconds: plan.seconds,
            median_speed_mm_per_s: plan.median_speed_mm_per_s,
            ideal: plan.ideal,
        })
    }
}

/// The profiles that a plan names. A bundled one needs no file; `text` reads the files of the others.
fn named<P: Profile, E>(
    names: &[String],
    text: impl Fn(FileKind, &str) -> Result<String, E>,
) -> Result<Vec<NamedProfile>, E> {
    let named = |name: &String| {
        let text = if P::bundled(name).is_some() { None } else { Some(text(P::KIND, name)?) };
        Ok(NamedProfile { name: name.clone(), text })
    };
    names.iter().map(named).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::sweep::Value;

    const SCENE: &str = "version = 1\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\n";
    const PLAN: &str = "scenes = [\"a\", \"b\"]\ntouch = [\"100\", \"200\"]\npeople = 3\n[parameters]\n\
                        \"drive.voltage_max_v_rms\" = [100, 120, 150]\n\
                        \"layer.1.friction_fraction\" = { from = 0, to = 1, count = 5 }\n";

    fn sweep(plan: &str, scene: &str) -> Sweep {
        let source = |name: &str| Ok(Source::new(name, scene.to_owned(), BTreeMap::new()));
        Sweep::new(Plan::parse(plan, "plan.toml").unwrap(), source, |_, _| Err(())).unwrap()
    }

    fn keys(sweep: &Sweep) -> BTreeSet<String> {
        (0..sweep.index().cells()).map(|number| sweep.index().key(number)).collect()
    }

    #[test]
    fn every_number_is_another_combination_in_the_order_of_the_lists() {
        let sweep = sweep(PLAN, SCENE);
        let cells: Vec<Cell> = (0..sweep.index().cells()).map(|number| sweep.cell(number).unwrap()).collect();
        assert_eq!((cells.len(), keys(&sweep).len()), (2 * 2 * 3 * 3 * 5, 180));
        let places = cells.iter().map(|cell| {
            let values: Vec<f64> = cell.parameters.values().filter_map(Value::number).collect();
            (&cell.scene, values, &cell.touch.name, cell.person)
        });
        assert!(places.is_sorted());
        let last = cells.last().unwrap();
        assert!(last.text.contains("friction_fraction = 1.0\n") && last.text.contains("voltage_max_v_rms = 150"));
        assert!(sweep.cell(180).is_err());
    }

    #[test]
    fn samples_have_every_listed_value_and_the_ends_of_ranges() {
        let sweep = sweep(PLAN, SCENE);
        let cells: Vec<Cell> = sweep.samples().into_iter().map(|number| sweep.cell(number).unwrap()).collect();
        assert_eq!(cells.len(), 2 * (1 + 1 + 2 + 1));
        for path in ["drive.voltage_max_v_rms", "layer.1.friction_fraction"] {
            let values: BTreeSet<String> = cells.iter().map(|cell| cell.parameters[path].to_string()).collect();
            let expected = if path.starts_with("drive") { ["100", "120", "150"].as_slice() } else { &["0", "1"] };
            assert!(values.iter().eq(expected), "{values:?}");
        }
        assert!(cells.iter().all(|cell| cell.person == 1));
        assert!(cells.iter().any(|cell| cell.touch.name == "200") && cells.iter().any(|cell| cell.scene == "b"));
    }

    /// A longer list has the keys of the shorter one; another scene, duration or touch source has none of them.
    #[test]
    fn a_key_is_that_of_a_content() {
        let before = keys(&sweep(PLAN, SCENE));
        let shared = |plan: &str, scene: &str| keys(&sweep(plan, scene)).intersection(&before).count();
        assert_eq!(shared(&PLAN.replace("people = 3", "people = 5").replace("[100,", "[90, 100,"), SCENE), 180);
        assert_eq!(shared(&PLAN.replace("people = 3", "people = 3\nseconds = 2"), SCENE), 0);
        assert_eq!(shared(&PLAN.replace("\"100\", \"200\"", "\"500\""), SCENE), 0);
        assert_eq!(shared(PLAN, &SCENE.replace("0.5", "0.4")), 0);
        let index = sweep(PLAN, SCENE).index().clone();
        assert_eq!(serde_json::from_str::<Index>(&json(&index)).unwrap(), index, "as plan.json has it");
    }
}
