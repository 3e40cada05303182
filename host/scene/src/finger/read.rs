//! Reads the fields of a finger profile.

use std::ops::RangeInclusive;

use frixel_layers::LAW_POINTS_MAX;

use super::{Elasticity, Evidence, Experiment, FingerProfile, MeasuredLaw, Origin};
use crate::fields::Fields;
use crate::grammar::FieldSpec;
use crate::log::Log;
use crate::mistake::FieldMistake;
use crate::profile::Profile;
use crate::tables::finger as table;

const MODELS: [(&str, bool); 2] = [("winkler-fuss", false), ("soft", true)];
/// Reads a whole table, that of a file or `[finger]` of a scene.
pub(in super::super) fn read(mut fields: Fields, log: &mut Log) -> Option<FingerProfile> {
    let is_alone = !fields.has(table::FRICTION_COEFFICIENT.name);
    let bundled = fields.raw_text("name").filter(|(_, name)| is_alone && FingerProfile::bundled(name).is_some());
    if let Some((place, name)) = bundled {
        log.add(place, FieldMistake::BundledFinger { name });
        return None;
    }
    let friction_coefficient = fields.number(log, &table::FRICTION_COEFFICIENT);
    let normal_load_n = fields.number(log, &table::NORMAL_LOAD_N);
    let origin = fields.choice_or_nearest(log, &table::ORIGIN, &Origin::WORDS).unwrap_or(Origin::Assumed);
    let (radius_mm, elasticity, skin_gap_um) = if origin == Origin::Empirical {
        (Some(0.0), law(&mut fields, log).map(Elasticity::Empirical), Some(0.0))
    } else {
        let radius_mm = fields.number(log, &table::RADIUS_MM);
        (radius_mm, elasticity(&mut fields, log), fields.number(log, &table::SKIN_GAP_UM))
    };
    let evidence = evidence(origin, &mut fields, log);
    fields.close(log);
    Some(FingerProfile {
        friction_coefficient: friction_coefficient?,
        normal_load_n: normal_load_n?,
        radius_mm: radius_mm?,
        elasticity: elasticity?,
        skin_gap_um: skin_gap_um?,
        evidence: evidence?,
    })
}

fn elasticity(fields: &mut Fields, log: &mut Log) -> Option<Elasticity> {
    let is_soft = fields.choice_or_nearest(log, &table::MODEL, &MODELS).unwrap_or(false);
    if !is_soft {
        let stiffness_pa_per_m = fields.number(log, &table::STIFFNESS_PA_PER_M)?;
        return Some(Elasticity::WinklerFuss { stiffness_pa_per_m });
    }
    let modulus_pa = fields.number(log, &table::MODULUS_PA);
    let stress_exponent = fields.number(log, &table::STRESS_EXPONENT);
    let shape_constant = fields.number(log, &table::SHAPE_CONSTANT);
    Some(Elasticity::Soft {
        modulus_pa: modulus_pa?,
        stress_exponent: stress_exponent?,
        shape_constant: shape_constant?,
    })
}

/// The law of an empirical profile.
fn law(fields: &mut Fields, log: &mut Log) -> Option<MeasuredLaw> {
    let exponent = fields.number(log, &table::EXPONENT);
    let place = fields.place(table::POINTS.name);
    let points = fields.pairs(log, &table::POINTS);
    let intervals_place = fields.place(table::INTERVALS_N.name);
    let intervals_n = fields.pairs(log, &table::INTERVALS_N);
    let law = MeasuredLaw { exponent: exponent?, points: points?, intervals_n: intervals_n? };
    let count = law.points.len();
    let Some(of_scene) = law.of_scene() else {
        let field = table::POINTS.name;
        log.add(place, FieldMistake::Count { field, found: count, min: 1, max: LAW_POINTS_MAX });
        return None;
    };
    if let Err(error) = of_scene.up_to(of_scene.voltage_max_v_rms()) {
        log.add(place, FieldMistake::Law { reason: error.to_string() });
        return None;
    }
    if law.intervals_n.len() != count {
        let (field, found) = (table::INTERVALS_N.name, law.intervals_n.len());
        log.add(intervals_place, FieldMistake::Count { field, found, min: count, max: count });
        return None;
    }
    let outside = law.points.iter().zip(&law.intervals_n).find(|((_, n), (low, high))| !(low..=high).contains(&n));
    if let Some(((_, friction_n), (low, high))) = outside {
        let reason = format!("a friction of {friction_n} N is outside its interval, {low} to {high} N");
        log.add(intervals_place, FieldMistake::Law { reason });
        return None;
    }
    Some(law)
}

