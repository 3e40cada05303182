//! temp
#![allow(missing_docs)]
use std::io::{self, Write};
#[derive(Clone, Copy, Debug)]
pub struct FeltRow {
    pub t_s: f64,
    pub x_mm: Option<f64>,
    pub y_mm: Option<f64>,
    pub speed_mm_s: Option<f64>,
    pub wanted_n: Option<f64>,
    pub asked_n: Option<f64>,
    pub felt_n: Option<f64>,
    pub voltage_v_rms: f64,
    pub dac_code: i16,
    pub flags: u16,
}
pub struct FeltWriter<W>(W);
impl<W: Write> FeltWriter<W> {
    pub fn new(mut w: W) -> io::Result<Self> {
        writeln!(w, "t_s,x_mm,y_mm,speed_mm_s,wanted_n,asked_n,felt_n,voltage_v_rms,dac_code,flags")?;
        Ok(Self(w))
    }
    pub fn write(&mut self, r: &FeltRow) -> io::Result<()> {
        let f = |o: Option<f64>| o.map_or(String::new(), |v| format!("{v:.6}"));
        writeln!(
            self.0,
            "{:.6},{},{},{},{},{},{},{:.4},{},{}",
            r.t_s,
            f(r.x_mm),
            f(r.y_mm),
            f(r.speed_mm_s),
            f(r.wanted_n),
            f(r.asked_n),
            f(r.felt_n),
            r.voltage_v_rms,
            r.dac_code,
            r.flags
        )
    }
    pub fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}
pub fn felt_svg(_: &[FeltRow]) -> String {
    String::new()
}
pub fn scene_png(_: &crate::scene::Program, _: &[FeltRow]) -> Vec<u8> {
    Vec::new()
}
