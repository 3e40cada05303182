//! The contact model in 256 bits: what the report measures errors against.
//!
//! Written from the paper's dimensional equations, and not from the dimensionless ones that the model itself solves.

mod soft;
mod springs;

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;

pub(super) use soft::Soft;
pub(super) use springs::Springs;

/// A number of 77 decimal digits.
pub(super) type Wide = FBig<HalfEven, 2>;

const BITS: usize = 256;

/// A finite number, exactly.
fn wide(value: f64) -> Wide {
    let exact: Wide = FBig::try_from(value).unwrap_or(FBig::ZERO);
    exact.with_precision(BITS).value()
}

fn pi() -> Wide {
    FBig::pi(BITS)
}

/// Vacuum permittivity in F/m, CODATA 2022: exactly the decimal number.
fn vacuum_permittivity() -> Wide {
    wide(88_541_878_188.0) / wide(1e22)
}

/// Contact attraction `sigma0` at a voltage, Eq. (8).
fn contact_attraction(voltage: &Wide, gap: &Wide) -> Wide {
    vacuum_permittivity() * voltage * voltage / (wide(2.0) * gap * gap)
}

/// Positive root of Eq. (43) for the contact attraction: `balance = F_T/mu - F_N` is given, and so is `area = a^2`.
///
/// With `s = sigma0/(g k)` the equation is `balance = pi area sigma0 + 2 pi sigma0 R g/(1 + s)`, a quadratic in `sigma0`.
fn attraction_of(balance: &Wide, area: &Wide, stiffness: &Wide, radius: &Wide, gap: &Wide) -> Wide {
    let spring = gap * stiffness;
    let square = pi() * area / &spring;
    let linear = pi() * area + wide(2.0) * pi() * radius * gap - balance / &spring;
    let root = (&linear * &linear + wide(4.0) * &square * balance).sqrt();
    (root - linear) / (wide(2.0) * square)
}

/// Voltage of a contact attraction, Eq. (8).
fn voltage_of(attraction: &Wide, gap: &Wide) -> Wide {
    (wide(2.0) * gap * gap * attraction / vacuum_permittivity()).sqrt()
}

/// How far `found` is from what is right, relative to it; infinite for what is no number.
pub(super) fn relative_error(found: f64, right: &Wide) -> f64 {
    if found.is_finite() { ((wide(found) - right) / right).to_f64().value().abs() } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_are_right_to_their_last_digit() {
        let digits = "3.14159265358979323846264338327950288419716939937510582097494459230781640628620899";
        assert!(pi().to_decimal().value().to_string().starts_with(&digits[..76]));
        assert_eq!(
            vacuum_permittivity().to_f64().value().to_bits(),
            frixel_model::VACUUM_PERMITTIVITY_F_PER_M.to_bits()
        );
    }
}
