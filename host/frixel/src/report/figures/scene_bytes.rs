//! Bytes on the wire, and of the inverse table, against the content of a scene.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::ops::RangeInclusive;

use frixel_hil_sim::{BoardMemory, RigConfig};
use frixel_layers::Scene as WireScene;
use frixel_model::{Finger, InverseTable};
use frixel_wire::scene::{POINTS_MAX, POLYGON_POINTS_MAX, RECORDS_MAX};

use super::{Figure, ReportError};
use crate::report::figure::Data;
use crate::report::finger::DrawnFinger;
use crate::report::wire::OnTheWire;
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel, RGBColor};
use frixel_scene::{CompileError, Program, Scene, compile};

/// The beginning of every scene.
fn head(drawn: &DrawnFinger) -> String {
    let Finger { radius_m, stiffness_pa_per_m, friction_coefficient } = drawn.finger;
    let (radius_mm, gap_um, load_n) = (1e3 * radius_m, 1e6 * drawn.gap_m, drawn.load_n);
    format!(
        "version = 1\n[screen]\nwidth_mm = 120\nheight_mm = 80\n\
         [screen.coating]\nthickness_um = {gap_um}\npermittivity = 1\n\
         [finger]\nradius_mm = {radius_mm}\nstiffness_pa_per_m = {stiffness_pa_per_m:e}\n\
         friction_coefficient = {friction_coefficient}\nnormal_load_n = {load_n}\nskin_gap_um = 0\n"
    )
}
/// Layers are placed on a lattice, so that no two are in the same cell of the board's grid.
const COLUMNS: usize = 8;
const LATTICE_MM: (f64, f64) = (15.0, 10.0);
const VERTICES_MIN: usize = 3;
/// Samples along the side of a picture.
const SIDES: [usize; 9] = [50, 75, 100, 125, 150, 175, 200, 225, 250];
const PITCH_MM: f64 = 0.25;
const PICTURE: &str = "picture.png";
/// Largest frictions of the scenes, in percent of the reachable friction.
const PERCENTS: RangeInclusive<usize> = 1..=100;
/// Bits per byte on a serial line, with start and stop bit.
const BITS_PER_BYTE: f64 = 10.0;

fn corner_mm(number: usize) -> (f64, f64) {
    ((number % COLUMNS) as f64 * LATTICE_MM.0, (number / COLUMNS) as f64 * LATTICE_MM.1)
}

fn gratings(head: &str, count: usize) -> String {
    (0..count).fold(head.to_owned(), |mut text, number| {
        let (x_mm, y_mm) = corner_mm(number);
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "[[layer]]\nkind = \"grating\"\nwavelength_mm = 2\nlow_n = 0\nhigh_n = 0.02\n\
             region = {{ x_mm = {x_mm}, y_mm = {y_mm}, width_mm = 5, height_mm = 4 }}\n"
        );
        text
    })
}

fn polygons(head: &str, count: usize, vertices: usize) -> String {
    (0..count).fold(head.to_owned(), |mut text, number| {
        let (left_mm, top_mm) = corner_mm(number);
        let points: Vec<_> = (0..vertices)
            .map(|vertex| {
                let angle = core::f64::consts::TAU * vertex as f64 / vertices as f64;
                format!("[{:.3}, {:.3}]", left_mm + 3.0 + 2.5 * libm::cos(angle), top_mm + 3.0 + 2.5 * libm::sin(angle))
            })
            .collect();
        let _ = write!(
            text,
            "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\n\
             region = {{ shape = \"polygon\", points_mm = [{}] }}\n",
            points.join(", ")
        );
        text
    })
}

fn picture(head: &str, side: usize) -> String {
    let width_mm = side as f64 * PITCH_MM;
    format!(
        "{head}[[layer]]\nkind = \"bitmap\"\npicture = \"{PICTURE}\"\nx_mm = 0\ny_mm = 0\nwidth_mm = {width_mm}\n\
         pitch_mm = {PITCH_MM}\n"
    )
}

