//! The screen and the finger of a scene: embedded in its file, named by it, or the examples.

use super::fields::{Fields, TableOrText};
use super::files::Files;
use super::finger::{self, FingerProfile};
use super::grammar::FieldSpec;
use super::log::Log;
use super::mistake::FileMistake;
use super::nearest::Nearest;
use super::profile::Profile;
use super::screen::{self, Screen};
use super::tables;

/// Origin of a scene's screen or finger, in order of precedence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ProfileSource {
    /// Given beside the scene, from this file or under this bundled name.
    Option(String),
    /// The scene names this file or bundled profile.
    Named(String),
    /// A table of the scene file.
    Embedded,
    /// The scene has no such field: the example is used.
    Example,
}

/// Screen and finger of a scene.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Profiles {
    pub(super) screen: Screen,
    pub(super) screen_source: ProfileSource,
    pub(super) finger: FingerProfile,
    pub(super) finger_source: ProfileSource,
    /// Offset in the scene file for mistakes that concern both.
    pub(super) place: usize,
}

/// Reads `screen` and `finger` of a scene: tables, names, or nothing.
pub(super) fn read(fields: &mut Fields, files: &dyn Files, log: &mut Log) -> Option<Profiles> {
    let (screen_place, finger_place) = (fields.place("screen"), fields.place("finger"));
    let screen = ProfileField { field: &tables::scene::SCREEN, table: screen::read, example: Screen::example };
    let finger = ProfileField { field: &tables::scene::FINGER, table: finger::read, example: FingerProfile::example };
    let has_finger = fields.has("finger");
    let screen = screen.read(fields, files, log);
    let finger = finger.read(fields, files, log);
    let ((screen, screen_source), (finger, finger_source)) = screen.zip(finger)?;
    let place = if has_finger { finger_place } else { screen_place };
    Some(Profiles { screen, screen_source, finger, finger_source, place })
}

/// Where one of the two stands in a scene file.
struct ProfileField<P> {
    field: &'static FieldSpec,
    /// Reads it from a table of the scene.
    table: fn(Fields, &mut Log) -> Option<P>,
    /// The default of a scene without one.
    example: fn() -> P,
}

impl<P: Profile> ProfileField<P> {
    fn read(&self, fields: &mut Fields, files: &dyn Files, log: &mut Log) -> Option<(P, ProfileSource)> {
        if !fields.has(self.field.name) {
            // The field is known even if it is absent.
            let _ = fields.table_or_text(log, self.field);
            return Some(((self.example)(), ProfileSource::Example));
        }
        let place = fields.place(self.field.name);
        match fields.table_or_text(log, self.field)? {
            TableOrText::Table(table) => (self.table)(*table, log).map(|profile| (profile, ProfileSource::Embedded)),
            TableOrText::Text(name) => match named(&path_of(&name, place, log), files) {
                Ok(profile) => Some((profile, ProfileSource::Named(name))),
                Err(mistake) => {
                    log.add(place, mistake);
                    None
                }
            },
        }
    }
}

/// The bundled profile of a name, or the profile in a file.
fn named<P: Profile>(name: &str, files: &dyn Files) -> Result<P, FileMistake> {
    let what = P::KIND.word();
    if !is_file_name(name) {
        return P::bundled(name).ok_or_else(|| FileMistake::UnknownProfile {
            what,
            found: name.to_owned(),
            nearest: Nearest::new(name, P::bundled_names()),
        });
    }
    let unusable = |reason: String| FileMistake::FileUnusable { what, file: name.to_owned(), reason };
    let bytes = files.bytes(name).map_err(|unavailable| FileMistake::unavailable(what, name, &unavailable))?;
    P::parse(bytes, name).map_err(|mistakes| unusable(mistakes.to_string().replace('\n', "; ")))
}

/// The path of a file named at an offset, relative to the scene file's folder, or the name of a bundled profile.
fn path_of(name: &str, offset: usize, log: &Log) -> String {
    if is_file_name(name) { log.source().path_at(offset, name) } else { name.to_owned() }
}

/// Whether a name is a file name. Bundled names are plain words.
pub(super) fn is_file_name(name: &str) -> bool {
    name.contains(['.', '/', '\\'])
}
