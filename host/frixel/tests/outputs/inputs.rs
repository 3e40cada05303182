//! No output replaces an input, or a recording of a person.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Stdio;

use super::table::OUTPUTS;
use super::{Folder, answered, line};

/// Another name for a file.
type Alias = fn(&Path, &Path);

const ALIASES: [(&str, Alias); 3] = [
    ("a symbolic link", |file, alias| symlink(file, alias).unwrap()),
    ("a hard link", |file, alias| fs::hard_link(file, alias).unwrap()),
    ("a link to a link", |file, alias| {
        let between = alias.with_extension("between");
        symlink(file, &between).unwrap();
        symlink(&between, alias).unwrap();
    }),
];

#[test]
fn no_output_replaces_an_input_by_whatever_link() {
    for output in OUTPUTS.iter().filter(|output| !output.input.is_empty()) {
        for (kind, alias) in ALIASES {
            for written in output.written {
                let folder = Folder::new();
                let before = folder.read(output.input).unwrap();
                let name = written.replace("OUT", "out");
                fs::create_dir_all(folder.path(&name).parent().unwrap()).unwrap();
                alias(&folder.path(output.input), &folder.path(&name));
                let with = if output.is_recording { " --overwrite" } else { "" };
                let ran = folder.run(&(line(output, output.input, "out") + with));
                let what = format!("{}, {kind} at {written}: {}", output.argument, ran.notes);
                assert_eq!(ran.code, Some(1), "{what}");
                let says =
                    ["is an input as well, and would be overwritten", "is there already, and is not overwritten"];
                assert!(says.iter().any(|says| ran.notes.contains(says)), "{what}");
                assert!(folder.read(output.input).unwrap() == before, "{what}");
                assert!(folder.read(&name).unwrap() == before, "{what}");
            }
        }
    }
}

/// The command lines of the trials, in which the input has the name of the output.
#[test]
fn fit_play_and_migrate_do_not_replace_what_they_read() {
    for (file, line) in [
        ("data.csv", "fit data.csv -o data.csv"),
        ("data.csv", "fit data.csv -o ./nowhere/../data.csv"),
        ("D/felt.csv", "play scene.toml --stroke D/felt.csv --out D"),
        ("D/felt.csv", "score scene.toml --stroke D/score.csv --out D"),
        ("D/felt.csv", "sim --stroke D/felt.csv --out D"),
        ("old.toml", "scene migrate old.toml -o old.toml"),
        ("scene.toml", "scene preview scene.toml --screen D/map.png -o D/map.png"),
        ("screen.toml", "fit data.csv --screen screen.toml -o screen.toml"),
        // The plots beside the profile.
        ("D/felt.svg", "fit D/felt.svg -o D/felt.toml"),
        // What a play that was cut off has left.
        ("D/felt.csv.partial", "play scene.toml --stroke D/felt.csv.partial --out D"),
    ] {
        let folder = Folder::new();
        fs::create_dir(folder.path("nowhere")).unwrap();
        for name in ["D/felt.csv", "D/score.csv", "D/felt.csv.partial"] {
            folder.write(name, &folder.text("stroke.csv"));
        }
        folder.write("D/felt.svg", &folder.text("data.csv"));
        folder.write("D/map.png", &folder.text("screen.toml"));
        let before = folder.read(file).unwrap();
        let ran = folder.run(line);
        assert_eq!(ran.code, Some(1), "{line}: {}", ran.notes);
        assert!(ran.notes.contains("is an input as well, and would be overwritten: give another "), "{}", ran.notes);
        assert!(folder.read(file).unwrap() == before, "{line}");
    }
}

#[test]
fn a_stream_of_samples_is_not_replaced_by_the_play() {
    let folder = Folder::new();
    let wav = fs::read(folder.path("picture.png")).unwrap();
    fs::create_dir(folder.path("D")).unwrap();
    fs::write(folder.path("D/felt.svg"), &wav).unwrap();
    let ran = folder.run("play scene.toml --stream D/felt.svg --out D");
    assert!(ran.code == Some(1) && ran.notes.contains("is an input as well"), "{}", ran.notes);
    assert!(folder.read("D/felt.svg").unwrap() == wav);
}

#[test]
fn a_file_on_standard_input_is_an_input() {
    for (file, line) in [("data.csv", "fit - -o data.csv"), ("points.csv", "model eval --output points.csv")] {
        let folder = Folder::new();
        let before = folder.read(file).unwrap();
        let mut command = folder.command(line);
        let output = command.stdin(Stdio::from(fs::File::open(folder.path(file)).unwrap())).output().unwrap();
        let notes = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(1) && notes.contains("is an input as well"), "{line}: {notes}");
        assert!(folder.read(file).unwrap() == before, "{line}");
    }
}

#[test]
fn two_outputs_of_a_command_are_two_files() {
    let folder = Folder::new();
    let ran = folder.run("fit data.csv -o finger.svg");
    assert!(ran.code == Some(1) && ran.notes.contains("finger.svg would be written twice"), "{}", ran.notes);
    symlink(folder.path("finger.toml"), folder.path("finger.svg")).unwrap();
    let ran = folder.run("fit data.csv -o finger.toml");
    assert!(ran.code == Some(1) && ran.notes.contains("finger.svg would be written twice"), "{}", ran.notes);
}

/// By what is in the file, whatever it is called: a stroke, friction, and a profile of a threshold.
#[test]
fn no_output_replaces_a_recording_of_a_person() {
    let stroke = "t_s,x_mm,y_mm\n0.000000,10.0000,20.0000\n";
    let threshold = "friction_coefficient = 0.5\norigin = \"perceptual\"\n";
    for (number, output) in OUTPUTS.iter().enumerate() {
        let folder = Folder::new();
        let recording = [stroke, &folder.text("data.csv"), threshold][number % 3].to_owned();
        // The demo never replaces its scene; what it writes first is what is played.
        for written in output.written {
            let name = written.replace("OUT", "out");
            folder.write(&name, &recording);
            let ran = folder.run(&line(output, output.input, "out"));
            assert_eq!(ran.code, Some(1), "{}: {}", output.argument, ran.notes);
            let says = [
                "is a recording of a person, which no result replaces: give another ",
                "is there already, and a recording is not replaced: give another ",
                "is there already, and is not overwritten",
            ];
            assert!(says.iter().any(|says| ran.notes.contains(says)), "{}: {}", output.argument, ran.notes);
            assert_eq!(folder.text(&name), recording, "{}", output.argument);
            fs::remove_file(folder.path(&name)).unwrap();
        }
    }
}

#[test]
fn a_file_that_is_write_protected_stays() {
    for output in OUTPUTS.iter().filter(|output| !output.is_recording && output.argument != "new name") {
        let folder = Folder::new();
        let name = output.written[0].replace("OUT", "out");
        folder.write(&name, "mine");
        let mut permissions = fs::metadata(folder.path(&name)).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(folder.path(&name), permissions).unwrap();
        let ran = answered(&mut folder.command(&line(output, output.input, "out")));
        assert!(ran.code == Some(1) && ran.notes.contains("is write-protected"), "{}: {}", output.argument, ran.notes);
        assert_eq!(folder.text(&name), "mine");
    }
}
