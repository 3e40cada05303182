//! The monitor's level shifter, from the parts' values, against what the firmware makes of the ADC's codes.

use super::*;

/// Resistors in front of and around A2, Ohm.
#[derive(Clone, Copy)]
struct Shifter {
    /// The amplifier's own, in front of R19.
    source: f64,
    r19: f64,
    r20: f64,
    r21: f64,
    r22: f64,
    r23: f64,
    offset_v: f64,
    /// What A2's input takes.
    input_a: f64,
}

impl Shifter {
    /// V at the ADC, as parts of the supply's, which is the ADC's reference, too. `None` is a wire that is off.
    fn output_v(&self, monitor_v: Option<f64>) -> f64 {
        let from_monitor = monitor_v.map_or(0.0, |_| 1.0 / (self.source + self.r19));
        let current = monitor_v.unwrap_or_default() * from_monitor + SUPPLY_V / self.r20 - self.input_a;
        let sum_v = current / (from_monitor + 1.0 / self.r20 + 1.0 / self.r21);
        ((sum_v + self.offset_v) * (1.0 + self.r22 / self.r23)).clamp(0.0, SUPPLY_V)
    }
}

const SUPPLY_V: f64 = 3.3;
/// What the ratings say: the amplifier's monitor, and A2.
const SOURCE_MAX_OHM: f64 = 1e3;
const OFFSET_MAX_V: f64 = 1e-3;
const INPUT_MAX_A: f64 = 10e-9;
/// Parts and ratings of [`Shifter`], each of which is at one end of its tolerance.
const ENDS: u32 = 8;
const MONITOR_MAX_V: f64 = 2.2;
/// A Pico's ADC has its reference behind 200 Ohm, on which its own 150 uA drop 30 mV (Raspberry Pi Pico Datasheet, "Using
/// the ADC"). R20 has the supply in front of them.
const PICO_REFERENCE_DROP_V: f64 = 0.03;
/// The largest error of its codes: 16 of 4,096 where others corrected five RP2040 and five RP2350
/// (`github.com/kitanokitsune/rp2040adc_correction`). Most of the RP2040's are erratum RP2040-E11.
const PICO_CODES_MAX: f64 = 16.0;

/// The values of the table, each at one end of its tolerance by a bit of `corner`; the last bits are source, offset and
/// A2's input.
fn shifter(carrier: &Carrier, corner: Option<u32>) -> Shifter {
    let end = |bit: u32| corner.map_or(0.0, |corner| if (corner >> bit) & 1 == 1 { 1.0 } else { -1.0 });
    let mut bit = 0;
    let [r19, r20, r21, r22, r23] = ["R19", "R20", "R21", "R22", "R23"].map(|name| {
        let resistor = part(carrier, name);
        bit += 1;
        resistor.value.unwrap() * (1.0 + resistor.tolerance.unwrap() * end(bit - 1))
    });
    let source = if corner.is_some() { SOURCE_MAX_OHM * (0.5 + 0.5 * end(5)) } else { 0.0 };
    Shifter { source, r19, r20, r21, r22, r23, offset_v: OFFSET_MAX_V * end(6), input_a: INPUT_MAX_A * end(7) }
}

/// V at the ADC for 1 V at the amplifier's output, in a board's source, which takes it from the driver.
fn firmware_v_per_v(sources: &str) -> f64 {
    assert!(source(sources, "adc").contains("MonitorScale::SHIFTED.volts("), "{sources}");
    let text = source("firmware/drivers/src", "monitor");
    let scale = text.split_once("SHIFTED: Self = Self::new(").unwrap().1.split_once(')').unwrap().0;
    let [bits, reference_v, per_v] = scale.split(", ").collect::<Vec<_>>().try_into().unwrap();
    assert_eq!((bits, reference_v.parse().ok()), ("12", Some(SUPPLY_V)));
    let (of, over) = per_v.split_once(" / ").unwrap();
    of.parse::<f64>().unwrap() / over.parse::<f64>().unwrap()
}

