//! The results of `frixel check` for a scene.

use std::collections::BTreeMap;

use frixel_felt::check::{SceneCheck, feel};
use frixel_felt::judge::{Advice, Judgement};
use frixel_hil_sim::{RigConfig, WorldOptions};
use frixel_play::{SimulationError, TO_THE_END, board_costs, judge};
use frixel_scene::{Scene, Screen};
use serde_json::{Value, json};
use toml::de::DeValue;

use crate::answer::{problems, problems_of};
use crate::host_error::HostError;
use crate::layer_text;
use crate::layers::layers;
use crate::program::{drafted, touch_source};
use crate::request::Request;

/// Checks the scene of a request, as JSON: `ok` and `problems`; and for a scene without mistakes, or one that plays as
/// a draft (`isDraft`), also `screen`, `layers`, `defaults` (of each file, for `layer_text::read`), `report` (the text
/// of `frixel check`), and in newtons `lowN`,
/// `highN` (what the scene asks for), `reachN` and `naturalN`.
pub fn check(request: &Request) -> Value {
    answer(request, true)
}

/// The same without what is felt, which takes most of the time.
pub fn compile(request: &Request) -> Value {
    answer(request, false)
}

fn answer(request: &Request, is_judged: bool) -> Value {
    match checked(request, is_judged) {
        Ok(answer) => answer,
        Err(HostError::Program(error)) => json!({ "ok": false, "problems": problems(&error, &request.entry) }),
        Err(error) => crate::answer::error(&error, &request.entry),
    }
}

fn checked(request: &Request, is_judged: bool) -> Result<Value, HostError> {
    // The simulated board has the limits of the smallest board.
    let config = RigConfig::default();
    let (scene, program) = drafted(request)?;
    let touch = touch_source(request)?;
    let problems = problems_of(&program, &request.entry);
    let costs = match board_costs(&program, &config.for_drafts()) {
        // Not even the simulator plays it.
        Err(SimulationError::Refused(_)) if program.is_draft() => {
            return Ok(json!({ "ok": false, "problems": problems }));
        }
        costs => costs?,
    };
    let judgement = if is_judged {
        let world = WorldOptions { touch: Some(touch), ..WorldOptions::default() };
        judge(&program, &config, &world, Advice::Sought, TO_THE_END)?
    } else {
        Judgement::default()
    };
    let check = SceneCheck::of(&program, &config.board.limits, &costs, judgement);
    let draft = program.is_draft().then(|| ("draft", "clamped: a board refuses it".to_owned()));
    let report: Vec<feel::Line> = draft.into_iter().chain(check.lines(true)).collect();
    Ok(json!({
        "ok": !program.is_draft(),
        "isDraft": program.is_draft(),
        "problems": problems,
        "screen": screen(&scene),
        "layers": layers(&scene, &request.entry, &program, &check.judgement),
        "defaults": defaults(&scene),
        "report": report,
        "lowN": check.targets.least_n,
        "highN": check.targets.most_n,
        "reachN": check.reach.total_max_n,
        "naturalN": check.reach.natural_n,
    }))
}

fn screen(scene: &Scene) -> Value {
    let Screen { width_mm, height_mm, .. } = scene.screen();
    json!({ "widthMm": width_mm, "heightMm": height_mm, "pixelMm": scene.pixel_mm() })
}

fn defaults(scene: &Scene) -> BTreeMap<&str, String> {
    let as_json = |(name, defaults)| (name, layer_text::json(&DeValue::Table(defaults)));
    scene.layer_defaults().into_iter().map(as_json).collect()
}