fn evidence(origin: Origin, fields: &mut Fields, log: &mut Log) -> Option<Evidence> {
    match origin {
        Origin::Assumed => Some(Evidence::Assumed),
        Origin::Empirical => experiment(fields, log).map(|experiment| Evidence::Empirical { experiment }),
        Origin::Perceptual => {
            let experiment = experiment(fields, log);
            let threshold_v_rms = fields.number(log, &table::THRESHOLD_V_RMS);
            let threshold_interval_v_rms = fields.interval(log, &table::THRESHOLD_INTERVAL_V_RMS);
            Some(Evidence::Perceptual {
                experiment: experiment?,
                threshold_v_rms: threshold_v_rms?,
                threshold_interval_v_rms: threshold_interval_v_rms?,
            })
        }
        Origin::Measured => {
            let experiment = experiment(fields, log);
            let friction_coefficient_interval = fields.interval(log, &table::FRICTION_COEFFICIENT_INTERVAL);
            let electric_friction_interval_n = fields.interval(log, &table::ELECTRIC_FRICTION_INTERVAL_N);
            let voltage_max_v_rms = fields.number(log, &table::MEASURED_VOLTAGE_MAX_V_RMS);
            let normal_load_range_n = fields.interval(log, &table::MEASURED_NORMAL_LOAD_RANGE_N);
            Some(Evidence::Measured {
                experiment: experiment?,
                friction_coefficient_interval: friction_coefficient_interval?,
                electric_friction_interval_n: electric_friction_interval_n?,
                voltage_max_v_rms: voltage_max_v_rms?,
                normal_load_range_n: normal_load_range_n?,
            })
        }
    }
}

fn experiment(fields: &mut Fields, log: &mut Log) -> Option<Experiment> {
    let date = date(fields, log);
    let method = not_empty(fields, &table::METHOD, log);
    let screen = not_empty(fields, &table::SCREEN, log);
    Some(Experiment { date: date?, method: method?, screen: screen? })
}

fn date(fields: &mut Fields, log: &mut Log) -> Option<String> {
    let offset = fields.place(table::DATE.name);
    let date = fields.text(log, &table::DATE)?;
    if !is_date(&date) {
        log.add(offset, FieldMistake::Date { found: date });
        return None;
    }
    Some(date)
}

fn not_empty(fields: &mut Fields, field: &FieldSpec, log: &mut Log) -> Option<String> {
    let offset = fields.place(field.name);
    let text = fields.free_text(log, field)?;
    if text.trim().is_empty() {
        log.add(offset, FieldMistake::EmptyText { field: field.name });
        return None;
    }
    Some(text)
}

/// Whether a text is a date `YYYY-MM-DD`. Every month may have 31 days.
fn is_date(text: &str) -> bool {
    let is_number = |part: &str, digits: usize, allowed: RangeInclusive<u16>| {
        let is_plain = part.len() == digits && part.bytes().all(|byte| byte.is_ascii_digit());
        is_plain && part.parse::<u16>().is_ok_and(|number| allowed.contains(&number))
    };
    match text.split('-').collect::<Vec<_>>()[..] {
        [year, month, day] => is_number(year, 4, 0..=9_999) && is_number(month, 2, 1..=12) && is_number(day, 2, 1..=31),
        _ => false,
    }
}