/// A scene with the same friction everywhere.
fn one_friction(head: &str, percent: usize) -> String {
    format!("{head}[[layer]]\nkind = \"constant\"\nfriction_fraction = {}\n", percent as f64 / 100.0)
}

/// The files of the scenes.
type Pictures = BTreeMap<String, Vec<u8>>;

/// A picture with all grey levels, which each scene resamples to its own size.
fn pictures() -> Result<Pictures, ReportError> {
    const SIDE: u8 = 64;
    let greys: Vec<u8> = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| 2 * (row + column))).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, SIDE.into(), SIDE.into());
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&greys)?;
    writer.finish()?;
    Ok(BTreeMap::from([(PICTURE.to_owned(), bytes)]))
}

fn compiled(text: &str, pictures: &Pictures) -> Result<Program, CompileError> {
    let board = RigConfig::default().board;
    compile(&Scene::parse(text, "a scene of the report", pictures)?, &board.limits, board.tick_hz)
}

/// Largest number of polygon vertices that fits into a tick.
fn vertices_max(head: &str, pictures: &Pictures) -> usize {
    let fits = |vertices: &usize| compiled(&polygons(head, 1, *vertices), pictures).is_ok();
    (VERTICES_MIN..=POLYGON_POINTS_MAX).rev().find(fits).unwrap_or(VERTICES_MIN)
}

/// Bytes of the part of the inverse table that the board computes for a program.
fn table_bytes(program: &Program) -> usize {
    let scene = program.scene_bytes();
    let rows = WireScene::parse(&scene).ok().and_then(|scene| {
        let rows = BoardMemory::table_rows(&scene, &RigConfig::default().board);
        rows.ok().map(|rows| rows.filled)
    });
    InverseTable::ROW_BYTES * rows.unwrap_or_default()
}

/// Scenes with the same kind of content.
struct Family {
    name: String,
    colour: RGBColor,
    scenes: Vec<Measured>,
}

/// A scene's amount of content, its bytes on the wire, and its bytes of the inverse table.
struct Measured {
    amount: usize,
    wire: OnTheWire,
    table_bytes: usize,
}

impl Family {
    fn new(
        name: &str,
        colour: RGBColor,
        pictures: &Pictures,
        scenes: impl Iterator<Item = (usize, String)>,
    ) -> Result<Self, ReportError> {
        let measured = |(amount, text): (usize, String)| {
            let program = compiled(&text, pictures)?;
            Ok(Measured { amount, wire: OnTheWire::of(&program)?, table_bytes: table_bytes(&program) })
        };
        Ok(Self { name: name.to_owned(), colour, scenes: scenes.map(measured).collect::<Result<_, ReportError>>()? })
    }

    fn largest(&self) -> OnTheWire {
        self.scenes.last().map(|scene| scene.wire).unwrap_or_default()
    }

    fn draw_table(&self, panel: &mut Panel) {
        let points = self.scenes.iter().map(|scene| (scene.amount as f64, scene.table_bytes as f64)).collect();
        panel.add("", Look { colour: self.colour, line: Line::Solid, mark: Mark::None }, points);
    }

    fn draw(&self, panel: &mut Panel, mark: Mark) {
        let points = |bytes: fn(&OnTheWire) -> usize| {
            self.scenes.iter().map(|scene| (scene.amount as f64, bytes(&scene.wire) as f64)).collect::<Vec<_>>()
        };
        let Self { name, colour, .. } = self;
        panel.add("", Look::line(PALETTE[6], Line::Dashed), points(OnTheWire::content_bytes));
        panel.add(name, Look { colour: *colour, line: Line::Solid, mark }, points(|wire| wire.wire_bytes));
    }

