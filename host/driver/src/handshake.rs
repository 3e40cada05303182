//! The hello: identifies the board and its protocol version.

use std::time::Duration;

use frixel_wire::frame::{Decoder, FRAME_MAX_LEN};
use frixel_wire::hello::Hello;
use frixel_wire::payload::{Payload, hello_request_frame};

use super::error::{DeviceError, LinkClosed};
use super::link::Link;

/// Largest tick rate accepted in a hello, Hz: 25 times the fastest board's.
const TICK_HZ_MAX: u32 = 1_000_000;
/// Number of hello requests before the board is treated as absent.
const TRIES: u32 = 5;
/// Timeout of each hello request.
const TRY_TIMEOUT: Duration = Duration::from_millis(150);

/// Requests the hello. Returns an error if the board speaks another version of the protocol.
pub(super) fn request_hello<L: Link>(link: &mut L, decoder: &mut Decoder) -> Result<Hello, DeviceError> {
    let mut buffer = [0; FRAME_MAX_LEN];
    // The zero byte ends a partial frame that an earlier host may have left on the board.
    let request = [&[0], hello_request_frame(&mut buffer)?].concat();
    let started = link.now();
    let mut heard_bytes = 0;
    for attempt in 1..=TRIES {
        link.write(&request).map_err(vanished)?;
        let deadline = started + TRY_TIMEOUT * attempt;
        if let Some(hello) = await_hello(link, decoder, deadline, &mut heard_bytes)? {
            let port = link.name().into();
            return match hello.compatibility() {
                Ok(()) => check_limits(&hello, port).map(|()| hello),
                Err(mismatch) => Err(DeviceError::Version { port, mismatch }),
            };
        }
    }
    Err(DeviceError::NoHello { port: link.name().into(), waited: link.now().saturating_sub(started), heard_bytes })
}

/// Refuses limits for which no scene can be compiled. An unstated capacitance or resistance is infinite.
fn check_limits(hello: &Hello, port: String) -> Result<(), DeviceError> {
    let limits = &hello.limits;
    let numbers = [
        ("tick_hz", f64::from(hello.tick_hz), (1..=TICK_HZ_MAX).contains(&hello.tick_hz)),
        ("voltage_max_v_peak", limits.voltage_max_v_peak.into(), is_limit(limits.voltage_max_v_peak)),
        ("full_scale_v_peak", limits.full_scale_v_peak.into(), is_limit(limits.full_scale_v_peak)),
        ("edge_time_constant_s", limits.edge_time_constant_s.into(), is_limit(limits.edge_time_constant_s)),
        (
            "electrode_capacitance_max_f",
            limits.electrode_capacitance_max_f.into(),
            limits.electrode_capacitance_max_f >= 0.0,
        ),
        ("current_max_a_rms", limits.current_max_a_rms.into(), is_limit(limits.current_max_a_rms)),
        ("current_max_a_peak", limits.current_max_a_peak.into(), is_limit(limits.current_max_a_peak)),
        ("series_resistance_ohm", limits.series_resistance_ohm.into(), limits.series_resistance_ohm >= 0.0),
        ("touch_report_period_s", limits.touch_report_period_s.into(), is_limit(limits.touch_report_period_s)),
    ];
    match numbers.into_iter().find(|(.., is_limit)| !is_limit) {
        Some((limit, found, _)) => Err(DeviceError::Limit { port, limit, found }),
        None => Ok(()),
    }
}

fn is_limit(value: f32) -> bool {
    value.is_finite() && value >= 0.0
}

fn await_hello<L: Link>(
    link: &mut L,
    decoder: &mut Decoder,
    deadline: Duration,
    heard_bytes: &mut usize,
) -> Result<Option<Hello>, DeviceError> {
    let mut incoming = Vec::new();
    while link.now() < deadline {
        incoming.clear();
        link.read(&mut incoming, deadline.saturating_sub(link.now())).map_err(vanished)?;
        *heard_bytes += incoming.len();
        let mut input = incoming.as_slice();
        while let Some(payload) = decoder.next_frame(&mut input) {
            // Telemetry and answers for an earlier host may arrive first.
            if let Ok(Payload::Hello(hello)) = Payload::parse_from_board(payload) {
                return Ok(Some(hello));
            }
        }
    }
    Ok(None)
}

fn vanished(closed: LinkClosed) -> DeviceError {
    DeviceError::Vanished { command: "hello", closed }
}
