//! `cargo xtask studio`: the studio as one HTML file that opens from a disk, and `<frixel-scene>` as one script, for
//! documents and for the widget of the Python module.
//!
//! The WebAssembly module, the page's modules, the vendored bundle and the bundled scenes are in each, compressed
//! and as text. `host/studio/web/boot.js` unpacks them in the browser.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use sha2::{Digest, Sha256};

use crate::command::{WASM, cargo_in, root, run, target_folder, text_of};
use crate::{licences, machine_paths};

/// Cargo profile of the module: small, fast, and without debug information.
pub(crate) const PROFILE: &str = "studio";
/// Largest size of the page.
const PAGE_MAX_LEN: usize = 2_000_000;
/// Files of the repository that the page carries, beside its modules: folder, ending, and folder in the page.
pub(crate) const CARRIED: [(&str, &str, &str); 9] = [
    ("host/studio/web", "js", ""),
    ("host/studio/vendor", "js", "vendor/"),
    ("docs", "json", "docs/"),
    ("scenes", "toml", "scenes/"),
    ("host/studio/web/styles", "css", "styles/"),
    ("scenes/textures", "png", "scenes/textures/"),
    ("scenes/textures", "jpg", "scenes/textures/"),
    ("scenes/fingers", "toml", "scenes/fingers/"),
    ("scenes/screens", "toml", "scenes/screens/"),
];
/// The script that unpacks the files.
const BOOT: &str = "boot.js";
/// Module of the element.
const ELEMENT: &str = "element/frixel_scene.js";
/// What makes a widget of the element.
const WIDGET: &str = "host/studio/web/element/widget.js";
/// The module of the widget, in the Python package.
const WIDGET_MODULE: &str = "host/python/python/frixel/widget.js";
/// Folders and files that are no part of the page.
const IGNORED: [&str; 3] = ["node_modules", "entry.js", "widget.js"];

/// Builds the page and, beside it, the script of `<frixel-scene>`, and the module of the widget into the Python package;
/// returns the page's path.
pub(crate) fn build() -> Result<PathBuf, String> {
    let mut files = BTreeMap::from([("engine.wasm".to_owned(), module()?)]);
    for (folder, ending, prefix) in CARRIED {
        collect(&root().join(folder), ending, prefix, folder == "host/studio/web", &mut files)?;
    }
    files.insert("licences.txt".to_owned(), licences::text()?.into_bytes());
    files.insert("about.json".to_owned(), about().into_bytes());
    let web = root().join("host/studio/web");
    let page = page(&text(&web.join("index.html"))?, &web, &files)?;
    if page.len() > PAGE_MAX_LEN {
        return Err(format!("the page has {} bytes, more than the {PAGE_MAX_LEN} that it may have", page.len()));
    }
    let path = target_folder().join("studio/frixel-studio.html");
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let element = element(&files)?;
    let widget = format!("{element}{}", text(&root().join(WIDGET))?);
    let written = [(&path, page), (&folder.join("frixel-scene.js"), element), (&root().join(WIDGET_MODULE), widget)];
    for (path, content) in written {
        fs::write(path, &content).map_err(|error| format!("{}: {error}", path.display()))?;
        eprintln!("{}: {} bytes", path.display(), content.len());
    }
    path.canonicalize().map_err(|error| format!("{}: {error}", path.display()))
}

