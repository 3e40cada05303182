//! The page: one HTML file that carries all that it needs.

use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};

use super::{Files, all_packed, boot};
use crate::command::{root, text};

const WEB: &str = "host/studio/web";
/// The line of index.html in whose place the icon, and what else a place needs, is put.
const ICON_LINE: &str = "<link rel=\"icon\" href=\"data:,\" />";

/// Files that the page has in place already, or never asks for.
const NOT_PACKED: [&str; 2] = ["styles/", "element/"];

/// Where a page opens from.
pub(super) enum Place<'t> {
    /// A disk: nothing is beside it.
    File { icon_svg: &'t str },
    /// A site, with these lines in its head.
    Site { head: &'t str },
}

/// Joins the page: styles in place, the packed files, and the script that unpacks them in place of the page's module.
pub(super) fn of(files: &Files, place: &Place) -> Result<String, String> {
    let web = root().join(WEB);
    joined(&text(&web.join("index.html"))?, &web, files, place)
}

fn joined(index: &str, web: &Path, files: &Files, place: &Place) -> Result<String, String> {
    let index = with_styles(index, web)?;
    let (before, entry, behind) = around(&index, "<script type=\"module\" src=\"", "\"></script>")
        .ok_or("index.html has no <script type=\"module\" src=\"...\"></script>")?;
    let entry = format!("\"{entry}\"");
    let boot = boot(files, &["JSON.parse(document.getElementById(\"studio-files\").textContent)", &entry])?;
    let packed = all_packed(files.iter().filter(|(name, _)| !NOT_PACKED.iter().any(|start| name.starts_with(start))))?;
    let scripts =
        format!("<script type=\"application/json\" id=\"studio-files\">{packed}</script>\n    <script>{boot}</script>");
    let page = format!("{before}{scripts}{behind}");
    let (head, of_site) = match place {
        Place::File { icon_svg } => {
            let icon = STANDARD.encode(icon_svg);
            (format!("<link rel=\"icon\" href=\"data:image/svg+xml;base64,{icon}\" />"), "")
        }
        Place::Site { head } => ((*head).to_owned(), " 'self'"),
    };
    let (before, behind) = page.split_once(ICON_LINE).ok_or_else(|| format!("index.html has no {ICON_LINE}"))?;
    let page = format!("{before}{head}{behind}");
    let policy = format!("<meta http-equiv=\"Content-Security-Policy\" content=\"{}\" />", policy(&boot, of_site));
    let (before, behind) = page.split_once("<head>").ok_or("index.html has no <head>")?;
    Ok(format!("{before}<head>\n    {policy}{behind}"))
}

/// The content security policy of the page: it loads its own parts, and the manifest, icons and worker of its site.
fn policy(boot: &str, of_site: &str) -> String {
    let boot = STANDARD.encode(Sha256::digest(boot.as_bytes()));
    let manifest = if of_site.is_empty() { " 'none'" } else { of_site };
    format!(
        "default-src 'none'; script-src 'sha256-{boot}' blob: data: 'wasm-unsafe-eval'; worker-src blob:{of_site}; \
         style-src 'unsafe-inline'; img-src blob: data:{of_site}; manifest-src{manifest}; connect-src 'self'; \
         form-action 'none'; base-uri 'none'"
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

/// The text before the first `start`, between it and the next `end`, and behind that.
fn around<'t>(text: &'t str, start: &str, end: &str) -> Option<(&'t str, &'t str, &'t str)> {
    let (before, rest) = text.split_once(start)?;
    let (within, behind) = rest.split_once(end)?;
    Some((before, within, behind))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_has_its_files_one_script_and_no_link() {
        let files = Files::from([
            ("boot.js".to_owned(), b"function boot() {}\n".to_vec()),
            ("main.js".to_owned(), b"import './a.js';".to_vec()),
            ("styles/base.css".to_owned(), b"p {}".to_vec()),
        ]);
        let index = "<html><head><link rel=\"icon\" href=\"data:,\" /></head><body><script type=\"module\" src=\"main.js\"></script></body></html>";
        let page = joined(index, Path::new("."), &files, &Place::File { icon_svg: "" }).unwrap();
        let boot = "function boot() {}\nboot(JSON.parse(document.getElementById(\"studio-files\").textContent), \"main.js\");\n";
        assert!(page.contains(&format!("<script>{boot}</script></body>")), "{page}");
        assert!(page.contains("id=\"studio-files\">{\"main.js\":\"") && !page.contains("base.css"), "{page}");
        // The text of `boot` through `openssl dgst -sha256 -binary | base64`.
        assert!(page.contains("'sha256-1z3Ic0gcGekyVFIbB8izxihMTzXEU/j6VaQk3HNGGHE='"), "{page}");
    }
}
