//! Scenes that several tests share. Not each of them uses all of it.
#![allow(dead_code, unreachable_pub)]

use frixel_layers::{
    Beat, Bitmap, Blend, Burst, Button, Click, Constant, Edge, Grating, Header, Layer, Leader, Noise, Point, Record,
    Region, Rings, Speed, Stream, Vibration, Wave, Waveform,
};

pub fn header() -> Header {
    Header {
        screen_width_m: 0.1,
        screen_height_m: 0.0625,
        finger_radius_m: 0.008,
        stiffness_pa_per_m: 1e8,
        friction_coefficient: 0.5,
        normal_load_n: 0.5,
        effective_gap_m: 250e-9,
        voltage_max_v_rms: 150.0,
        voltage_max_v_peak: 160.0,
        slew_v_per_s: 100_000.0,
        carrier_hz: 1_000.0,
        host_timeout_s: 0.25,
        waveform: Waveform::Square,
        autonomous: false,
        prediction: true,
        leader: Leader::First,
        layers_fixed: false,
        electric_friction_max_n: None,
    }
}

pub fn headers() -> Vec<Header> {
    vec![
        header(),
        Header { waveform: Waveform::Sine, prediction: false, ..header() },
        Header { autonomous: true, ..header() },
        Header { leader: Leader::Latest, ..header() },
        Header { layers_fixed: true, ..header() },
        Header { layers_fixed: true, electric_friction_max_n: Some(0.025_024_414), ..header() },
    ]
}

pub fn records() -> Vec<Record> {
    let rectangle = Region::Rectangle { x_m: 0.01, y_m: 0.02, width_m: 0.03, height_m: 0.04 };
    let ellipse = Region::Ellipse { x_m: 0.02, y_m: 0.01, width_m: 0.04, height_m: 0.03 };
    let polygon = Region::Polygon { first: 1, count: 3 };
    let grating = |wave| {
        Layer::Grating(Grating {
            wave,
            cycles_per_m_x: 500.0,
            cycles_per_m_y: -250.0,
            phase_turns: 0.25,
            trough_n: 0.002,
            crest_n: 0.02,
        })
    };
    let bitmap = |tiled, angle_turns| {
        Layer::Bitmap(Bitmap {
            crc32: 0xcbf4_3926,
            x_m: 0.001,
            y_m: 0.002,
            pitch_m: 0.00025,
            black_n: 0.0,
            white_n: 0.025,
            pitch_y_m: 0.0003,
            angle_turns,
            tiled,
        })
    };
    let click = Click { height_n: 0.015, decay_s: 0.02 };
    let edge = Layer::Edge(Edge {
        x_m: 0.05,
        y_m: 0.04,
        angle_turns: 0.125,
        width_m: 0.004,
        level_n: 0.001,
        ridge_n: 0.02,
        click,
    });
    let vibration =
        |beat, burst| Layer::Vibration(Vibration { beat, frequency_hz: 80.0, low_n: 0.001, high_n: 0.02, burst });
    let rings =
        |wave| Layer::Rings(Rings { wave, x_m: 0.05, y_m: 0.03, cycles_per_m: 400.0, trough_n: 0.002, crest_n: 0.02 });
    let burst = Burst { period_s: 0.5, on_s: 0.25, ramp_s: 0.0625 };
    let layers = [
        (Region::Screen, Blend::Replace, 1.0, Layer::Constant(Constant { electric_friction_n: 0.01 })),
        (rectangle, Blend::Add, 0.5, grating(Wave::Sine)),
        (Region::Screen, Blend::Add, -1.0, grating(Wave::Square { duty: 0.25 })),
        (rectangle, Blend::Replace, 2.0, bitmap(false, 0.0)),
        (ellipse, Blend::Multiply, 1.0, grating(Wave::Triangle)),
        (polygon, Blend::Max, 1.0, grating(Wave::Saw)),
        (Region::Screen, Blend::Add, 1.0, bitmap(true, 0.125)),
        (
            Region::Screen,
            Blend::Add,
            1.0,
            Layer::Noise(Noise {
                seed: 0x0123_4567,
                wavelength_min_m: 0.001,
                wavelength_max_m: 0.004,
                low_n: 0.002,
                high_n: 0.02,
            }),
        ),
        (polygon, Blend::Add, 1.0, edge),
        (ellipse, Blend::Replace, 1.0, Layer::Button(Button { rim_width_m: 0.002, rim_n: 0.02, face_n: 0.005, click })),
        (Region::Screen, Blend::Max, 1.0, vibration(Beat::Sine, Burst::default())),
        (Region::Screen, Blend::Add, 1.0, vibration(Beat::Square, burst)),
        (Region::Screen, Blend::Multiply, 1.0, Layer::Speed(Speed { first: 0, count: 2 })),
        (rectangle, Blend::Replace, 1.0, Layer::Stream(Stream { low_n: 0.002, high_n: 0.02 })),
        (ellipse, Blend::Add, 1.0, rings(Wave::Sine)),
        (Region::Screen, Blend::Replace, 0.5, rings(Wave::Square { duty: 0.25 })),
    ];
    layers.map(|(region, blend, gain, layer)| Record { region, blend, gain, layer }).to_vec()
}

pub fn points() -> Vec<Point> {
    [(0.0, 0.5), (0.0625, 0.03125), (0.09, 0.0625), (0.05, 0.0625)].map(|(x, y)| Point { x, y }).to_vec()
}

/// A whole scene of [`header`], [`records`] and [`points`].
pub fn scene() -> Vec<u8> {
    let (records, points) = (records(), points());
    let mut bytes = header().write(records.len() as u8, points.len() as u8).to_vec();
    bytes.extend(records.iter().flat_map(Record::write));
    bytes.extend(points.iter().flat_map(Point::write));
    bytes
}
