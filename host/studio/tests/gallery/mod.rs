//! The scenes of the gallery as requests of a page.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::Path;

use frixel_studio::Request;

/// A request for each bundled scene, with the bundled textures, in the order of their names.
pub(crate) fn requests(manifest_dir: &Path) -> io::Result<Vec<Request>> {
    let scenes = manifest_dir.join("../../scenes");
    let mut textures = BTreeMap::new();
    for (name, path) in files(&scenes.join("textures"), "png")? {
        textures.insert(format!("textures/{name}"), fs::read(path)?);
    }
    let mut requests = Vec::new();
    for (entry, path) in files(&scenes, "toml")? {
        let mut files = textures.clone();
        files.insert(entry.clone(), fs::read(path)?);
        requests.push(Request { entry, files, ..Request::default() });
    }
    Ok(requests)
}

fn files(folder: &Path, ending: &str) -> io::Result<BTreeMap<String, std::path::PathBuf>> {
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == ending) {
            files.insert(path.file_name().unwrap_or_default().to_string_lossy().into_owned(), path);
        }
    }
    Ok(files)
}
