//! Compares the target friction of compiled layers with evaluations written here from the file's numbers.

use frixel_layers::{Constant, Grating, Layer, Leader, Region, Waveform};

use super::super::picture::{Ground, PIXELS_MAX, Picture};
use super::super::resample;
use super::*;
use crate::reference::Reference;

/// Frictions under a finger, in mN above natural friction, at places in mm.
fn frictions_mn(layers: &str, places_mm: &[(f64, f64)]) -> Vec<f64> {
    let reference = Reference::new(&compile_layers(layers));
    places_mm.iter().map(|(x, y)| 1e3 * reference.electric_friction_n(x * 1e-3, y * 1e-3)).collect()
}

#[track_caller]
fn close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= tolerance, "{found} is not {expected}");
    }
}

#[test]
fn header_in_si_units() {
    let text = HEAD.replace(
        "# layers follow",
        "[drive]\nvoltage_max_v_rms = 100\nvoltage_max_v_peak = 200\nslew_v_per_us = 2\nhost_timeout_ms = 100\n\
         [carrier]\nshape = \"sine\"\nfrequency_hz = 800\n[touch]\nprediction = false\nleader = \"latest\"",
    );
    let slabs = "[[screen.coating]]\nthickness_um = 1\npermittivity = 4\n[[screen.coating]]\nthickness_um = 9\npermittivity = 1\n";
    let text = text.replace("[screen.coating]\nthickness_um = 10\npermittivity = 1\n", slabs);
    let header = compile_text(&text).expect("it compiles").header;
    for (found, expected) in [
        (header.screen_width_m, 0.12),
        (header.screen_height_m, 0.11),
        (header.finger_radius_m, 0.008),
        (header.stiffness_pa_per_m, 1.8e7),
        (header.friction_coefficient, 0.5),
        (header.normal_load_n, 0.5),
        (header.effective_gap_m, 9.25e-6),
        (header.voltage_max_v_rms, 100.0),
        (header.voltage_max_v_peak, 200.0),
        (header.slew_v_per_s, 2e6),
        (header.carrier_hz, 800.0),
        (header.host_timeout_s, 0.1),
    ] {
        assert!((found - expected).abs() <= 1e-6 * expected, "{found} is not {expected}");
    }
    assert_eq!(header.waveform, Waveform::Sine);
    assert!(!header.prediction);
    assert_eq!(header.leader, Leader::Latest);
}

#[test]
fn the_largest_voltage_keeps_every_limit() {
    let reached = |drive: &str| {
        let program = compile_text(&HEAD.replace("# layers follow", drive)).expect("it compiles");
        (
            f64::from(program.header.voltage_max_v_rms),
            f64::from(program.header.voltage_max_v_peak),
            program.notes().collect::<Vec<_>>(),
        )
    };
    // Half a period is 25 time constants long, so 1 - (2/25) tanh(12.5) of the mean square remains.
    let edges = (1.0_f64 - 0.08).sqrt();
    let (rms, peak, notes) = reached("");
    close(&[rms, peak * edges / 1.001], &[150.0, 150.0], 1e-4);
    assert!(notes.is_empty(), "{notes:?}");
    let (rms, peak, notes) = reached("[drive]\nvoltage_max_v_peak = 100");
    close(&[rms, peak], &[100.0 * edges, 100.0], 1e-4);
    assert_eq!(notes, ["drive: 150 V rms would need 156.4 V peak; the limit of 100 V peak allows 95.9 V rms"]);
    let (rms, peak, notes) = reached("[drive]\nvoltage_max_v_rms = 400");
    close(&[rms, peak], &[220.0 * edges, 220.0], 1e-4);
    assert!(notes.is_empty(), "it is a warning: {notes:?}");
    // A sine of 20 ticks per half period, held for a tick at a time, of which each is 1.25 time constants long.
    let (lags, cosine) = (1.25_f64, (std::f64::consts::PI / 20.0).cos());
    let left = 1.0 - (1.0 - cosine) * lags.sinh() / (lags * (lags.cosh() - cosine));
    let (rms, _, _) = reached("[drive]\nvoltage_max_v_peak = 100\n[carrier]\nshape = \"sine\"");
    close(&[rms], &[100.0 * (0.5 * left).sqrt()], 1e-4);
}

