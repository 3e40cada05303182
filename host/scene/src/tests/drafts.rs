//! Drafts of scenes that a board refuses.

use super::*;

fn refusal(draft: &Program) -> String {
    draft.refusals().next().expect("a refusal").to_string()
}

/// Scenes that a board refuses play as drafts, clamped to what can be reached. The corpus has the board's sentences.
#[test]
fn drafts() {
    let draft = |layers: &str| {
        let scene = Scene::parse(format!("{HEAD}{layers}"), "test.toml", &*PICTURES).expect("it reads");
        assert!(compile(&scene, &LIMITS, TICK_HZ).is_err(), "{layers}");
        let program = compile_draft(&scene, &LIMITS, TICK_HZ).expect("a draft plays it");
        assert!(program.is_draft());
        program
    };
    let reach = draft("[[layer]]\nkind = \"constant\"\nfriction_n = 0.9\n");
    assert_eq!(reach.records.len(), 1);

    let bytes = draft(
        "[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 100\n\
         pitch_mm = 0.1\nwhite_n = 0.01\n",
    );
    let samples: usize = bytes.bitmaps.iter().map(|bitmap| bitmap.samples.len()).sum();
    assert!((30_000..=65_536).contains(&samples), "{samples} bytes");

    let noise = "[[layer]]\nkind = \"noise\"\nblend = \"add\"\nwavelength_min_mm = 1\nwavelength_max_mm = 4\nlow_n = 0\n\
                 high_n = 0.001\n";
    let time = draft(&noise.repeat(5));
    assert_eq!((time.records.len(), time.notes().count()), (5, 0));

    let absent = draft(
        "[[layer]]\nname = \"wood\"\nkind = \"bitmap\"\npicture = \"wood.png\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 9\n",
    );
    assert_eq!(absent.notes().collect::<Vec<_>>(), ["absent from this draft: layer 1 \"wood\""]);

    let off = draft(
        "[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n\
         region = { shape = \"ellipse\", x_mm = 100, y_mm = -10, width_mm = 40, height_mm = 20 }\n\
         [[layer]]\nkind = \"constant\"\nfriction_n = 0.26\nregion = { x_mm = -5, y_mm = 100, width_mm = 20, height_mm = 90 }\n",
    );
    assert_eq!(off.records.len(), 2);
    let header = off.header.write(2, off.points.len() as u8);
    let whole: Vec<u8> = header.into_iter().chain(off.scene_bytes().into_iter().skip(header.len())).collect();
    let parsed = frixel_layers::Scene::parse(&whole);
    assert!(parsed.is_ok(), "{parsed:?}");
}

/// A draft lowers its voltage to what the board's current and the finger's contact allow.
#[test]
fn drafts_keep_to_the_limits_of_the_drive() {
    let draft = |head: &str| {
        let scene = Scene::parse(head, "test.toml", &*PICTURES).expect("it reads");
        compile_draft(&scene, &LIMITS, TICK_HZ).expect("a draft plays it")
    };
    let current =
        draft(&HEAD.replace("# layers follow", "[drive]\nvoltage_max_v_rms = 180\n[carrier]\nfrequency_hz = 5000"));
    assert_eq!(current.refusals().count(), 1);
    assert!((135.0..145.0).contains(&current.reach.voltage_max_v_rms), "{:?}", current.reach);
    let fast = draft(&HEAD.replace("# layers follow", "[carrier]\nfrequency_hz = 6000"));
    assert_eq!((fast.refusals().count(), fast.carrier.half_period_ticks), (1, 4));
    let wide = draft(
        "version = 1\n[screen]\nwidth_mm = 100\nheight_mm = 80\n[finger]\nfriction_coefficient = 0.5\n\
                      normal_load_n = 0.5\nradius_mm = 8\nstiffness_pa_per_m = 1.8e7\nskin_gap_um = 0\n",
    );
    assert!(refusal(&wide).contains("a skin gap is missing"), "{}", refusal(&wide));
    assert!(wide.reach.voltage_max_v_rms < 100.0, "{:?}", wide.reach);
}

#[test]
fn what_cannot_be_read_is_no_draft() {
    let text = format!("{HEAD}[[layer]]\nkind = \"constant\"\nfrction_n = 0.26\n");
    let scene = Scene::parse(&text, "test.toml", &*PICTURES).expect("its head reads");
    let refused = compile_draft(&scene, &LIMITS, TICK_HZ).expect_err("a layer has a misspelt field");
    assert_eq!(refused, compile(&scene, &LIMITS, TICK_HZ).expect_err("a board refuses it, too"));
}