#[test]
fn the_level_shifter_is_wired_as_it_is_computed() {
    let carrier = read().unwrap();
    for (name, nodes) in [
        ("MONITOR", &["A1.MONITOR", "R19.1"][..]),
        ("MONITOR_SUM", &["R19.2", "R20.1", "R21.1", "A2.PLUS"]),
        ("MONITOR_HALF", &["A2.MINUS", "R22.1", "R23.1"]),
        ("MONITOR_OUT", &["A2.OUT", "R13.1", "R22.2"]),
    ] {
        assert_eq!(net(&carrier, name).nodes, nodes);
    }
    for (name, ends) in [("3V3", &["R20.2", "A2.VCC"][..]), ("COMMON", &["R21.2", "R23.2", "A2.GND"])] {
        assert!(ends.iter().all(|end| net(&carrier, name).nodes.iter().any(|node| node == end)), "{name}");
    }
    for (name, said) in [("A1", "MONITOR 1 kOhm or less"), ("A2", "offset 1 mV or less, inputs take 10 nA or less")] {
        let ratings = &part(&carrier, name).ratings;
        assert!(ratings.contains(said), "{ratings}");
    }
}

/// The voltage that the firmware reads, from the amplifier's monitor of 1 V for 100 V.
#[test]
fn the_firmware_reads_the_voltage_that_the_parts_give() {
    let carrier = read().unwrap();
    let shifter = shifter(&carrier, None);
    for Processor { sources, .. } in processors(&carrier) {
        for monitor_v in [-MONITOR_MAX_V, -1.0, 0.0, 0.3, MONITOR_MAX_V] {
            let read_v = (shifter.output_v(Some(monitor_v)) - 0.5 * SUPPLY_V) / firmware_v_per_v(sources);
            assert!((read_v - 100.0 * monitor_v).abs() < 0.1, "{sources}: {read_v} V for {monitor_v} V");
        }
    }
}

/// The largest offset, V, and the largest error of the gain over all tolerances, with an ADC whose reference is below
/// the supply by `reference_drop_v` and whose codes are wrong by up to `codes_max`.
fn largest_errors(reference_drop_v: f64, codes_max: f64) -> (f64, f64) {
    let carrier = read().unwrap();
    let (mut offset_v, mut gain_error) = (0.0_f64, 0.0_f64);
    for corner in 0..1 << ENDS {
        let shifter = shifter(&carrier, Some(corner));
        for codes in [-codes_max, codes_max] {
            let read_v = |monitor_v, codes| {
                let of_reference = shifter.output_v(Some(monitor_v)) / (SUPPLY_V - reference_drop_v);
                SUPPLY_V * (of_reference + codes / 4096.0 - 0.5) / 0.0075
            };
            offset_v = offset_v.max(read_v(0.0, codes).abs());
            gain_error = gain_error.max(((read_v(1.0, codes) - read_v(-1.0, -codes)) / 200.0 - 1.0).abs());
        }
    }
    (offset_v, gain_error)
}

/// Bring-up allows an offset of 4 V and a gain that is 10 % off, of amplifier, monitor, level shifter and ADC together.
#[test]
fn the_tolerances_of_the_level_shifter_leave_half_of_what_bring_up_allows() {
    let (offset_v, gain_error) = largest_errors(0.0, 0.0);
    assert!(offset_v < 2.0, "{offset_v} V");
    assert!(gain_error < 0.02, "{gain_error}");
}

/// The monitor tolerates an offset of 8 V, and a quarter of the voltage.
#[test]
fn what_the_adc_of_a_pico_adds_leaves_a_quarter_of_what_the_monitor_tolerates() {
    let (offset_v, gain_error) = largest_errors(PICO_REFERENCE_DROP_V, PICO_CODES_MAX);
    assert!(offset_v < 6.0, "{offset_v} V");
    assert!(gain_error < 0.05, "{gain_error}");
}

/// More than the 8 V that an amplifier may show that is disabled, so that the firmware finds the wire at any voltage.
#[test]
fn a_monitor_wire_that_is_off_reads_as_a_voltage_that_is_never_right() {
    let carrier = read().unwrap();
    let open_v = shifter(&carrier, None).output_v(None);
    let read_v = (open_v - 0.5 * SUPPLY_V) / 0.0075;
    assert!((read_v - 132.0).abs() < 0.5, "{read_v}");
    let net = net(&carrier, "MONITOR_OUT");
    assert!(net.why.contains("2.64 V, which reads as 132 V"), "{}", net.why);
}