#[test]
fn left_and_top_edge_belong_to_a_region_and_right_and_bottom_do_not() {
    // Powers of two in metres, which f32 represents exactly.
    let layers = "[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n\
                  region = { x_mm = 15.625, y_mm = 31.25, width_mm = 15.625, height_mm = 31.25 }";
    let (left, right, top, bottom) = (15.625, 31.25, 31.25, 62.5);
    let places = [
        (left, top),
        (right, 40.0),
        (20.0, bottom),
        (right - 1e-6, bottom - 1e-6),
        (left - 1e-6, top),
        (left, top - 1e-6),
    ];
    close(&frictions_mn(layers, &places), &[10.0, 0.0, 0.0, 10.0, 0.0, 0.0], 1e-5);
}

#[test]
fn natural_friction_in_total_is_no_drive() {
    // 0.3 x 0.7 differs from 0.21 in binary. The value would be out of range if that difference counted.
    let text = HEAD.replace("friction_coefficient = 0.5", "friction_coefficient = 0.3");
    let text = text.replace("normal_load_n = 0.5", "normal_load_n = 0.7");
    let program = compile_text(&format!("{text}[[layer]]\nlive = true\nkind = \"constant\"\nfriction_n = 0.21"))
        .expect("it compiles");
    assert_eq!(program.records[0].layer, Layer::Constant(Constant { electric_friction_n: 0.0 }));
}

#[test]
fn whole_turns_of_an_angle_change_nothing() {
    let of = |angle_deg: i32, phase_deg: i32| {
        let grating = format!(
            "[[layer]]\nkind = \"grating\"\nwavelength_mm = 3\nangle_deg = {angle_deg}\nphase_deg = {phase_deg}\nlow_n = 0\n\
             high_n = 0.01"
        );
        compile_layers(&grating).records
    };
    assert_eq!(of(390, -725), of(30, -5));
    assert_eq!(of(30 - 3_600_000 + 360, 45), of(-330, 45));
    assert_ne!(of(390, 0), of(31, 0));
}

#[test]
fn right_angles_have_no_slant() {
    let program =
        compile_layers("[[layer]]\nkind = \"grating\"\nwavelength_mm = 2\nangle_deg = 90\nlow_n = 0\nhigh_n = 0.01");
    let Layer::Grating(Grating { cycles_per_m_x, cycles_per_m_y, .. }) = program.records[0].layer else {
        panic!("a grating")
    };
    assert_eq!((cycles_per_m_x, cycles_per_m_y), (0.0, 500.0));
}

#[test]
fn regions_as_large_as_the_screen_are_the_screen() {
    let layer = |width_mm: f64| {
        format!(
            "[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\nregion = {{ x_mm = 0, y_mm = 0, width_mm = {width_mm}, height_mm = 110 }}"
        )
    };
    assert_eq!(compile_layers(&layer(120.0)).records[0].region, Region::Screen);
    assert_ne!(compile_layers(&layer(119.0)).records[0].region, Region::Screen);
}

#[test]
fn regions_never_round_past_the_screen() {
    for tenths in 1..1199 {
        let x_mm = f64::from(tenths) / 10.0;
        let program = compile_layers(&format!(
            "[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\nregion = {{ x_mm = {x_mm}, y_mm = 0, width_mm = {}, height_mm = 1 }}",
            120.0 - x_mm
        ));
        let Region::Rectangle { x_m, width_m, .. } = program.records[0].region else { panic!("a rectangle") };
        assert!(f64::from(x_m) + f64::from(width_m) <= f64::from(program.header.screen_width_m));
        assert!(f64::from(x_m) + f64::from(width_m) > 0.12 - 1e-7);
    }
}

