//! Tables of empirical laws against the laws, and invalid laws.
#![allow(clippy::unwrap_used)]

use frixel_model::{EmpiricalLaw, InverseTable, LawError, LawPoint};

const BOUND: f64 = InverseTable::RELATIVE_ERROR as f64;
/// The error bound holds from this part of the largest friction on.
const LEAST_PART: f64 = 1.0 / (1 << 15) as f64;

fn points(pairs: &[(f32, f32)]) -> Vec<LawPoint> {
    let point = |&(voltage_v_rms, electric_friction_n)| LawPoint { voltage_v_rms, electric_friction_n };
    pairs.iter().map(point).collect()
}

fn law(exponent: f32, pairs: &[(f32, f32)], voltage_max_v_rms: f32) -> Result<EmpiricalLaw, LawError> {
    EmpiricalLaw::new(exponent, &points(pairs), voltage_max_v_rms)
}

/// The largest relative error in friction over the range of a law, at every `stride`th `f32`.
fn worst_error(law: &EmpiricalLaw, friction_max_n: f32, stride: usize, inverse: impl Fn(f32) -> f32) -> f64 {
    let first = (LEAST_PART * f64::from(friction_max_n)) as f32;
    (first.to_bits() + 1..friction_max_n.to_bits())
        .step_by(stride)
        .chain([friction_max_n.to_bits()])
        .map(f32::from_bits)
        .map(|x| (law.electric_friction_n(f64::from(inverse(x))) / f64::from(x) - 1.0).abs())
        .fold(0.0, |worst: f64, error| if error > worst || error.is_nan() { error } else { worst })
}

/// The exponent below the points of a law, and the points.
type Case = (f32, Vec<(f32, f32)>);

/// Power laws from the least to the greatest exponent, bends, a steep step, a plateau, and tiny and large frictions.
fn cases() -> Vec<Case> {
    let mut cases: Vec<Case> =
        [0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 12.0].map(|exponent| (exponent, vec![(150.0, 0.0873)])).into();
    cases.push((2.0, vec![(30.0, 1e-3), (80.0, 9e-3), (150.0, 0.1)]));
    // A steep step between two flat parts.
    cases.push((1.0, vec![(40.0, 2e-3), (90.0, 4e-3), (100.0, 0.013), (200.0, 0.03)]));
    cases.push((12.0, vec![(100.0, 2e-3), (190.0, 3e-3), (200.0, 5e-3)]));
    cases.push((2.0, vec![(50.0, 1.25e-6), (150.0, 1e-5)]));
    cases.push((2.0, vec![(50.0, 10.0), (150.0, 30.0)]));
    let sixteen =
        (1_u8..=16).map(f32::from).map(|step| (12.0 * step, 1e-4 * step * step * (1.0 + 0.05 * (step % 3.0))));
    cases.push((2.0, sixteen.collect()));
    cases
}

#[test]
fn tables_are_within_the_bound_and_zero_output_is_not() {
    for (exponent, pairs) in cases() {
        let last_v_rms = pairs.last().unwrap().0;
        for voltage_max_v_rms in [last_v_rms, 0.93 * last_v_rms, 0.5 * last_v_rms] {
            let law = law(exponent, &pairs, voltage_max_v_rms).unwrap();
            let table = InverseTable::of_law(exponent, &points(&pairs), voltage_max_v_rms, f32::INFINITY).unwrap();
            let friction_max_n = table.electric_friction_max_n();
            let expected_n = law.electric_friction_n(f64::from(voltage_max_v_rms));
            assert!((f64::from(friction_max_n) / expected_n - 1.0).abs() < BOUND, "{friction_max_n} {expected_n}");
            let worst = worst_error(&law, friction_max_n, 4999, |x| table.voltage_v_rms(x));
            println!("{exponent} {pairs:?} to {voltage_max_v_rms} V: {worst:e}");
            assert!(worst <= BOUND, "{exponent} {pairs:?} to {voltage_max_v_rms} V: {worst:e}");
            assert!(worst_error(&law, friction_max_n, 999_999, |_| 0.0) > BOUND);
            // Every pattern is answered, within the limits.
            for x in (0..=u32::MAX).step_by(1_000_003).map(f32::from_bits) {
                let voltage_v_rms = table.voltage_v_rms(x);
                assert!((0.0..=voltage_max_v_rms).contains(&voltage_v_rms), "{x:e}: {voltage_v_rms}");
            }
            assert_eq!(table.voltage_v_rms(f32::INFINITY).to_bits(), voltage_max_v_rms.to_bits());
            assert_eq!(table.voltage_v_rms(f32::NAN).to_bits(), 0);
            assert_eq!(table.voltage_v_rms(-1.0).to_bits(), 0);
        }
    }
}

