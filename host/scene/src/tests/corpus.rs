//! Tests the compiler's diagnostics of valid and, above all, invalid scenes: the pages in `tests/corpus`.

use std::collections::BTreeSet;

use frixel_testkit::corpus::{self, Case};

use super::*;
use crate::diagnostic::Message;
use crate::mistake::{FieldMistake, FileMistake, FitMistake, Mistake};
use crate::optimisation::Optimisation;
use crate::warning::Warning;
use crate::{FingerProfile, Profile, Screen};

/// The files of a case, the files shared by all cases, and the scene among them.
struct Inputs {
    name: String,
    text: Vec<u8>,
    files: BTreeMap<String, Vec<u8>>,
}

impl Inputs {
    fn of(case: &Case) -> Self {
        // This character stands for a byte that is not UTF-8.
        let bytes = |text: &String| text.split('\u{fffd}').map(str::as_bytes).collect::<Vec<_>>().join(&0xff);
        let (name, text) = case.files.iter().find(|(name, _)| name.ends_with("scene.toml")).expect("a scene");
        let folder = name.strip_suffix("scene.toml").expect("its folder");
        let beside = |name: &String| name.strip_prefix(folder).unwrap_or(name).to_owned();
        let mut files = PICTURES.clone();
        let brick = &PICTURES["textures/brick.png"];
        files.insert("textures/icon.png".to_owned(), super::pictures::icon());
        files.insert("textures/cut.png".to_owned(), brick[..brick.len() / 2].to_vec());
        files.extend((1..=64).map(|number| (format!("parts/{number}.toml"), b"version = 1\n".to_vec())));
        files.extend(case.files.iter().map(|(name, text)| (beside(name), bytes(text))));
        Self { name: name.clone(), text: bytes(text), files }
    }

    fn scene(&self) -> Result<Scene, CompileError> {
        let scene = Scene::parse(&self.text, &self.name, &self.files);
        if let Ok(text) = str::from_utf8(&self.text) {
            schema::check_agrees(text, mistakes(&scene));
        }
        let profile = |option: &str| self.files.get(option).map(|text| str::from_utf8(text).expect("a text"));
        let mut scene = scene?;
        if let Some(text) = profile("--finger") {
            scene = scene.with_finger(FingerProfile::parse(text, "--finger")?, "--finger");
        }
        if let Some(text) = profile("--screen") {
            scene = scene.with_screen(Screen::parse(text, "--screen")?, "--screen");
        }
        Ok(scene)
    }
}

/// Holds all pages of a folder of `tests/corpus`.
fn hold(folder: &str, mut answer: impl FnMut(&Case) -> String) {
    for page in corpus::pages(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(folder)) {
        corpus::hold(&page, &mut answer);
    }
}

/// The variants covered by a corpus, by name.
#[derive(Default)]
struct Met(BTreeSet<&'static str>);

/// Declares the names of an enum's variants. A variant without a name does not compile.
macro_rules! variants {
    ($name:ident, $all:ident, $type:ident: $($variant:ident)*) => {
        const $all: &[&str] = &[$(concat!(stringify!($type), "::", stringify!($variant))),*];

        fn $name(value: &$type) -> &'static str {
            match value {
                $($type::$variant { .. } => concat!(stringify!($type), "::", stringify!($variant)),)*
            }
        }
    };
}

variants!(field_name, FIELD_MISTAKES, FieldMistake: UnknownField Misplaced MissingField MissingPlace
    BundledFinger WrongType QuotedNumber NotATable NotTables OutOfRange TooLong UnknownChoice NoDefault NoDesign
    LowAboveHigh TwoUnits NotWhole IntervalReversed Law Date EmptyText
    Unprintable NameTooLong Count SpeedsDoNotRise DriftsTooFast ButtonPolygon RepeatInPlace AddedTotal NeedsLive);
variants!(file_name, FILE_MISTAKES, FileMistake: NotUtf8 WrongKind Syntax Version
    UnknownProfile IncludedByItself TooMuch TooManyFiles IncludedTwice IncludedMissing
    IncludedUnusable TableTwice NameTwice FileMissing NoFileName FileUnusable);
variants!(fit_name, FIT_MISTAKES, FitMistake: TooMany OffScreen AboveReach BelowNatural TooManyLayers TickTooLong
    PoolTooSmall PeakAboveBoard CarrierTooFast CurrentAboveBoard ContactWiderThanFinger SoftFinger BeyondLaw Model);
variants!(warning_name, WARNINGS, Warning: ElectricAboveNatural BeyondMeasuredVoltage BeyondMeasuredLoad
    RmsOutOfReach RimWiderThanButton PictureStretched PictureHidden EdgeAcrossScreen EdgeOutsideRegion RidgeCutOff
    HidesAllBelow NameTwice);
variants!(optimisation_name, OPTIMISATIONS, Optimisation: Covered Idle Flat Folded Cropped Shared Bitmap);

impl Met {
    /// Records diagnostics, and formats each as a line.
    fn lines(&mut self, diagnostics: &[Diagnostic]) -> String {
        self.0.extend(diagnostics.iter().filter_map(|diagnostic| match &diagnostic.message {
            Message::Mistake(Mistake::Field(mistake)) => Some(field_name(mistake)),
            Message::Mistake(Mistake::File(mistake)) => Some(file_name(mistake)),
            Message::Mistake(Mistake::Fit(mistake)) => Some(fit_name(mistake)),
            Message::Warning(warning) => Some(warning_name(warning)),
            Message::Optimisation(optimisation) => Some(optimisation_name(optimisation)),
            Message::Mistake(
                Mistake::NothingExpected
                | Mistake::UnknownEvent { .. }
                | Mistake::NameTwice { .. }
                | Mistake::EndsBeforeStart { .. }
                | Mistake::AfterEnd { .. },
            )
            | Message::Note(_) => None,
        }));
        let lines: Vec<String> =
            diagnostics.iter().map(|diagnostic| format!("{} {diagnostic}\n", diagnostic.kind)).collect();
        lines.concat()
    }
}

#[test]
fn every_scene_is_answered_as_its_page_says() {
    let mut met = Met::default();
    hold("check", |case| {
        let inputs = Inputs::of(case);
        let scene = inputs.scene();
        let compiled = scene.and_then(|scene| {
            let compiled = compile(&scene, &LIMITS, TICK_HZ);
            check_draft(&compiled, compile_draft(&scene, &LIMITS, TICK_HZ));
            compiled
        });
        met.lines(&compiled.map_or_else(|error| error.diagnostics, |program| program.diagnostics))
    });
    let all = [FIELD_MISTAKES, FILE_MISTAKES, FIT_MISTAKES, WARNINGS, OPTIMISATIONS].concat();
    let missing: Vec<&str> = all.into_iter().filter(|name| !met.0.contains(name)).collect();
    assert!(missing.is_empty(), "no page of tests/corpus has a case for {missing:?}");
}
