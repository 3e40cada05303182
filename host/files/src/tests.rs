use std::cell::RefCell;
use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::*;

thread_local! {
    /// The folders whose names were put on the disk, in this order.
    pub(crate) static SYNCED: RefCell<Vec<PathBuf>> = const { RefCell::new(Vec::new()) };
}

struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The output of this name, where there is an earlier file if it has a text.
    fn output(&self, name: &str, earlier: &str) -> OutputFile {
        if !earlier.is_empty() {
            fs::write(self.path(name), earlier).unwrap();
        }
        OutputFile::new(&self.path(name), "-o", &Inputs::default()).unwrap()
    }

    fn text(&self, name: &str) -> Option<String> {
        fs::read_to_string(self.path(name)).ok()
    }

    fn count(&self) -> usize {
        fs::read_dir(self.0.path()).unwrap().count()
    }
}

fn recording(path: &Path, overwrites: bool) -> OutputFile {
    OutputFile::recording(path, "-o", &Inputs::default(), overwrites).unwrap()
}

#[test]
fn lines_are_appended_behind_the_whole_ones() {
    let folder = Folder::new();
    let output = folder.output("lines", "one\ntwo\nthr");
    let append = |waits: &mut dyn FnMut()| {
        let mut there = Vec::new();
        let each = |line: &[u8]| there.push(String::from_utf8_lossy(line).into_owned());
        let writer = output.append(each, waits).unwrap();
        (writer, there)
    };
    let (mut writer, there) = append(&mut || panic!("no other process has it"));
    assert_eq!(there, ["one", "two"]);
    assert_eq!(folder.text("lines").as_deref(), Some("one\ntwo\n"), "no line is cut off");
    writeln!(writer, "three").unwrap();
    writer.flush().unwrap();
    assert_eq!(folder.text("lines").as_deref(), Some("one\ntwo\nthree\n"), "as a killed process leaves it");
    // Another process waits, and then has the lines of this one.
    let mut holder = Some(writer);
    let (_, there) = append(&mut || {
        let mut writer = holder.take().expect("it waits once");
        writeln!(writer, "four").unwrap();
        writer.commit().unwrap();
    });
    assert!(holder.is_none());
    assert_eq!((there.len(), folder.count()), (4, 1));
    assert!(folder.output("new", "").append(|_| panic!("there is no line"), || ()).is_ok());
}

/// Whatever ends the renaming, every name has a whole file: the last one has not been replaced yet.
#[test]
fn a_set_that_is_renamed_in_part_has_lost_no_file() {
    let folder = Folder::new();
    let outputs = ["a", "b", "summary", "stale"].map(|name| folder.output(name, "earlier"));
    let files = outputs.iter().take(3).map(|output| output.filled(b"of this run").unwrap()).collect();
    fs::remove_file(folder.path(".b.frixel-tmp")).unwrap();
    let error = commit_all(files, &outputs[3..]).unwrap_err().to_string();
    assert!(error.contains("b cannot be replaced ("), "{error}");
    let now = ["a", "b", "summary", "stale"].map(|name| folder.text(name).unwrap());
    assert_eq!(now, ["of this run", "earlier", "earlier", "earlier"]);
    assert_eq!(folder.count(), 4);
    let files = outputs.iter().take(3).map(|output| output.filled(b"of this run").unwrap()).collect();
    assert!(SYNCED.take().is_empty(), "nothing is whole yet");
    commit_all(files, &outputs[3..]).unwrap();
    assert_eq!(SYNCED.take(), [folder.0.path().canonicalize().unwrap()], "the new names are on the disk");
    assert_eq!((folder.text("summary").as_deref(), folder.text("stale")), (Some("of this run"), None));
}

#[test]
fn a_file_that_is_dropped_or_whose_process_was_killed_leaves_the_earlier_one() {
    let folder = Folder::new();
    let output = folder.output("file", "earlier");
    fs::write(folder.path(".file.frixel-tmp"), "left by a process that was killed").unwrap();
    let writer = output.filled(b"new").unwrap();
    assert!(matches!(output.create(), Err(Error::Busy(_))), "one process writes a file");
    drop(writer);
    assert_eq!((folder.text("file").as_deref(), folder.count()), (Some("earlier"), 1));
    let mut open = File::open(folder.path("file")).unwrap();
    let writer = output.filled(b"new").unwrap();
    assert_eq!(writer.sha256(), frixel_lab::hash::sha256(b"new"));
    writer.commit().unwrap();
    let mut read = String::new();
    open.read_to_string(&mut read).unwrap();
    assert_eq!((folder.text("file").as_deref(), read.as_str()), (Some("new"), "earlier"));
    fs::write(folder.path(".file.frixel-tmp"), "left by a process that was killed").unwrap();
    output.write(b"").unwrap();
    assert_eq!(folder.text("file").as_deref(), Some(""));
}

