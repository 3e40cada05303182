//! The crates that others use, as cargo would publish them.

use serde_json::Value;

use crate::command::{cargo_in, remove, run, target_folder, text_of};

/// Packages every published crate, and compiles each from its package alone, with the others from theirs.
pub(crate) fn check() -> Result<(), String> {
    let published = published()?;
    let names = published.iter().filter_map(|manifest| manifest["name"].as_str());
    let names: Vec<&str> = names.flat_map(|name| ["--package", name]).collect();
    // Cargo keeps what it unpacked and compiled of a version, and takes it again from a folder of the same name.
    let target = target_folder().join(format!("packages-{}", std::process::id()));
    let mut package = cargo_in(".");
    // What is checked is the working tree, committed or not.
    package.args(["package", "--locked", "--allow-dirty", "--target-dir"]).arg(&target).args(names);
    let checked = run("packages", &mut package);
    remove(&target)?;
    checked
}

/// The manifests of the crates that are published, as cargo reports them.
fn published() -> Result<Vec<Value>, String> {
    let metadata = text_of(cargo_in(".").args(["metadata", "--locked", "--no-deps", "--format-version", "1"]))?;
    let metadata: Value = serde_json::from_str(&metadata).map_err(|error| format!("cargo metadata: {error}"))?;
    let packages = metadata["packages"].as_array().ok_or("cargo metadata lists no packages")?;
    // `publish = false` is an empty list of registries.
    let is_published = |manifest: &&Value| manifest["publish"].as_array().is_none_or(|to| !to.is_empty());
    Ok(packages.iter().filter(is_published).cloned().collect())
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::{Component, Path, PathBuf};

    use super::*;
    use crate::command::{files_below, root};

    fn name(manifest: &Value) -> &str {
        manifest["name"].as_str().unwrap()
    }

    fn folder(manifest: &Value) -> PathBuf {
        Path::new(manifest["manifest_path"].as_str().unwrap()).parent().unwrap().to_owned()
    }

    /// Crates.io shows the first three. The licences are in the package, for users who have nothing else.
    #[test]
    fn a_published_crate_says_what_it_is_and_has_its_licences() {
        for package in published().unwrap() {
            let text = |key: &str| package[key].as_str().unwrap_or_default().to_owned();
            for key in ["description", "license", "readme"] {
                assert!(!text(key).is_empty(), "{} has no {key}", name(&package));
            }
            assert!(folder(&package).join(text("readme")).is_file(), "{} has no readme", name(&package));
            for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
                let [own, all] =
                    [folder(&package), root()].map(|folder| fs::read(folder.join(licence)).unwrap_or_default());
                assert!(
                    !own.is_empty() && own == all,
                    "{} has no {licence}: link it to that of the root",
                    name(&package)
                );
            }
        }
    }

    /// What a dependency is taken from, where there is no checkout.
    #[test]
    fn a_published_crate_depends_on_versions() {
        for package in published().unwrap() {
            for dependency in package["dependencies"].as_array().unwrap() {
                let is_compiled = dependency["kind"].as_str() != Some("dev");
                let has_version = dependency["req"].as_str() != Some("*");
                assert!(!is_compiled || has_version, "{}: {} has no version", name(&package), dependency["name"]);
            }
        }
    }

    fn is_test(file: &Path) -> bool {
        file.ends_with("tests.rs") || file.components().any(|part| part.as_os_str() == "tests")
    }

    /// A package has its own folder only. Files of other folders are linked into it.
    #[test]
    fn a_published_crate_includes_only_files_of_its_own() {
        let mut included = 0;
        for package in published().unwrap() {
            let files = files_below(&folder(&package).join("src")).unwrap();
            for file in files.iter().filter(|file| file.extension().is_some_and(|end| end == "rs") && !is_test(file)) {
                let text = fs::read_to_string(file).unwrap();
                for part in text.split("include_").skip(1).filter_map(|part| part.split_once("!(\"")) {
                    let path = part.1.split('"').next().unwrap();
                    let ups = Path::new(path).components().filter(|part| *part == Component::ParentDir).count();
                    let depth = file.strip_prefix(folder(&package)).unwrap().components().count() - 1;
                    assert!(ups <= depth, "{}: {path} is not in the package", file.display());
                    included += 1;
                }
            }
        }
        assert_ne!(included, 0, "no file is included");
    }
}
