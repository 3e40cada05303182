//! `frixel board selftest`: checks link, clock and telemetry of a board, with its output at zero. With `--wires`, it
//! is the host's side of the board's own self-test.

mod report;
mod wires;

use std::path::PathBuf;

use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use clap::Args;
use frixel_driver::{Device, Event, SerialLink};
use frixel_wire::fault::State;
use frixel_wire::message::{TickTimes, telemetry_period_ticks};

use crate::commands::interrupt::Interrupt;
use crate::commands::port;
use crate::commands::terminal::print_line;
use crate::commands::waiting;

/// Largest number of pings whose round trip is measured, and longest time for them.
const PINGS_MAX: u32 = 50;
const PINGS_TIME_MAX: Duration = Duration::from_secs(2);
/// Duration of the telemetry, and messages a second.
const TELEMETRY: Duration = Duration::from_secs(1);
const MESSAGES_HZ: u32 = 500;
/// Largest deviation of the board's clock from this computer's, and largest share of lost messages, in percent.
/// Crystals are within 0.01 %, a computer's timer is late by some ms.
const CLOCK_MAX_PERCENT: f64 = 3.0;
const LOST_MAX_PERCENT: f64 = 5.0;
/// Longest round trip that leaves room within the shortest host timeout, 20 ms.
const ROUND_TRIP_MAX: Duration = Duration::from_millis(20);

#[derive(Debug, Args)]
pub(in crate::commands) struct SelftestArgs {
    /// Path of the board's serial port.
    #[arg(long)]
    port: String,
    /// The board runs the program `self-test`, with wires between its pins (docs/board/first-board.md).
    #[arg(long)]
    wires: bool,
    /// With --wires: seconds for which the line is tested at its full rate; 0 leaves that out.
    #[arg(long, value_name = "S", requires = "wires", default_value_t = 600)]
    seconds: u32,
    /// With --wires: write the report to this file, as JSON.
    #[arg(short, long, value_name = "FILE", requires = "wires")]
    output: Option<PathBuf>,
}

/// Result of a check.
struct Check {
    name: &'static str,
    /// `None` if the board does not measure it.
    passed: Option<bool>,
    found: String,
}

pub(super) fn run(args: &SelftestArgs) -> Result<()> {
    if args.wires {
        return wires::run(&args.port, args.seconds, args.output.as_deref());
    }
    let device = Device::connect(port::open(&args.port, &[])?)?;
    let mut device = waiting::watch(device, &Interrupt::default());
    device.disarm()?;
    let hello = *device.hello();
    let fault = Check {
        name: "no fault",
        passed: Some(hello.state != State::Faulted && hello.last_fault.is_none()),
        found: hello.last_fault.map_or("none since power-on".to_owned(), |fault| fault.to_string()),
    };
    let mut checks = vec![fault, round_trip(&mut device)?];
    checks.extend(telemetry(&mut device, hello.tick_hz)?);
    checks.push(tick_time(device.tick_times()?));
    let rejected = device.counters().frames_rejected;
    checks.push(Check { name: "clean line", passed: Some(rejected == 0), found: format!("{rejected} damaged frames") });
    for Check { name, passed, found } in &checks {
        let verdict = passed.map_or("-", |passed| if passed { "ok" } else { "FAILED" });
        print_line(format_args!("{name:16} {verdict:7} {found}"))?;
    }
    let failed = checks.iter().filter(|check| check.passed == Some(false)).count();
    if failed > 0 {
        bail!("failed checks on {}: {failed}; docs/board/hardware.md lists what each part needs", args.port);
    }
    Ok(())
}

fn round_trip(device: &mut Device<SerialLink>) -> Result<Check> {
    let mut times = Vec::new();
    let begin = Instant::now();
    for _ in 0..PINGS_MAX {
        if begin.elapsed() > PINGS_TIME_MAX {
            break;
        }
        let started = Instant::now();
        device.ping()?;
        times.push(started.elapsed());
    }
    times.sort();
    let median = times.get(times.len() / 2).copied().unwrap_or_default();
    let (median_ms, longest_ms) = (in_ms(median), in_ms(times.last().copied().unwrap_or_default()));
    let found = format!("median {median_ms:.2} ms, at most {longest_ms:.2} ms of {} pings", times.len());
    Ok(Check { name: "round trip", passed: Some(median < ROUND_TRIP_MAX), found })
}