/// A file that another process gives the name between the look and the commit.
#[test]
fn a_new_file_replaces_none_that_came_meanwhile() {
    for is_recording in [false, true] {
        let folder = Folder::new();
        let output = folder.output("rows", "");
        let mut writer = if is_recording {
            recording(&folder.path("rows"), false).begin_recording("keep them").unwrap()
        } else {
            output.create().unwrap()
        };
        writer.write_all(b"a,recording\n1,2\n").unwrap();
        fs::write(folder.path("rows"), "came meanwhile").unwrap();
        let error = writer.commit().unwrap_err().to_string();
        let kept = folder.text(if is_recording { "rows.partial" } else { ".rows.frixel-tmp" });
        assert!(error.contains("the complete new file is "), "{error}");
        assert_eq!(folder.text("rows").as_deref(), Some("came meanwhile"));
        assert_eq!(kept.as_deref(), Some("a,recording\n1,2\n"));
        assert!(!output.write_new(b"another").unwrap());
    }
}

/// Nothing is written behind a gap: rows that are missing in the middle would not be noticed.
#[test]
fn a_file_with_a_gap_takes_no_more_and_gets_no_name() {
    let folder = Folder::new();
    let mut writer = folder.output("rows", "").filled(b"one\n").unwrap();
    writer.flush().unwrap();
    let whole = writer.replace_file(File::open(folder.path(".rows.frixel-tmp")).unwrap());
    assert!(writer.write_all(b"two\n").and_then(|()| writer.flush()).is_err(), "it is open for reading only");
    writer.replace_file(whole);
    assert!(writer.write_all(b"three\n").and_then(|()| writer.flush()).is_err());
    assert!(writer.commit().is_err());
    assert_eq!(folder.count(), 0);
}

#[cfg(unix)]
#[test]
fn links_lead_to_inputs_and_outputs() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
    let folder = Folder::new();
    let path = |name: &str| folder.path(name);
    fs::create_dir(path("kept")).unwrap();
    fs::write(path("kept/file"), "earlier").unwrap();
    fs::set_permissions(path("kept/file"), fs::Permissions::from_mode(0o640)).unwrap();
    symlink("kept/file", path("link")).unwrap();
    symlink("link", path("link-to-link")).unwrap();
    symlink("kept/new", path("new-link")).unwrap();
    fs::hard_link(path("kept/file"), path("hard")).unwrap();
    let inputs = Inputs::new([path("kept/../kept/file")]);
    for name in ["link", "link-to-link", "hard", "kept/file"] {
        let error = OutputFile::new(&path(name), "--out", &inputs).unwrap_err().to_string();
        assert!(
            error.contains("is an input as well, and would be overwritten: give another folder to --out"),
            "{error}"
        );
        let other = folder.output("kept/file", "");
        assert!(folder.output(name, "").check_apart_from(&other).is_err(), "{name}");
    }
    fs::write(path("kept/file.partial"), "rows").unwrap();
    assert!(OutputFile::new(&path("link"), "-o", &Inputs::new([path("kept/file.partial")])).is_err());
    for (link, file) in [("link-to-link", "kept/file"), ("new-link", "kept/new")] {
        folder.output(link, "").write(b"new").unwrap();
        assert_eq!(folder.text(file).as_deref(), Some("new"));
        assert!(fs::symlink_metadata(path(link)).unwrap().is_symlink());
    }
    assert_eq!(fs::metadata(path("kept/file")).unwrap().mode() & 0o777, 0o640);
    fs::write(path("plain"), "").unwrap();
    assert_eq!(fs::metadata(path("kept/new")).unwrap().mode(), fs::metadata(path("plain")).unwrap().mode());
}