    fn rows(&self, data: &mut Data<8>, unit: &str) {
        for Measured { amount, wire, table_bytes } in &self.scenes {
            let [scene, picture] = [wire.scene_bytes, wire.picture_bytes].map(Into::into);
            let (frames, bytes) = (wire.frames.into(), wire.wire_bytes.into());
            data.row([
                self.name.as_str().into(),
                unit.into(),
                (*amount).into(),
                scene,
                picture,
                frames,
                bytes,
                (*table_bytes).into(),
            ]);
        }
    }
}

/// All scenes: gratings, polygons with few and with many vertices, pictures, and uniform frictions.
fn families(head: &str) -> Result<[Family; 5], ReportError> {
    let files = &pictures()?;
    let many = vertices_max(head, files);
    let of_polygons = |vertices: usize| {
        (1..=POINTS_MAX / vertices).map(move |count| (count * vertices, polygons(head, count, vertices)))
    };
    Ok([
        Family::new("gratings", PALETTE[0], files, (1..=RECORDS_MAX).map(|count| (count, gratings(head, count))))?,
        Family::new("triangles", PALETTE[2], files, of_polygons(VERTICES_MIN))?,
        Family::new(&format!("polygons of {many} vertices"), PALETTE[1], files, of_polygons(many))?,
        Family::new("a picture", PALETTE[3], files, SIDES.into_iter().map(|side| (side, picture(head, side))))?,
        Family::new("a friction", PALETTE[4], files, PERCENTS.map(|percent| (percent, one_friction(head, percent))))?,
    ])
}

pub(super) fn figure(drawn: &DrawnFinger, tick: &str) -> Result<Figure, ReportError> {
    let families = families(&head(drawn))?;
    let [gratings, triangles, polygons, pictures, frictions] = &families;
    let mut data =
        Data::new(["content", "unit", "amount", "scene_bytes", "picture_bytes", "frames", "wire_bytes", "table_bytes"]);
    let units = ["layers", "vertices", "vertices", "samples a side", "percent of the reach"];
    for (family, unit) in families.iter().zip(units) {
        family.rows(&mut data, unit);
    }
    let panel = |title: &str, x: &str, amounts: f64, y: &str, bytes: f64| {
        Panel::new(title, Axis::linear(x, 0.0..amounts), Axis::linear(y, 0.0..bytes))
    };
    let wire = "bytes on the wire";
    let mut left = panel("Gratings", "gratings", 66.0, wire, 4_400.0);
    gratings.draw(&mut left, Mark::None);
    let mut middle = panel("Polygons", "vertices of all polygons", 132.0, wire, 4_400.0);
    triangles.draw(&mut middle, Mark::None);
    polygons.draw(&mut middle, Mark::Disc);
    let mut right = panel("A picture", "samples along each side", 262.0, wire, 72_000.0);
    pictures.draw(&mut right, Mark::Square);
    right.add("without framing", Look::line(PALETTE[6], Line::Dashed), Vec::new());
    let mut table = panel("The table", "largest friction, % of the reach", 104.0, "bytes of the table", 1_100.0);
    frictions.draw_table(&mut table);
    Ok(Figure {
        name: "bytes-against-scene-content",
        title: "Bytes on the wire and of the table against what is in the scene".to_owned(),
        caption: caption(&families, tick, &drawn.caption),
        chart: Chart::new(vec![left, middle, right, table], 2).with_shared_legend(),
        csv: data.csv()?,
    })
}

