//! `include`: the other scene files that a scene consists of.

use toml::de::DeValue;

use super::file_kind::FileKind;
use super::files::{FileUnavailable, Files, file_name};
use super::mistake::FileMistake;
use super::nearest::Nearest;
use super::source::{Source, joined};
use super::tables;
use super::toml_text::toml;

/// Largest number of files in a scene.
const FILES_MAX: usize = 64;

/// The files of a scene, and the mistakes of their `include`s, each with its offset.
pub(super) struct Gathered {
    pub(super) source: Source,
    pub(super) mistakes: Vec<(usize, FileMistake)>,
}

/// Reads the files that a scene file includes, recursively. A text that is not TOML includes nothing.
pub(super) fn gather(name: &str, text: &str, files: &dyn Files) -> Gathered {
    let mut gathered = Gathered { source: Source::new(name, text), mistakes: Vec::new() };
    gathered.follow(&mut vec![0], files);
    gathered
}

impl Gathered {
    /// Reads the files included by the last file of a chain, in which each file includes the next one.
    fn follow(&mut self, chain: &mut Vec<usize>, files: &dyn Files) {
        let number = chain.last().copied().unwrap_or_default();
        let Some(file) = self.source.files().get(number).cloned() else { return };
        for (offset, name) in included_names(&file.text) {
            if name.is_empty() {
                let field = tables::scene::INCLUDE.name;
                self.mistakes.push((file.start + offset, FileMistake::NoFileName { field }));
                continue;
            }
            let path = joined(&file.path, &name);
            match self.read(number, &path, chain, files) {
                Ok(included) => {
                    self.source.include(number, included);
                    chain.push(included);
                    self.follow(chain, files);
                    chain.pop();
                }
                Err(mistake) => self.mistakes.push((file.start + offset, mistake)),
            }
        }
    }

    /// Adds the file at `path`, relative to the scene file's folder, which file `number` includes.
    fn read(&mut self, number: usize, path: &str, chain: &[usize], files: &dyn Files) -> Result<usize, FileMistake> {
        let all = self.source.files();
        let file = all.get(number).map_or_else(String::new, |file| file.name.clone());
        let included = match joined(self.source.name(), path) {
            // The folder of the scene itself.
            folder if folder.is_empty() => ".".to_owned(),
            included => included,
        };
        if let Some(known) = all.iter().position(|other| other.path == path) {
            if let Some(first) = chain.iter().position(|number| *number == known) {
                let circle = chain.iter().skip(first).filter_map(|number| all.get(*number));
                return Err(FileMistake::IncludedByItself { circle: circle.map(|file| file.name.clone()).collect() });
            }
            let other = self.source.includer(known).to_owned();
            return Err(FileMistake::IncludedTwice { file, included, other });
        }
        if all.len() >= FILES_MAX {
            return Err(FileMistake::TooManyFiles { max: FILES_MAX });
        }
        let unusable =
            |reason| FileMistake::IncludedUnusable { file: file.clone(), included: included.clone(), reason };
        if path.is_empty() {
            return Err(unusable("it is a folder: name the files in it".to_owned()));
        }
        let bytes = files.bytes(path).map_err(|unavailable| match unavailable {
            FileUnavailable::Unreadable { reason } => unusable(format!("it cannot be read ({reason})")),
            FileUnavailable::Missing { files, .. } => FileMistake::IncludedMissing {
                file: file.clone(),
                included: included.clone(),
                nearest: Nearest::file(file_name(path), &scenes(files)),
            },
        })?;
        FileKind::Scene.check(&bytes).map_err(|wrong| unusable(wrong.to_string()))?;
        let text = String::from_utf8(bytes).map_err(|_| unusable(FileMistake::NotUtf8.to_string()))?;
        Ok(self.source.add(included, path.to_owned(), text))
    }
}

/// Filters file names that may be scenes.
fn scenes(files: Vec<String>) -> Vec<String> {
    files.into_iter().filter(|file| file.rsplit_once('.').is_some_and(|(_, ending)| ending == "toml")).collect()
}

/// The names in a text's `include`, each with its offset.
fn included_names(text: &str) -> Vec<(usize, String)> {
    let Ok(table) = toml(text) else { return Vec::new() };
    let names = table.get(tables::scene::INCLUDE.name).and_then(|value| value.get_ref().as_array());
    let name = |value: &toml::Spanned<DeValue>| Some((value.span().start, value.get_ref().as_str()?.to_owned()));
    names.into_iter().flatten().filter_map(name).collect()
}