#[test]
fn a_recording_of_a_person_is_replaced_only_by_what_overwrites() {
    let folder = Folder::new();
    let path = folder.path("any name");
    fs::write(&path, "t_s,x_mm,y_mm\n0,1,2\n").unwrap();
    let replacing = |overwrites| OutputFile::replacing(&path, "-o", &Inputs::default(), overwrites);
    assert!(matches!(OutputFile::new(&path, "-o", &Inputs::default()), Err(Error::OfPerson(..))));
    assert!(matches!(replacing(false), Err(Error::OfPerson(..))));
    assert!(matches!(OutputFile::recording(&path, "-o", &Inputs::default(), false), Err(Error::Exists(..))));
    replacing(true).unwrap().write(b"new").unwrap();
    assert_eq!(folder.text("any name").as_deref(), Some("new"));
    assert!(OutputFile::recording(&path, "-o", &Inputs::default(), false).is_err(), "a recording replaces no file");
    assert!(OutputFile::new(&path, "-o", &Inputs::default()).is_ok(), "a result replaces a result");
}

#[test]
fn the_rows_of_a_recording_that_was_cut_off_stay_until_there_is_a_better_one() {
    let folder = Folder::new();
    let path = folder.path("rows.csv");
    let partial = || folder.text("rows.csv.partial");
    for (earlier, says) in [
        ("t_s,x_mm\n0,1\n", "has the rows of a recording that was cut off: keep them, or record again"),
        ("A letter.", "is in the way, and is not from a recording that was cut off"),
    ] {
        fs::write(folder.path("rows.csv.partial"), earlier).unwrap();
        let error = recording(&path, false).begin_recording("keep them").unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
        let mut writer = recording(&path, true).begin_recording("keep them").unwrap();
        writer.write_all(b"t_s,x_mm\n").and_then(|()| writer.flush()).unwrap();
        assert_eq!(partial().as_deref(), Some(earlier), "a header is no row");
        drop(writer);
        assert_eq!(partial().as_deref(), Some(earlier));
    }
    assert!(recording(&path, false).resume().is_err(), "a letter is not finished");
    assert_eq!(partial().as_deref(), Some("A letter."));
    let mut writer = recording(&path, true).begin_recording("keep them").unwrap();
    writer.write_all(b"t_s,x_mm\n0,2\n").unwrap();
    drop(writer);
    fs::write(folder.path("rows.csv.partial"), partial().unwrap() + "9.12").unwrap();
    let (mut writer, rows) = recording(&path, false).resume().unwrap();
    assert_eq!(rows, "t_s,x_mm\n0,2\n");
    writer.write_all(b"1,2\n").unwrap();
    writer.commit().unwrap();
    assert_eq!((folder.text("rows.csv").as_deref(), folder.count()), (Some("t_s,x_mm\n0,2\n1,2\n"), 1));
    let mut writer = recording(&path, true).begin_recording("keep them").unwrap();
    writer.write_all(b"t_s,x_mm\n").unwrap();
    drop(writer);
    assert_eq!(folder.count(), 1, "what never had a row leaves nothing");
    let mut writer = recording(&path, true).begin_recording("keep them").unwrap();
    writer.write_all(b"t_s,x_mm\n").unwrap();
    writer.commit().unwrap();
    assert_eq!((folder.text("rows.csv").as_deref(), folder.count()), (Some("t_s,x_mm\n"), 1), "a header is whole");
}

/// A file that was a link to a device without end took all memory.
#[cfg(unix)]
#[test]
fn a_device_in_place_of_a_file_is_not_read() {
    let folder = Folder::new();
    let link = |name: &str| std::os::unix::fs::symlink("/dev/zero", folder.path(name)).unwrap();
    link("felt.csv");
    assert!(!is_of_person(&folder.path("felt.csv")));
    link("rows.csv.partial");
    let rows = recording(&folder.path("rows.csv"), false);
    assert!(!rows.is_cut_off() && rows.begin_recording("keep them").is_err() && rows.resume().is_err());
    fs::remove_file(folder.path("rows.csv.partial")).unwrap();
    File::create(folder.path("rows.csv.partial")).unwrap().set_len(8 << 30).unwrap();
    let error = rows.resume().unwrap_err().to_string();
    assert!(error.contains("it has 8589934592 bytes, and at most 536870912 are read"), "{error}");
}
