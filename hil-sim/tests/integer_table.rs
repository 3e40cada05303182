//! The inverse table in integers on an emulated processor without an FPU, compared with the same table on the desktop.
//! `frixel-model` holds its error there (`sized_tables`).
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]
#![allow(clippy::disallowed_types, clippy::disallowed_methods, reason = "the test runs an emulator")]

use std::env;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::emulator::is_ci;
use frixel_model::{Contact, Finger, FixedTable, LoadedContact, TableBuilder, U0F32, U1F31};

const EMULATOR: &str = "qemu-system-arm";
const TARGET: &str = "thumbv7m-none-eabi";
const IMAGE: &str = "integer-table";

const FINGER: Finger<f64> = Finger::<f64>::EXAMPLE;
const GAP_M: f64 = 1e-5;
const VOLTAGE_MIN_V_RMS: f64 = 1.0;
const VOLTAGE_MAX_V_RMS: f64 = 200.0;
const RELATIVE_ERROR: f64 = 1e-5;
const ROWS: usize = 512;
/// Distance of the looked-up frictions, in steps: 8,192 look-ups.
const STEP: usize = 0x8_0003;

/// Without emulator or target, the test is skipped with a message; in CI it fails.
fn is_available() -> bool {
    let emulator = Command::new(EMULATOR).arg("--version").stdout(Stdio::null()).status();
    let libraries = Command::new("rustc").args(["--print", "target-libdir", "--target", TARGET]).output().unwrap();
    let has_target = Path::new(String::from_utf8_lossy(&libraries.stdout).trim()).is_dir();
    let is_available = emulator.is_ok() && has_target;
    assert!(is_available || !is_ci(), "{EMULATOR} or the target {TARGET} is missing");
    if !is_available {
        eprintln!("SKIPPED on the emulated Cortex-M3: {EMULATOR} or the target {TARGET} is missing");
    }
    is_available
}

/// The image's output for a table under this load.
fn on_the_cortex_m3(load_n: f64) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../firmware/bench");
    let build = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(["build", "--release", "--locked", "--quiet", "--bin", IMAGE, "--target", TARGET])
        .args(["--target-dir", "../target"])
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(build.status.success(), "{}", String::from_utf8_lossy(&build.stderr));
    let numbers = [
        FINGER.radius_m,
        FINGER.stiffness_pa_per_m,
        FINGER.friction_coefficient,
        GAP_M,
        load_n,
        VOLTAGE_MIN_V_RMS,
        VOLTAGE_MAX_V_RMS,
        RELATIVE_ERROR,
    ];
    let words = numbers.map(|number| format!("arg={:x}", number.to_bits())).join(",");
    let output = Command::new(EMULATOR)
        .args(["-M", "mps2-an385", "-display", "none", "-monitor", "none", "-serial", "null", "-semihosting-config"])
        .arg(format!("enable=on,target=native,arg={IMAGE},{words},arg={STEP:x}"))
        .arg("-kernel")
        .arg(folder.join("../target").join(TARGET).join("release").join(IMAGE))
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    text
}

fn contact(load_n: f64) -> LoadedContact<f64> {
    Contact::new(&FINGER, GAP_M).unwrap().under_load(load_n).unwrap()
}

fn table<'rows>(contact: &LoadedContact<f64>, rows: &'rows mut [[i32; 4]]) -> FixedTable<'rows, 4> {
    let friction_n = |voltage_v_rms| contact.electric_friction_n(voltage_v_rms);
    let (least_n, largest_n) = (friction_n(VOLTAGE_MIN_V_RMS), friction_n(VOLTAGE_MAX_V_RMS));
    TableBuilder::new(contact, least_n, largest_n, RELATIVE_ERROR).unwrap().build_fixed(rows).unwrap()
}

/// Friction and voltage of each look-up, with the rows compared on the way.
fn look_ups(text: &str, table: &FixedTable<4>) -> Vec<(U0F32, U1F31)> {
    let (rows, look_ups): (Vec<&str>, Vec<&str>) = text.lines().partition(|line| line.starts_with("row"));
    let expected = table.rows().iter().map(|[a, b, c, d]| format!("row {a:x} {b:x} {c:x} {d:x}"));
    assert!(rows.iter().copied().eq(expected), "the rows differ");
    let bits = |word: &str| u32::from_str_radix(word, 16).unwrap();
    let look_ups = look_ups.iter().map(|line| line.split_once(' ').unwrap());
    look_ups.map(|(x, v)| (U0F32::from_bits(bits(x)), U1F31::from_bits(bits(v)))).collect()
}

#[test]
fn a_processor_without_an_fpu_gives_the_same_bits() {
    if !is_available() {
        return;
    }
    for load_n in [0.0, 0.5] {
        let contact = contact(load_n);
        let mut rows = [[0; 4]; ROWS];
        let table = table(&contact, &mut rows);
        let look_ups = look_ups(&on_the_cortex_m3(load_n), &table);
        assert_eq!(look_ups.len(), (1_usize << 32).div_ceil(STEP));
        for (friction, voltage) in &look_ups {
            assert_eq!(table.voltage(*friction), *voltage, "friction {friction}, load {load_n} N");
        }
    }
}