/// A PNG file of 8 or 16 bits a sample.
fn png_of(width: u32, colour: png::ColorType, depth: png::BitDepth, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let bytes_per_pixel = colour.samples() * if depth == png::BitDepth::Sixteen { 2 } else { 1 };
    let height = data.len() / bytes_per_pixel / width as usize;
    let mut encoder = png::Encoder::new(&mut bytes, width, height as u32);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    encoder.write_header().expect("a header").write_image_data(data).expect("samples");
    bytes
}

fn read_png(colour: png::ColorType, depth: png::BitDepth, data: &[u8]) -> Picture {
    Picture::decode(&png_of(2, colour, depth, data), PIXELS_MAX).expect("a picture")
}

#[test]
fn any_colour_type_becomes_grey_and_says_what_was_done() {
    use png::BitDepth::{Eight, Sixteen};
    use png::ColorType::{Grayscale, GrayscaleAlpha, Rgb, Rgba};
    let check = |picture: &Picture, grey: [f64; 2], conversions: &[&str]| {
        close(&picture.grey.iter().map(|value| f64::from(*value)).collect::<Vec<_>>(), &grey, 1e-3);
        assert_eq!(picture.conversions, conversions);
    };
    check(&read_png(Grayscale, Eight, &[7, 200]), [7.0, 200.0], &[]);
    check(&read_png(Rgb, Eight, &[7, 7, 7, 200, 200, 200]), [7.0, 200.0], &[]);
    check(
        &read_png(Rgb, Eight, &[255, 0, 0, 0, 100, 200]),
        [0.2126 * 255.0, 0.7152 * 100.0 + 0.0722 * 200.0],
        &["colour turned to grey by luma"],
    );
    let half = || read_png(GrayscaleAlpha, Eight, &[100, 255, 100, 51]);
    check(&half().laid_over(Ground::Black, false), [100.0, 20.0], &["transparency laid over black"]);
    check(
        &half().laid_over(Ground::White, true),
        [155.0, 31.0],
        &["transparency laid over white", "black and white exchanged"],
    );
    check(&read_png(Rgba, Eight, &[9, 9, 9, 255, 100, 100, 100, 255]), [9.0, 100.0], &[]);
    check(
        &read_png(Grayscale, Sixteen, &[0x80, 0x00, 0xff, 0xff]),
        [32768.0 / 257.0, 255.0],
        &["16 bits a sample rounded to 8"],
    );
}

/// A ramp of `pixels` resampled to `samples` of `pixels_per_sample`.
fn ramp(pixels: usize, samples: usize, pixels_per_sample: f64) -> Vec<f64> {
    let row: Vec<f32> = (0..pixels).map(|pixel| pixel as f32).collect();
    let grey: Vec<f32> = row.iter().chain(&row).copied().collect();
    let across = resample::Axis { whole: samples, skipped: 0, samples, pixels_per_sample };
    let down = resample::Axis { whole: 2, skipped: 0, samples: 2, pixels_per_sample: 1.0 };
    let resampled = resample::resample(&grey, pixels, across, down);
    assert_eq!(resampled[..samples], resampled[samples..]);
    resampled[..samples].iter().map(|value| f64::from(*value)).collect()
}

#[test]
fn a_ramp_stays_a_ramp() {
    // A pixel's value is its number, so the mean over a sample is its centre in pixels less half a pixel.
    for (samples, pixels_per_sample) in [(250, 1.0), (125, 2.0), (122, 250.0 / 122.0), (97, 2.5), (25, 10.0)] {
        let centre = |sample: usize| (sample as f64 + 0.5) * pixels_per_sample - 0.5;
        let expected: Vec<f64> = (0..samples).map(centre).collect();
        close(&ramp(250, samples, pixels_per_sample), &expected, 0.5 + 1e-4);
    }
    // An enlarged picture is held at the border.
    let expected: Vec<f64> = (0..400).map(|sample| ((f64::from(sample) + 0.5) / 4.0 - 0.5).clamp(0.0, 99.0)).collect();
    close(&ramp(100, 400, 0.25), &expected, 0.5 + 1e-4);
    // A last sample that extends past the end is the mean of the remaining pixels.
    close(&ramp(10, 4, 3.0), &[1.0, 4.0, 7.0, 9.0], 0.0);
    close(&ramp(1, 3, 0.5), &[0.0; 3], 0.0);
}

