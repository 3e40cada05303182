//! The model's inverse tables, in f32 and in integers, of every order and several sizes, and the table of the boards.

use frixel_model::{InverseTable, Precision, TableBuilder, U0F32, U1F31};

use super::{Bench, Kind, Method, RANGE_V_RMS, ReportError};

/// The methods of the boards, by their names in the counts: the table in f32, and an integer table with this error.
const BOARD: &str = "inverse_table";
const BOARD_IN_INTEGERS: (&str, f64) = ("inverse_table_fixed", 1e-5);
/// Target errors that tables are built for.
const TARGETS: [f64; 5] = [1e-2, 1e-3, 1e-4, 1e-5, 4e-6];

pub(super) fn measure(bench: &Bench, methods: &mut Vec<Method>) -> Result<(), ReportError> {
    let device = InverseTable::build(bench.contact, RANGE_V_RMS.1)?;
    let bytes = size_of::<InverseTable>();
    let method = bench.in_f32(Kind::Device, format!("{bytes} bytes"), Some(bytes), |x| device.voltage_v_rms(x));
    methods.push(Method { counted: Some(BOARD), ..method });
    let low = bench.contact.electric_friction_n(RANGE_V_RMS.0);
    let high = bench.contact.electric_friction_n(RANGE_V_RMS.1);
    for target in TARGETS {
        let builder = TableBuilder::new(bench.contact, low, high, target)?;
        float::<2>(bench, &builder, Kind::Linear, methods)?;
        float::<3>(bench, &builder, Kind::Quadratic, methods)?;
        float::<4>(bench, &builder, Kind::Cubic, methods)?;
        fixed::<2>(bench, &builder, Kind::FixedLinear, methods)?;
        fixed::<3>(bench, &builder, Kind::FixedQuadratic, methods)?;
        fixed::<4>(bench, &builder, Kind::FixedCubic, methods)?;
        let (name, board_target) = BOARD_IN_INTEGERS;
        if let Some(method) = methods.last_mut().filter(|_| target.total_cmp(&board_target).is_eq()) {
            method.counted = Some(name);
        }
    }
    Ok(())
}

fn float<const C: usize>(
    bench: &Bench,
    builder: &TableBuilder,
    kind: Kind,
    methods: &mut Vec<Method>,
) -> Result<(), ReportError> {
    let shape = builder.shape(Precision::F32, C)?;
    let mut rows = vec![[0.0; C]; shape.rows];
    let table = builder.build_f32(&mut rows)?;
    let size = format!("{} rows", shape.rows);
    methods.push(bench.in_f32(kind, size, Some(shape.bytes()), |x| table.voltage_v_rms(x)));
    Ok(())
}

fn fixed<const C: usize>(
    bench: &Bench,
    builder: &TableBuilder,
    kind: Kind,
    methods: &mut Vec<Method>,
) -> Result<(), ReportError> {
    let shape = builder.shape(Precision::Fixed, C)?;
    let mut rows = vec![[0; C]; shape.rows];
    let table = builder.build_fixed(&mut rows)?;
    let units = (
        table.friction_max_n() * U0F32::DELTA.to_num::<f64>(),
        table.voltage_max_v_rms() * U1F31::DELTA.to_num::<f64>(),
    );
    let size = format!("{} rows", shape.rows);
    methods
        .push(bench.in_codes(kind, size, shape.bytes(), units, |code| table.voltage(U0F32::from_bits(code)).to_bits()));
    Ok(())
}