#[test]
#[ignore = "every f32 pattern, run by `cargo xtask soak tables`"]
fn tables_are_within_the_bound_at_every_f32() {
    for (exponent, pairs) in [(2.0, vec![(150.0, 0.0873)]), cases().pop().unwrap()] {
        let last_v_rms = pairs.last().unwrap().0;
        let law = law(exponent, &pairs, last_v_rms).unwrap();
        let table = InverseTable::of_law(exponent, &points(&pairs), last_v_rms, f32::INFINITY).unwrap();
        let worst = worst_error(&law, table.electric_friction_max_n(), 1, |x| table.voltage_v_rms(x));
        println!("{worst:e}");
        assert!(worst <= BOUND, "{worst:e}");
    }
}

/// Proof of the bound. Every row lies within one power law, `V = x^p`, and relative to its start it is widest from 1 to
/// 9/8. The errors are the same at every scale of friction and voltage.
#[test]
fn the_bound_is_proven_for_every_power_law() {
    let [least, most] = EmpiricalLaw::EXPONENTS.map(f64::from);
    let inner = core::f64::consts::SQRT_2 - 1.0;
    let nodes = [1.0, 1.0625 - 0.0625 * inner, 1.0625 + 0.0625 * inner, 1.125];
    let half_unit = 0.5 * f64::from(f32::EPSILON);
    let mut highest = 0.0_f64;
    for step in 0..=1000 {
        let exponent = least * (most / least).powf(f64::from(step) / 1000.0);
        let p = 1.0 / exponent;
        // |V''''| falls with x for p < 4, and V rises: both are taken where the row begins.
        let interpolation =
            (p * (p - 1.0) * (p - 2.0) * (p - 3.0)).abs() / 24.0 * 0.171_572_875_253_809_9 * 0.0625_f64.powi(4);
        // The cubic through the nodes, by Lagrange's formula, in powers of x.
        let mut cubic = [0.0; 4];
        for (number, node) in nodes.iter().enumerate() {
            let others: Vec<f64> = (0..4).filter(|other| *other != number).map(|other| nodes[other]).collect();
            let [a, b, c] = others[..] else { panic!() };
            let scale = node.powf(p) / ((node - a) * (node - b) * (node - c));
            for (sum, term) in cubic.iter_mut().zip([-a * b * c, a * b + b * c + a * c, -(a + b + c), 1.0]) {
                *sum += scale * term;
            }
        }
        // Coefficients and Horner's steps weigh the four terms with 2, 4, 6 and 7 half-units.
        let rounding = |x: f64| {
            let terms =
                cubic.iter().zip([2.0, 4.0, 6.0, 7.0]).zip(0..).map(|((c, weight), n)| weight * (c * x.powi(n)).abs());
            half_unit * terms.sum::<f64>() / x.powf(p)
        };
        let rounding = nodes.iter().map(|x| rounding(*x)).fold(0.0, f64::max);
        // The last row ends 2^-21 below the curve.
        let bound = exponent * (interpolation + rounding + 1.0 / f64::from(1 << 21));
        highest = highest.max(bound);
        // At the end of a row, rounding is less than that margin, so that no voltage is above the largest.
        assert!(rounding < 1.0 / f64::from(1 << 21), "{exponent}: {rounding:e}");
    }
    println!("{highest:e}");
    assert!(highest < BOUND, "{highest:e}");
    assert!(highest > 0.5 * BOUND, "the range of exponents could be wider: {highest:e}");
}

#[test]
fn a_law_passes_near_its_points_since_bends_are_rounded() {
    let pairs = [(30.0_f32, 1e-3_f32), (80.0, 9e-3), (150.0, 0.1)];
    let law = law(2.0, &pairs, 150.0).unwrap();
    for (voltage_v_rms, friction_n) in pairs.map(|(v, x)| (f64::from(v), f64::from(x))) {
        assert!((law.electric_friction_n(voltage_v_rms) / friction_n - 1.0).abs() < 0.02, "{voltage_v_rms}");
        assert!((law.voltage_v_rms(friction_n) / voltage_v_rms - 1.0).abs() < 0.01, "{friction_n}");
    }
    let mut before_n = 0.0;
    for step in 1..3000 {
        let voltage_v_rms = 0.05 * f64::from(step);
        let friction_n = law.electric_friction_n(voltage_v_rms);
        assert!(friction_n > before_n, "{voltage_v_rms}");
        assert!((law.voltage_v_rms(friction_n) / voltage_v_rms - 1.0).abs() < 1e-12, "{voltage_v_rms}");
        before_n = friction_n;
    }
    // The voltage never exceeds the largest measured one.
    assert_eq!(law.voltage_v_rms(10.0).to_bits(), law.voltage_v_rms(f64::from(0.1_f32)).to_bits());
    assert_eq!((law.electric_friction_n(0.0), law.voltage_v_rms(-1.0), law.voltage_v_rms(f64::NAN)), (0.0, 0.0, 0.0));
}