#[test]
fn shrinking_keeps_the_mean() {
    let picture = Picture::decode(&PICTURES["textures/brick.png"], PIXELS_MAX).expect("the picture");
    let axis = resample::Axis::covering(100.0, 0.4, picture.width);
    assert_eq!(axis.samples, 250);
    let samples = resample::resample(&picture.grey, picture.width, axis, axis);
    let mean = samples.iter().map(|sample| f64::from(*sample)).sum::<f64>() / samples.len() as f64;
    let expected = picture.grey.iter().map(|value| f64::from(*value)).sum::<f64>() / picture.grey.len() as f64;
    assert!((mean - expected).abs() < 0.05, "{mean} is not {expected}");
}

#[test]
fn pitches_that_do_not_divide_the_picture_reach_past_its_end() {
    let axis = |length_mm, pitch_mm| resample::Axis::covering(length_mm, pitch_mm, 512).samples;
    assert_eq!((axis(100.0, 0.4), axis(100.0, 0.3), axis(99.9, 0.3), axis(0.1, 10.0)), (250, 334, 333, 1));
}

#[test]
fn a_live_layer_is_found_whatever_was_left_out_below_it() {
    let program = compile_layers(
        "[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n\
         [[layer]]\nname = \"rest\"\nkind = \"constant\"\nfriction_n = 0.255\n\
         [[layer]]\nname = \"rain\"\nkind = \"constant\"\nblend = \"add\"\nfriction_n = 0.002\nlive = true\n",
    );
    assert_eq!(program.records.len(), 2, "the first is covered");
    assert_eq!(program.layers.records("rain"), Ok(vec![1]));
    assert_eq!(program.layers.records("3"), Ok(vec![1]));
    assert!(program.layers.records("rest").unwrap_err().to_string().contains("live = true"));
}

/// A real board bounds the voltage at each carrier, for a finger on a bridged or thin coating.
#[test]
fn the_touch_bound_of_a_board_is_the_peak_at_the_scenes_carrier() {
    let limits = Board::NUCLEO_G474RE.limits;
    let reached = |drive: &str| {
        let text =
            format!("{}[[layer]]\nkind = \"constant\"\nfriction_n = 0.25\n", HEAD.replace("# layers follow", drive));
        let scene = Scene::parse(&text, "test.toml", &BTreeMap::new()).expect("it reads");
        compile(&scene, &limits, TICK_HZ)
    };
    for (drive, expected) in [
        ("[carrier]\nfrequency_hz = 125", 28.6),
        ("", 43.8),
        ("[carrier]\nfrequency_hz = 2500", 50.0),
        ("[carrier]\nfrequency_hz = 125\n[drive]\nvoltage_max_v_peak = 28.6", 28.6),
    ] {
        let program = reached(drive).expect("it compiles");
        close(&[program.header.voltage_max_v_peak.into()], &[expected], 1e-6);
        assert!(program.header.check(&limits, TICK_HZ).is_ok());
    }
    let refused = reached("[drive]\nvoltage_max_v_peak = 49").expect_err("it is above the bound").to_string();
    assert!(refused.contains("limit of 43.8 V peak at this carrier"), "{refused}");
    let refused = reached("[drive]\nvoltage_max_v_peak = 51\n[carrier]\nfrequency_hz = 2500").expect_err("above");
    assert!(refused.to_string().contains("limit of 50 V peak: lower it"), "{refused}");
}
