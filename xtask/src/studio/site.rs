//! `cargo xtask studio --site FOLDER [ADDRESS]`: page, `<frixel-scene>` and gallery as files for any web server.
//!
//! | file | what |
//! |---|---|
//! | `index.html` | the page |
//! | `frixel-scene.module.js`, `scenes/textures` | the element as an ES module, and the pictures that it reads from beside it |
//! | `gallery/index.html` | the bundled scenes in a document with the element |
//! | `service-worker.js` | keeps all of these, so that the page opens without a network from the second visit on |
//! | `manifest.webmanifest`, `icon*` | what a tablet needs to install the page |
//! | `preview.png` | the picture that others show beside a link |

use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};

use super::page::{self, Place};
use super::{Files, element, files};
use crate::command::{bytes, empty_folder, root, text, write};

const SOURCES: &str = "host/studio/site";
pub(super) const ICON: &str = "host/studio/site/icon.svg";
/// Files of the site that are copied as they are.
const COPIED: [(&str, &str); 5] = [
    ("host/studio/site/manifest.webmanifest", "manifest.webmanifest"),
    (ICON, "icon.svg"),
    ("host/studio/site/icon-192.png", "icon-192.png"),
    ("host/studio/site/icon-512.png", "icon-512.png"),
    ("docs/design/studio/play.png", PREVIEW),
];
const PREVIEW: &str = "preview.png";
const MODULE: &str = "frixel-scene.module.js";
const WORKER: &str = "service-worker.js";
/// The script line of docs/design/gallery/index.html, and that of the site.
const GALLERY_SCRIPT: (&str, &str) = (
    "<script\n      src=\"../../../target/studio/frixel-scene.js\"",
    "<script\n      type=\"module\"\n      src=\"../frixel-scene.module.js\"",
);
const TITLE: &str = "frixel studio";
const DESCRIPTION: &str = "Slide over a screen that pushes back: the firmware of a friction display, in your browser.";

/// Makes the folder, which must be empty or new. Links to the site show its picture if the site's `address` is given.
pub(crate) fn build(folder: &str, address: Option<&str>) -> Result<(), String> {
    let address = address.map(checked).transpose()?;
    let folder = empty_folder(folder)?;
    let site = site(&files()?, address.as_deref())?;
    for (name, content) in &site {
        write(&folder.join(name), content)?;
    }
    println!("{}", folder.display());
    Ok(())
}

/// The address with a slash at its end.
fn checked(address: &str) -> Result<String, String> {
    if !address.starts_with("https://") && !address.starts_with("http://") || address.contains(['"', '<', '>']) {
        return Err(format!("expected the site's address, such as https://example.org/frixel/, found `{address}`"));
    }
    Ok(format!("{}/", address.trim_end_matches('/')))
}

/// The files of the site, by their names in it.
fn site(carried: &Files, address: Option<&str>) -> Result<Files, String> {
    let head = head(address);
    let mut site = Files::from([
        ("index.html".to_owned(), page::of(carried, &Place::Site { head: &head })?.into_bytes()),
        (MODULE.to_owned(), element::module(carried)?.into_bytes()),
    ]);
    site.extend(element::pictures(carried).map(|(name, content)| (name.clone(), content.clone())));
    for (from, name) in COPIED {
        site.insert(name.to_owned(), bytes(&root().join(from))?);
    }
    gallery(&root().join("docs/design/gallery"), &mut site)?;
    let worker = worker(&site)?;
    site.insert(WORKER.to_owned(), worker.into_bytes());
    Ok(site)
}

/// The lines in the head of the site's page that replace the icon's line.
fn head(address: Option<&str>) -> String {
    let mut lines = vec![
        "<link rel=\"icon\" href=\"icon.svg\" type=\"image/svg+xml\" />".to_owned(),
        "<link rel=\"apple-touch-icon\" href=\"icon-192.png\" />".to_owned(),
        "<link rel=\"manifest\" href=\"manifest.webmanifest\" />".to_owned(),
        format!("<meta name=\"description\" content=\"{DESCRIPTION}\" />"),
        format!("<meta property=\"og:title\" content=\"{TITLE}\" />"),
        format!("<meta property=\"og:description\" content=\"{DESCRIPTION}\" />"),
        "<meta name=\"twitter:card\" content=\"summary_large_image\" />".to_owned(),
    ];
    // The protocol of such previews takes whole addresses only (https://ogp.me).
    lines.extend(address.into_iter().flat_map(|address| {
        [
            format!("<meta property=\"og:url\" content=\"{address}\" />"),
            format!("<meta property=\"og:image\" content=\"{address}{PREVIEW}\" />"),
        ]
    }));
    lines.join("\n    ")
}

/// Adds the document with all bundled scenes.
fn gallery(folder: &Path, site: &mut Files) -> Result<(), String> {
    let (here, there) = GALLERY_SCRIPT;
    let document = text(&folder.join("index.html"))?;
    if !document.contains(here) {
        return Err(format!("docs/design/gallery/index.html does not have the script as expected: {here}"));
    }
    site.insert("gallery/index.html".to_owned(), document.replacen(here, there, 1).into_bytes());
    super::collect(folder, "png", "gallery/", false, site)
}

/// The service worker, with the names of all files of the site in front. A change of any of them makes another version.
fn worker(site: &Files) -> Result<String, String> {
    let mut digest = Sha256::new();
    for (name, content) in site {
        digest.update(name);
        digest.update(content);
    }
    let version = STANDARD.encode(digest.finalize());
    // A server gives the documents by the names of their folders, and may redirect from their own.
    let address = |name| match str::strip_suffix(name, "index.html") {
        Some("") => "./",
        Some(folder) => folder,
        None => name,
    };
    let names: Vec<&str> = site.keys().map(|name| address(name)).collect();
    let facts = serde_json::json!({ "version": version, "files": names });
    Ok(format!("const SITE = {facts};\n{}", text(&root().join(SOURCES).join("service_worker.js"))?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_preview_needs_the_whole_address() {
        assert!(!head(None).contains("og:image"));
        let head = head(Some(&checked("https://example.org/frixel").unwrap()));
        assert!(head.contains("content=\"https://example.org/frixel/preview.png\""), "{head}");
        assert!(checked("example.org").unwrap_err().contains("https://example.org/frixel/"));
    }

    #[test]
    fn a_changed_file_makes_another_version() {
        let before = Files::from([("a".to_owned(), vec![1])]);
        let after = Files::from([("a".to_owned(), vec![2])]);
        assert_ne!(worker(&before).unwrap(), worker(&after).unwrap());
    }
}