#[test]
fn a_truncated_table_equals_the_whole_one_up_to_its_end() {
    let (exponent, pairs) = cases().pop().unwrap();
    let points = points(&pairs);
    let whole = InverseTable::of_law(exponent, &points, 150.0, f32::INFINITY).unwrap();
    let largest_n = whole.electric_friction_max_n();
    for part in [0.999, 0.3, 1e-3, 1e-9, -1.0] {
        let cut = InverseTable::of_law(exponent, &points, 150.0, part * largest_n).unwrap();
        let end_n = cut.electric_friction_max_n();
        assert!(end_n >= part * largest_n && end_n <= largest_n);
        for x in (0..=end_n.to_bits()).step_by(100_003).map(f32::from_bits) {
            assert_eq!(cut.voltage_v_rms(x).to_bits(), whole.voltage_v_rms(x).to_bits(), "{x:e} of {part}");
        }
        assert_eq!(cut.voltage_v_rms(end_n.next_up()).to_bits(), cut.voltage_max_v_rms().to_bits());
    }
}

#[test]
fn an_invalid_law_is_refused_with_the_reason() {
    let refused = |exponent, pairs: &[(f32, f32)], voltage_max_v_rms| {
        let error = law(exponent, pairs, voltage_max_v_rms).unwrap_err();
        let by_board = InverseTable::of_law(exponent, &points(pairs), voltage_max_v_rms, f32::INFINITY).unwrap_err();
        // Compared as text, since NaN differs from itself.
        assert_eq!(format!("{by_board:?}"), format!("{error:?}"));
        error
    };
    assert_eq!(refused(2.0, &[], 100.0), LawError::PointCount { found: 0 });
    let many: Vec<(f32, f32)> = (1_u8..=17).map(f32::from).map(|step| (10.0 * step, step)).collect();
    assert_eq!(refused(2.0, &many, 100.0), LawError::PointCount { found: 17 });
    assert_eq!(refused(0.4, &[(100.0, 0.1)], 100.0), LawError::Exponent { found: 0.4 });
    assert_eq!(refused(13.0, &[(100.0, 0.1)], 100.0), LawError::Exponent { found: 13.0 });
    assert!(matches!(refused(f32::NAN, &[(100.0, 0.1)], 100.0), LawError::Exponent { .. }));
    for wrong in [(50.0, 0.2), (60.0, 0.1), (60.0, 0.05), (40.0, 0.2), (60.0, f32::NAN), (f32::INFINITY, 0.2)] {
        assert_eq!(refused(2.0, &[(50.0, 0.1), wrong], 50.0), LawError::Order { point: 1 });
    }
    assert_eq!(refused(2.0, &[(0.0, 0.1)], 50.0), LawError::Order { point: 0 });
    assert_eq!(refused(2.0, &[(50.0, -0.1)], 50.0), LawError::Order { point: 0 });
    assert!(
        matches!(refused(2.0, &[(50.0, 0.01), (51.0, 0.1)], 50.0), LawError::Slope { point: 1, found } if found > 100.0)
    );
    assert!(
        matches!(refused(2.0, &[(50.0, 0.1), (100.0, 0.11)], 50.0), LawError::Slope { point: 1, found } if found < 0.2)
    );
    for voltage in [100.1, 0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert!(matches!(refused(2.0, &[(100.0, 0.1)], voltage), LawError::Voltage { max: 100.0, .. }));
    }
    for (exponent, friction_n, voltage_max_v_rms) in [
        (2.0, 1e-36, 100.0),
        (2.0, 0.9e-6, 100.0),
        (12.0, 1e-3, 50.0),
        // The coefficients of their rows would underflow, and a row would exceed the largest voltage.
        (0.67, 1e16, 100.0),
        (2.0, 1e24, 100.0),
        (2.0, 1.1e12, 100.0),
    ] {
        let [least, most] = EmpiricalLaw::FRICTIONS_N;
        let error = refused(exponent, &[(100.0, friction_n)], voltage_max_v_rms);
        assert!(matches!(error, LawError::Friction { found } if found < least || found > most), "{error}");
    }
    // The ends of the range have tables.
    for (exponent, friction_n) in [(0.5, 1e-6), (2.4, 1e-6), (12.0, 1e-6), (0.5, 1e12), (12.0, 1e12)] {
        for voltage_v_rms in [1.0, 1e4] {
            let table =
                InverseTable::of_law(exponent, &points(&[(voltage_v_rms, friction_n)]), voltage_v_rms, f32::NAN);
            assert!(table.is_ok(), "{exponent} {friction_n:e} {voltage_v_rms}: {table:?}");
        }
    }
}