fn caption(families: &[Family; 5], tick: &str, finger: &str) -> Vec<String> {
    let [gratings, _, polygons, pictures, frictions] = families;
    let table = |percent: usize| {
        frictions.scenes.iter().find(|scene| scene.amount == percent).map_or(0, |scene| scene.table_bytes)
    };
    let (scene, picture) = (gratings.largest(), pictures.largest());
    let milliseconds = |bytes: usize, baud: f64| 1e3 * bytes as f64 * BITS_PER_BYTE / baud;
    vec![
        format!(
            "All bytes that the host sends from the start of an upload to its commit, as compiler and driver make \
             them: chunks of header, layers, points and samples in their frames, and the requests around them. Dashed: \
             the compiled scene and its picture alone. {RECORDS_MAX} gratings are {} bytes in {} frames, {:.0} ms at 2 \
             Mbaud and {:.0} ms at 115,200 baud; a picture of 250 by 250 samples is {} bytes in {} frames, {:.0} ms \
             and {:.1} s.",
            scene.wire_bytes,
            scene.frames,
            milliseconds(scene.wire_bytes, 2e6),
            milliseconds(scene.wire_bytes, 115_200.0),
            picture.wire_bytes,
            picture.frames,
            milliseconds(picture.wire_bytes, 2e6),
            1e-3 * milliseconds(picture.wire_bytes, 115_200.0),
        ),
        format!(
            "A layer takes the same whatever its kind; a vertex comes on top of its polygon's layer, and a scene has \
             at most {POINTS_MAX} of them. Triangles and {} are shown: the format takes {POLYGON_POINTS_MAX} in a \
             polygon, but a tick has no time for more than these. A sample is a byte, and a picture's size on the wire \
             goes with its area, whatever it shows; one that a board holds already is not sent again.",
            polygons.name
        ),
        format!(
            "The board computes of its inverse table what a scene can ask for: {} bytes for all of the reach, {} for \
             half of it, {} for a tenth. The table's room in RAM, {} bytes, is the same for every scene; what is saved \
             is time when the scene is taken. It reaches down to 1 V for every scene, since the friction of a still \
             finger is ramped away.",
            table(100),
            table(50),
            table(10),
            size_of::<InverseTable>(),
        ),
        tick.to_owned(),
        finger.to_owned(),
    ]
}

#[cfg(test)]
mod tests {
    use frixel_hil_sim::{BoardMemory, Point, Rig, Stroke};

    use super::*;
    use frixel_driver::{Bitmap, Device, PollingLink, Upload};
    use frixel_felt::recorder::Recorder;
    use frixel_lab::simulation::SimStream;

    /// Frames and bytes that the driver sends to a simulated board.
    fn sent(program: &Program) -> (u64, u64) {
        let config = RigConfig::default();
        let mut memory = BoardMemory::new();
        let point = Point { x_m: 0.01, y_m: 0.01 };
        let stroke = Stroke::constant_speed(point, Point { x_m: 0.1, ..point }, 0.1).expect("a stroke");
        let rig = Rig::new(&mut memory, &config, stroke, 1).expect("a rig");
        let mut device = Device::connect(PollingLink::new(SimStream::new(rig, Recorder::default()))).expect("a board");
        let before = device.counters();
        let scene = program.scene_bytes();
        let bitmaps = program.bitmaps.iter().map(|bitmap| Bitmap {
            crc32: bitmap.crc32,
            width: bitmap.width,
            height: bitmap.height,
            samples: &bitmap.samples,
        });
        let upload = Upload { scene: &scene, bitmaps: bitmaps.collect() };
        device.upload(&upload, &mut |_| {}).expect("an upload");
        device.commit(upload.scene_crc32()).expect("a commit");
        let after = device.counters();
        (after.frames_sent - before.frames_sent, after.wire_bytes - before.wire_bytes)
    }

    #[test]
    fn the_driver_sends_as_much() {
        let files = pictures().expect("a picture");
        let head = "version = 1\n";
        let texts = [gratings(head, 1), gratings(head, 64), polygons(head, 42, 3)];
        for text in texts.into_iter().chain([head.to_owned(), picture(head, 50), picture(head, 250)]) {
            let program = compiled(&text, &files).expect("it compiles");
            let wire = OnTheWire::of(&program).expect("frames");
            assert_eq!((wire.frames as u64, wire.wire_bytes as u64), sent(&program));
        }
    }
}
