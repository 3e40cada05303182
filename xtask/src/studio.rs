//! `cargo xtask studio`: the studio as one HTML file that opens from a disk, and `<frixel-scene>` as one script, for
//! documents and for the widget of the Python module; with `--site`, both as a site of files for any web server.
//!
//! The WebAssembly module, the scripts, the vendored bundles and the bundled scenes are in each, as far as it uses
//! them, compressed and as text. `host/studio/web/boot.js` unpacks them in the browser.

mod element;
mod page;
mod site;

use std::collections::BTreeMap;
use std::num::NonZeroU64;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use page::Place;
pub(crate) use site::build as build_site;

use crate::command::{self, WASM, absolute, bytes, cargo_in, entries, root, run, target_folder, text, text_of};
use crate::{licences, machine_paths};

/// Cargo profile of the module: small, fast, and without debug information.
const PROFILE: &str = "studio";
/// Iterations of the compression: 15 take three times as long, for 0.01 % of the size.
const ITERATIONS: NonZeroU64 = NonZeroU64::new(5).unwrap();
/// Largest size of the page.
const PAGE_MAX_LEN: usize = 2_000_000;
/// Files of the repository that the page carries, beside its modules: folder, ending, and folder in the page.
const CARRIED: [(&str, &str, &str); 9] = [
    ("host/studio/web", "js", ""),
    ("host/studio/vendor", "js", "vendor/"),
    ("docs/design", "json", "docs/design/"),
    ("scenes", "toml", "scenes/"),
    ("host/studio/web/styles", "css", "styles/"),
    ("scenes/textures", "png", "scenes/textures/"),
    ("scenes/textures", "jpg", "scenes/textures/"),
    ("scenes/fingers", "toml", "scenes/fingers/"),
    ("scenes/screens", "toml", "scenes/screens/"),
];
/// The script that unpacks the files.
const BOOT: &str = "boot.js";
/// The script that turns the element into a widget.
const WIDGET: &str = "host/studio/web/element/widget.js";
/// The module of the widget, in the Python package.
const WIDGET_MODULE: &str = "host/python/python/frixel/widget.js";
/// Folders and files that are not part of the page.
const IGNORED: [&str; 4] = ["node_modules", "entry.js", "chart_entry.js", "widget.js"];
/// The files that a script carries, by their names in it.
type Files = BTreeMap<String, Vec<u8>>;

/// Builds the page and, beside it, the script of `<frixel-scene>`, and the module of the widget into the Python
/// package; returns the page's path.
pub(crate) fn build() -> Result<PathBuf, String> {
    let files = files()?;
    let page = page::of(&files, &Place::File { icon_svg: &text(&root().join(site::ICON))? })?;
    if page.len() > PAGE_MAX_LEN {
        return Err(format!("the page has {} bytes, more than the {PAGE_MAX_LEN} that it may have", page.len()));
    }
    let path = target_folder().join("studio/frixel-studio.html");
    write(&path, page)?;
    write(&path.with_file_name("frixel-scene.js"), element::script(&files)?)?;
    write(&root().join(WIDGET_MODULE), element::script_without_pictures(&files)? + &text(&root().join(WIDGET))?)?;
    absolute(&path)
}

/// Everything that the page carries.
fn files() -> Result<Files, String> {
    let mut files = Files::from([("engine.wasm".to_owned(), module()?)]);
    for (folder, ending, prefix) in CARRIED {
        collect(&root().join(folder), ending, prefix, folder == "host/studio/web", &mut files)?;
    }
    files.insert("licences.txt".to_owned(), licences::text()?.into_bytes());
    files.insert("about.json".to_owned(), about().into_bytes());
    Ok(files)
}

/// Version and commit of the page, as JSON: `commit` is null outside of a checkout, `isChanged` says whether files
/// differ from it.
fn about() -> String {
    let git = |arguments: &[&str]| text_of(Command::new("git").current_dir(root()).args(arguments)).ok();
    let commit = git(&["rev-parse", "--short=12", "HEAD"]).map(|commit| commit.trim().to_owned());
    let is_changed = git(&["status", "--porcelain"]).is_some_and(|files| !files.trim().is_empty());
    serde_json::json!({ "version": env!("CARGO_PKG_VERSION"), "commit": commit, "isChanged": is_changed }).to_string()
}

/// Compiles the WebAssembly module and reads it.
fn module() -> Result<Vec<u8>, String> {
    let build = ["build", "--locked", "--package", "frixel-studio", "--lib", "--profile", PROFILE, "--target", WASM];
    run("studio for WebAssembly", machine_paths::left_out(cargo_in(".").args(build))?)?;
    let module = target_folder().join(WASM).join(PROFILE).join("frixel_studio.wasm");
    machine_paths::check(&module)?;
    bytes(&module)
}

/// Adds the files of a folder with this ending, and of the folders below if `is_deep`.
fn collect(folder: &Path, ending: &str, prefix: &str, is_deep: bool, files: &mut Files) -> Result<(), String> {
    for path in entries(folder)? {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if IGNORED.contains(&name.as_str()) {
            continue;
        }
        if path.is_dir() && is_deep {
            collect(&path, ending, &format!("{prefix}{name}/"), is_deep, files)?;
        } else if path.is_file() && path.extension().is_some_and(|extension| extension == ending) {
            files.insert(format!("{prefix}{name}"), bytes(&path)?);
        }
    }
    Ok(())
}

/// The script that calls `boot` with these arguments, which are JavaScript.
fn boot(files: &Files, arguments: &[&str]) -> Result<String, String> {
    let boot = files.get(BOOT).ok_or("host/studio/web has no boot.js")?;
    Ok(format!("{}boot({});\n", String::from_utf8_lossy(boot), arguments.join(", ")))
}

/// The files, each compressed, as a JSON object.
fn all_packed<'f>(files: impl IntoIterator<Item = (&'f String, &'f Vec<u8>)>) -> Result<serde_json::Value, String> {
    let carried = files.into_iter().filter(|(name, _)| *name != BOOT);
    let packed: serde_json::Map<String, serde_json::Value> =
        carried.map(|(name, content)| Ok((name.clone(), packed(content)?.into()))).collect::<Result<_, String>>()?;
    Ok(serde_json::Value::Object(packed))
}

/// Bytes compressed by gzip, in base64. Zopfli makes files a few per cent smaller than zlib does, and takes seconds, so
/// that a file that several scripts carry is compressed once.
fn packed(content: &[u8]) -> Result<String, String> {
    static PACKED: Mutex<BTreeMap<Vec<u8>, String>> = Mutex::new(BTreeMap::new());
    let mut known = PACKED.lock().map_err(|error| error.to_string())?;
    if let Some(packed) = known.get(content) {
        return Ok(packed.clone());
    }
    let mut zipped = Vec::new();
    let options = zopfli::Options { iteration_count: ITERATIONS, ..zopfli::Options::default() };
    zopfli::compress(options, zopfli::Format::Gzip, content, &mut zipped).map_err(|error| format!("gzip: {error}"))?;
    let packed = STANDARD.encode(zipped);
    known.insert(content.to_vec(), packed.clone());
    Ok(packed)
}

/// Writes a file, and says how large it is.
fn write(path: &Path, content: impl AsRef<[u8]>) -> Result<(), String> {
    command::write(path, &content)?;
    eprintln!("{}: {} bytes", path.display(), content.as_ref().len());
    Ok(())
}
