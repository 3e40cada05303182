//! `frixel board info`.

use anyhow::Result;
use clap::Args;
use frixel_driver::Device;
use frixel_layers::feature_names;
use frixel_model::TouchBound;
use frixel_wire::hello::{BoardLimits, Hello};

use crate::commands::port;
use crate::commands::terminal::print;

#[derive(Debug, Args)]
pub(in crate::commands) struct InfoArgs {
    /// Path of the board's serial port.
    #[arg(long)]
    port: String,
}

pub(super) fn run(args: &InfoArgs) -> Result<()> {
    let device = Device::connect(port::open(&args.port, &[])?)?;
    print(describe(device.hello()))
}

/// Formats a hello message as text.
fn describe(hello: &Hello) -> String {
    let limits = &hello.limits;
    let id = hello.id.iter().fold(String::new(), |id, byte| id + &format!("{byte:02x}"));
    let (major, minor, patch) = hello.firmware;
    let scene = if hello.scene_crc32 == 0 { "none".into() } else { format!("{:08x}", hello.scene_crc32) };
    let fault = hello.last_fault.map_or("none".into(), |fault| format!("{fault} (detail {})", hello.fault_detail));
    let lines = [
        ("board", hello.board.to_string()),
        ("id", id),
        ("firmware", format!("{major}.{minor}.{patch}, protocol {}.{}", hello.protocol.0, hello.protocol.1)),
        ("features", features(hello.features)),
        ("tick rate", format!("{} Hz", hello.tick_hz)),
        ("state", hello.state.to_string()),
        ("scene", scene),
        ("last reset", hello.reset_cause.to_string()),
        ("last fault", fault),
        ("largest voltage", format!("{} V peak", limits.voltage_max_v_peak)),
        ("touch bound", touch_bound(limits)),
        (
            "largest current",
            format!("{} mA rms, {} mA peak", 1e3 * limits.current_max_a_rms, 1e3 * limits.current_max_a_peak),
        ),
        ("worst electrode", format!("{} nF", 1e9 * limits.electrode_capacitance_max_f)),
        ("bitmaps", format!("{} KiB", limits.bitmap_pool_bytes / 1024)),
        ("records", limits.records_max.to_string()),
        ("touch reports", format!("every {} ms", 1e3 * limits.touch_report_period_s)),
    ];
    let notices = hello.notice_sentences().map(|sentence| ("note", sentence.to_owned()));
    let lines = lines.into_iter().chain(notices);
    lines.fold(String::new(), |text, (name, value)| text + &format!("{name:16} {value}\n"))
}

/// The touch bound, whatever the coating, at the slowest, the usual and the fastest carrier.
fn touch_bound(limits: &BoardLimits) -> String {
    let series_ohm = limits.series_resistance_ohm;
    if series_ohm.is_infinite() {
        return "none stated: the electrode must not be touched".to_owned();
    }
    let [slow, usual, fast] =
        [125.0, 1_000.0, 5_000.0].map(|carrier_hz| TouchBound::behind(series_ohm).stated_v_peak(carrier_hz));
    format!("{slow:.1} V peak at 125 Hz, {usual:.1} V at 1 kHz, {fast:.1} V at 5 kHz behind {} kOhm", 1e-3 * series_ohm)
}

/// Names of the firmware's features; unknown features are printed as bits.
fn features(bits: u32) -> String {
    let named = feature_names().filter(|(bit, _)| bits & bit != 0);
    let unnamed = feature_names().fold(bits, |left, (bit, _)| left & !bit);
    let names = named.map(|(_, name)| name.to_owned());
    let names: Vec<String> = names.chain((unnamed != 0).then(|| format!("{unnamed:#x}"))).collect();
    if names.is_empty() { "none".into() } else { names.join(", ") }
}

#[cfg(test)]
mod tests {
    use frixel_wire::fault::State;
    use frixel_wire::hello::{BoardKind, ResetCause, notice};

    use super::*;

    #[test]
    fn info_has_the_touch_bound_of_three_carriers() {
        assert!(touch_bound(&BoardLimits::UNSTATED).contains("must not be touched"));
        let limits = BoardLimits { series_resistance_ohm: 68e3, ..BoardLimits::UNSTATED };
        let said = touch_bound(&limits);
        assert_eq!(said, "28.6 V peak at 125 Hz, 43.8 V at 1 kHz, 65.6 V at 5 kHz behind 68 kOhm");
    }

    #[test]
    fn info_has_a_sentence_with_advice_for_each_notice() {
        let mut hello = Hello {
            protocol: (1, 0),
            firmware: (0, 1, 0),
            board: BoardKind::NucleoG474re,
            id: [0; 12],
            tick_hz: 40_000,
            frame_max_len: 192,
            features: 0,
            scene_crc32: 0,
            reset_cause: ResetCause::Software,
            last_fault: None,
            fault_detail: 0,
            state: State::Disarmed,
            limits: BoardLimits::UNSTATED,
            notices: 0,
        };
        assert!(!describe(&hello).contains("note"));
        // Bits of a newer protocol are ignored.
        hello.notices = 0x80;
        assert!(!describe(&hello).contains("note"));
        for (bit, advice) in [
            (notice::OPTION_BYTES, "BOR_LEV=4 IWDG_SW=0"),
            (notice::STORED_LIMITS_REFUSED, "store them again"),
            (notice::LIMITS_ABOVE_CEILINGS, "flash a build"),
        ] {
            hello.notices = bit;
            let said = describe(&hello);
            let notes: Vec<&str> = said.lines().filter(|line| line.starts_with("note ")).collect();
            assert!(matches!(notes[..], [note] if note.contains(advice)), "{said}");
        }
    }
}