/// Checks the board's clock, the rate of its telemetry, and that its output is zero.
fn telemetry(device: &mut Device<SerialLink>, tick_hz: u32) -> Result<[Check; 3]> {
    let mut messages = Vec::new();
    let period_ticks = telemetry_period_ticks(tick_hz, MESSAGES_HZ);
    device.subscribe(period_ticks)?;
    device.wait(TELEMETRY, &mut |event| {
        if let Event::Telemetry(telemetry) = event {
            messages.push((Instant::now(), telemetry));
        }
    })?;
    device.subscribe(0)?;
    let (mut clock_percent, mut lost_percent) = (f64::INFINITY, 100.0);
    if let (Some((first_at, first)), Some((last_at, last))) = (messages.first(), messages.last()) {
        let board_s = f64::from(last.tick.wrapping_sub(first.tick)) / f64::from(tick_hz);
        clock_percent = 100.0 * (board_s / last_at.duration_since(*first_at).as_secs_f64() - 1.0).abs();
        let expected = board_s * f64::from(tick_hz) / f64::from(period_ticks) + 1.0;
        lost_percent = 100.0 * (1.0 - messages.len() as f64 / expected).max(0.0);
    }
    let is_zero = messages.iter().all(|(_, telemetry)| telemetry.dac_code == 0);
    Ok([
        Check {
            name: "clock",
            passed: Some(clock_percent <= CLOCK_MAX_PERCENT),
            found: format!("{clock_percent:.2} % off this computer's"),
        },
        Check {
            name: "telemetry",
            passed: Some(lost_percent <= LOST_MAX_PERCENT),
            found: format!("{} messages, {lost_percent:.1} % lost", messages.len()),
        },
        Check {
            name: "output zero",
            passed: Some(is_zero && !messages.is_empty()),
            found: "DAC codes of a disarmed board".to_owned(),
        },
    ])
}

/// Checks that no tick of the board was late since power-on.
fn tick_time(times: Option<TickTimes>) -> Check {
    let name = "tick time";
    let Some(times) = times else {
        return Check { name, passed: None, found: "not measured by this board".to_owned() };
    };
    let TickTimes { deadline_cycles, worst_cycles, missed_deadlines, histogram } = times;
    let worst_percent = 100.0 * f64::from(worst_cycles) / f64::from(deadline_cycles);
    let [in_time @ .., late] = histogram;
    let classes = in_time.map(|count| count.to_string()).join(" ");
    let found = format!(
        "at most {worst_cycles} of {deadline_cycles} cycles ({worst_percent:.0} %), {missed_deadlines} deadlines \
         missed; ticks by eighths of the deadline: {classes}, late: {late}"
    );
    Check { name, passed: Some(missed_deadlines == 0 && late == 0), found }
}

fn in_ms(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MEASURED: TickTimes = TickTimes {
        deadline_cycles: 3_700,
        worst_cycles: 2_131,
        missed_deadlines: 0,
        histogram: [0, 127, 128, 39_600, 300, 0, 0, 0, 0],
    };

    #[test]
    fn the_worst_tick_the_histogram_and_missed_deadlines_are_reported() {
        let check = tick_time(Some(MEASURED));
        assert_eq!(check.passed, Some(true));
        for part in ["2131 of 3700 cycles (58 %)", "0 deadlines missed", "0 127 128 39600 300 0 0 0, late: 0"] {
            assert!(check.found.contains(part), "{}", check.found);
        }
    }

    #[test]
    fn a_late_tick_and_a_missed_deadline_fail() {
        assert_eq!(tick_time(Some(TickTimes { missed_deadlines: 1, ..MEASURED })).passed, Some(false));
        let late = TickTimes { worst_cycles: 3_900, histogram: [0, 0, 0, 9, 0, 0, 0, 0, 1], ..MEASURED };
        assert_eq!(tick_time(Some(late)).passed, Some(false));
    }

    #[test]
    fn a_board_that_does_not_measure_its_ticks_is_no_failure() {
        let check = tick_time(None);
        assert_eq!((check.passed, check.found.as_str()), (None, "not measured by this board"));
    }
}
