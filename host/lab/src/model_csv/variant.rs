//! The variants of the model by name, each built from the cells of a row.

use frixel_model::{Contact, ContactModel, ContactState, Finger, Slab, SoftContact, SoftFinger, effective_gap_m};

use super::WIDER_THAN_FINGER;
use super::columns::{
    COATING, FRICTION_COEFFICIENT, MODULUS, NORMAL_FORCE, OUTER_RADIUS, PERMITTIVITY, RADIUS, SHAPE_CONSTANT,
    STIFFNESS, STRESS_EXPONENT, VARIANT,
};
use super::error::Refusal;
use super::number::Number;
use super::row::Row;

/// Names of all variants.
const VARIANTS: [&str; 7] =
    ["wf-upper", "wf-lower", "wf-loaded", "wf-finite", "soft-upper", "soft-lower", "soft-loaded"];

/// The contact model of a row.
pub(super) struct Model<T> {
    pub(super) contact: Box<dyn ContactModel<T>>,
    pub(super) radius_m: T,
    pub(super) gap_m: T,
    /// Stiffness of a Winkler-Fuss finger; zero for a soft finger, whose stiffness is not constant.
    pub(super) stiffness_pa_per_m: T,
}

impl<T: Number> Model<T> {
    /// The status of a row with this contact.
    pub(super) fn status_of(&self, state: &ContactState<T>) -> &'static str {
        if state.contact_radius_m > self.radius_m { WIDER_THAN_FINGER } else { "ok" }
    }

    pub(super) fn read(row: &Row) -> Result<Self, Refusal> {
        row.cells.check_length()?;
        let variant = row.text(VARIANT);
        if !VARIANTS.contains(&variant.as_ref()) {
            let (row, found) = (row.cells.number(), row.quoted(VARIANT));
            let names = VARIANTS.join(", ");
            return Err(Refusal(format!("row {row}, column variant: expected one of {names}, found {found:?}")));
        }
        let radius_m = row.real(RADIUS)?;
        let (thickness_m, relative_permittivity) = (row.real(COATING)?, row.real(PERMITTIVITY)?);
        let gap_m = effective_gap_m(&[Slab { thickness_m, relative_permittivity }])?;
        let (contact, stiffness_pa_per_m): (Box<dyn ContactModel<T>>, T) = match variant.as_ref() {
            "soft-upper" => (Box::new(soft(row, radius_m, gap_m)?.under_load(T::ZERO)?), T::ZERO),
            "soft-lower" => (Box::new(soft(row, radius_m, gap_m)?.lower_bound()), T::ZERO),
            "soft-loaded" => (Box::new(soft(row, radius_m, gap_m)?.under_load(row.real(NORMAL_FORCE)?)?), T::ZERO),
            on_springs => winkler_fuss(row, on_springs, radius_m, gap_m)?,
        };
        Ok(Self { contact, radius_m, gap_m, stiffness_pa_per_m })
    }
}

fn soft<T: Number>(row: &Row, radius_m: T, gap_m: T) -> Result<SoftContact<T>, Refusal> {
    let finger = SoftFinger {
        radius_m,
        modulus_pa: row.real(MODULUS)?,
        stress_exponent: row.real(STRESS_EXPONENT)?,
        shape_constant: row.real(SHAPE_CONSTANT)?,
        friction_coefficient: row.real(FRICTION_COEFFICIENT)?,
    };
    Ok(finger.on_gap(gap_m)?)
}

type OnSprings<T> = (Box<dyn ContactModel<T>>, T);

fn winkler_fuss<T: Number>(row: &Row, variant: &str, radius_m: T, gap_m: T) -> Result<OnSprings<T>, Refusal> {
    let stiffness_pa_per_m = row.real(STIFFNESS)?;
    let finger = Finger { radius_m, stiffness_pa_per_m, friction_coefficient: row.real(FRICTION_COEFFICIENT)? };
    let contact = Contact::new(&finger, gap_m)?;
    let contact: Box<dyn ContactModel<T>> = match variant {
        "wf-lower" => Box::new(contact.lower_bound(row.real_or_zero(NORMAL_FORCE)?)?),
        "wf-finite" => Box::new(contact.within(row.real(OUTER_RADIUS)?, row.real_or_zero(NORMAL_FORCE)?)?),
        "wf-loaded" => {
            let normal_load_n: T = row.real(NORMAL_FORCE)?;
            if normal_load_n < T::ZERO {
                Box::new(contact.under_pull(-normal_load_n)?)
            } else {
                Box::new(contact.under_load(normal_load_n)?)
            }
        }
        _ => Box::new(contact.under_load(T::ZERO)?),
    };
    Ok((contact, stiffness_pa_per_m))
}