/// Version and commit of the page, as JSON: `commit` is null outside of a checkout, `isChanged` says whether files differ
/// from it.
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
fn collect(
    folder: &Path,
    ending: &str,
    prefix: &str,
    is_deep: bool,
    files: &mut BTreeMap<String, Vec<u8>>,
) -> Result<(), String> {
    if !folder.is_dir() {
        return Ok(());
    }
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for entry in entries {
        let path = entry.map_err(|error| format!("{}: {error}", folder.display()))?.path();
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

/// Joins the page: styles in place, the packed files, and the script that unpacks them in place of the page's module.
fn page(index: &str, web: &Path, files: &BTreeMap<String, Vec<u8>>) -> Result<String, String> {
    let packed = all_packed(files)?;
    let index = with_styles(index, web)?;
    let (before, entry, behind) = around(&index, "<script type=\"module\" src=\"", "\"></script>")
        .ok_or("index.html has no <script type=\"module\" src=\"...\"></script>")?;
    let boot = boot(files, "JSON.parse(document.getElementById(\"studio-files\").textContent)", entry)?;
    let scripts =
        format!("<script type=\"application/json\" id=\"studio-files\">{packed}</script>\n    <script>{boot}</script>");
    let page = format!("{before}{scripts}{behind}");
    let policy = format!("<meta http-equiv=\"Content-Security-Policy\" content=\"{}\" />", policy(&boot));
    let (before, behind) = page.split_once("<head>").ok_or("index.html has no <head>")?;
    Ok(format!("{before}<head>\n    {policy}{behind}"))
}

/// The script of `<frixel-scene>`, which any document can load. A document that has it already, as one with two widgets,
/// keeps the first.
fn element(files: &BTreeMap<String, Vec<u8>>) -> Result<String, String> {
    let boot = boot(files, &all_packed(files)?.to_string(), ELEMENT)?;
    let title = "// <frixel-scene> of frixel: docs/studio.md says how to use it.";
    Ok(format!("{title}\nif (!globalThis.studio) (() => {{\n{boot}}})();\n"))
}

/// The script that unpacks the files, which a JavaScript expression gives, and starts a module.
fn boot(files: &BTreeMap<String, Vec<u8>>, packed: &str, entry: &str) -> Result<String, String> {
    let boot = files.get(BOOT).ok_or("host/studio/web has no boot.js")?;
    Ok(format!("{}boot({packed}, \"{entry}\");\n", String::from_utf8_lossy(boot)))
}

/// The files, each compressed, as a JSON object.
fn all_packed(files: &BTreeMap<String, Vec<u8>>) -> Result<serde_json::Value, String> {
    let carried = files.iter().filter(|(name, _)| *name != BOOT);
    let packed: serde_json::Map<String, serde_json::Value> =
        carried.map(|(name, content)| Ok((name.clone(), packed(content)?.into()))).collect::<Result<_, String>>()?;
    Ok(serde_json::Value::Object(packed))
}

/// What the page may load: nothing but what it carries, and the bridge of `frixel studio` where it was served by it.
fn policy(boot: &str) -> String {
    let boot = STANDARD.encode(Sha256::digest(boot.as_bytes()));
    format!(
        "default-src 'none'; script-src 'sha256-{boot}' blob: data: 'wasm-unsafe-eval'; worker-src blob:; \
         style-src 'unsafe-inline'; img-src blob: data:; connect-src 'self'; form-action 'none'; base-uri 'none'"
    )
}

/// Puts the style sheets that a page links into it.
fn with_styles(index: &str, web: &Path) -> Result<String, String> {
    let mut page = index.to_owned();
    while let Some((before, name, behind)) = around(&page, "<link rel=\"stylesheet\" href=\"", "\"") {
        let behind = behind.split_once('>').map_or("", |(_, behind)| behind);
        let style = text(&web.join(name))?;
        page = format!("{before}<style>\n{style}</style>{behind}");
    }
    Ok(page)
}

/// What is before the first `start`, between it and the next `end`, and behind that.
fn around<'t>(text: &'t str, start: &str, end: &str) -> Option<(&'t str, &'t str, &'t str)> {
    let (before, rest) = text.split_once(start)?;
    let (within, behind) = rest.split_once(end)?;
    Some((before, within, behind))
}

/// Bytes compressed by gzip, in base64.
fn packed(content: &[u8]) -> Result<String, String> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    let zipped = encoder.write_all(content).and_then(|()| encoder.finish());
    zipped.map(|zipped| STANDARD.encode(zipped)).map_err(|error| format!("gzip: {error}"))
}

fn bytes(path: &Path) -> Result<Vec<u8>, String> {
    fs::read(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn text(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_has_its_files_one_script_and_no_link() {
        let files = BTreeMap::from([
            ("boot.js".to_owned(), b"function boot() {}\n".to_vec()),
            ("main.js".to_owned(), b"import './a.js';".to_vec()),
        ]);
        let index = "<html><head></head><body><script type=\"module\" src=\"main.js\"></script></body></html>";
        let page = page(index, Path::new("."), &files).unwrap();
        let boot = "function boot() {}\nboot(JSON.parse(document.getElementById(\"studio-files\").textContent), \"main.js\");\n";
        assert!(page.contains(&format!("<script>{boot}</script></body>")), "{page}");
        assert!(page.contains("id=\"studio-files\">{\"main.js\":\""), "{page}");
        // The text of `boot` through `openssl dgst -sha256 -binary | base64`.
        assert!(page.contains("'sha256-1z3Ic0gcGekyVFIbB8izxihMTzXEU/j6VaQk3HNGGHE='"), "{page}");
    }
}
