//! Contact model of an electrovibration touchscreen: what friction a voltage gives to a finger, and what voltage gives a
//! friction.
//!
//! The model is that of I.I. Argatov and F.M. Borodich, "A macro model for electroadhesive contact of a soft finger with a
//! touchscreen"; equation numbers are theirs. It is `no_std`, does not allocate, does not panic, and gives the same bits
//! on a desktop and on a microcontroller. Units are SI and stand in the names; a voltage is the root mean square of the
//! drive.
//!
//! Start at [`Contact`]: a finger and a coating, then a load, then a voltage or a friction. On a device, [`InverseTable`]
//! answers without root or division. The **electric friction** `F_T - mu F_N` is the quantity throughout: under a load the
//! drive adds a little to much, and the difference of totals would lose it.
//! [`Carrier`], which is not of the paper, has what the drive loses on its way to the electrode.
//!
//! # Where each equation is
//!
//! | Equations | Item |
//! |---|---|
//! | (1), (2) | [`Finger::profile_m`] |
//! | (3), (18) with (4), (12) | [`attraction_pa`] |
//! | (5), (11) | the gap in [`Contact::capacitance_f`] |
//! | (6), (15), (17) | [`Finger::approach_m`] |
//! | (7), (10), (13), (14) | [`Finger::contact_pressure_pa`] |
//! | (8) | [`contact_attraction_pa`] |
//! | (9), (16), (19), (21) | [`FiniteContact`], from [`Contact::within`] |
//! | (20), (21) | `friction_n` of [`ContactState`] |
//! | (22), (23) | [`contact_exponent`] |
//! | (24) | [`SoftFinger::normal_load_n`] |
//! | (25) | [`Finger::normal_load_n`] |
//! | (26), (29) | [`SoftFinger::stiffness_pa_per_m`] |
//! | (27), (28), (34)-(36) | [`LoadedContact`] without load, the upper bound |
//! | (27)-(33) | [`SoftLoadedContact`] without load |
//! | (29) with (43), beyond the paper | [`SoftLoadedContact`] |
//! | (30), (44), the groups under (36) | [`Contact::attraction`], [`Contact::load`], [`Contact::area`], [`Contact::universal`] |
//! | (37)-(39), (42) | [`LowerBound`] |
//! | (40), (41) | [`SoftLowerBound`] |
//! | (43), (21) | [`LoadedContact`]; [`PulledContact`] for negative loads; [`Contact::normal_load_n`] |
//! | (45)-(47) | [`PowerLawShape`] |
//! | (48) and the text above it | [`TissueSpring`] |
//!
//! # Accuracy
//!
//! Held in the tests against 80-digit arithmetic on the paper's dimensional equations (`reference/`), each test also seen
//! to fail with its output forced to zero. How much of each bound is used stands in `docs/model.md`. Relative to the answer,
//! for every input that keeps answers in the precision's normal range, and with them `F_T/(mu B E R^2)` of a soft finger:
//!
//! | | f64 | f32 |
//! |---|---|---|
//! | [`LoadedContact`], [`PulledContact`], [`LowerBound`], forward and inverse | 4e-15 | 1e-6 |
//! | [`FiniteContact`] | 4e-14 | 1e-6 |
//! | [`SoftLoadedContact`], [`SoftLowerBound`], stress exponents from 0.02 | 4e-14 | 1e-5 |
//! | [`Sensitivity`] of all of them, with the square of the factor below | 4e-14 | 1e-5 |
//! | capacitance, pull-off, onset of slip | 4e-15 | 1e-6 |
//!
//! An answer that is ill-conditioned has its bound multiplied by `max(1, c/12)`, with the condition number `c`: the sum of
//! its relative changes over those of voltage or friction, load, stiffness, coating, radius and outer radius. Without a
//! pull `c` is at most 10. Under a pull it grows as `q/(y - q)` towards pull-off; a voltage from a *total* friction
//! has `c = 12 F_T/(F_T - mu F_N)`.
//!
//! # Where the paper's text and its equations part
//!
//! - Section VI.A compares lower bounds, and says that Eq. (34) gives `F_T ~ sigma0^2` as `sigma0 -> 0`. It is Eq. (42) that
//!   does. Eqs. (34), (36) begin with `F_T = 2 pi mu R g sigma0`, slope 1, because the attraction around the contact comes
//!   first; with an outer radius the same times `beta/(1 + beta)`:
//!
//!   | `q` | slope of (34), (36) in `sigma0` | slope of (42) | (34), (36) over (42) |
//!   |---|---|---|---|
//!   | 1e-6 | 1.0007 | 2 | 500,707 |
//!   | 1e-3 | 1.0214 | 2 | 522 |
//!   | 0.1 | 1.158 | 2 | 7.24 |
//!   | 1 | 1.561 | 2 | 1.457 |
//!   | 10 | 1.983 | 2 | 1.009 |
//!   | 1e3 | 1.999998 | 2 | 1.000001 |
//! - "The solution to Eqs. (21) and (44)", under Eq. (44), is that to Eqs. (21) and (43): (44) only defines a group.
//! - Eq. (44) scales the load by `k R h0^2`. On the one core line it is `pi k R (h0/eps)^2`: `f_N = n pi/eps^2`.
//! - Eq. (22) allows the stress exponent 0; Eq. (24) has its reciprocal. Zero is refused.
//!
//! These figures, and those of the next section: `cargo test -p frixel-model --test documented -- --nocapture`.
//!
//! # What friction can and cannot identify
//!
//! Friction over voltage and load depends on the coefficient of friction `mu`, the friction scale `F* = mu pi k R g^2` and
//! the voltage scale `V* = sqrt(2 k g^3/eps0)`, and on nothing else: twice the gap and the radius with an eighth of the
//! stiffness is the same friction everywhere, over a contact of twice the radius. A measured contact radius adds the product
//! `R g`, a measured capacitance the outer radius and `R`.
//!
//! Where the load dominates, `x = 2 F* sqrt(n) (V/V*)^2` and data give `mu` and `F* sqrt(n)/V*^2` only; the scales part in
//! the departure from that square law. For the example finger (8 mm, 1.8e7 Pa/m, 10 um, 0.5 N: `n` is 11,052) it is 1 % at
//! 1 V, 5.6 % at 150 V, 9.9 % at 200 V: the first 1 % is there at any small voltage and still a square law; data noisier than
//! the rest tell one number, and a fit must say so.
//!
//! ```
//! use frixel_model::{Contact, ContactModel, Finger};
//! let one = Finger { radius_m: 8e-3, stiffness_pa_per_m: 1.8e7, friction_coefficient: 0.5 };
//! let other = Finger { radius_m: 16e-3, stiffness_pa_per_m: 2.25e6, friction_coefficient: 0.5 };
//! let one = Contact::new(&one, 10e-6)?.under_load(0.5)?.state(150.0)?;
//! let other = Contact::new(&other, 20e-6)?.under_load(0.5)?.state(150.0)?;
//! assert!((other.friction_n / one.friction_n - 1.0_f64).abs() < 1e-14);
//! assert!((other.contact_radius_m / one.contact_radius_m - 2.0_f64).abs() < 1e-14);
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
#![no_std]
#![forbid(unsafe_code)]

mod carrier;
mod coating;
mod contact;
mod double_single;
mod error;
mod finger;
mod real;
mod root;
mod shear;
mod soft;
mod state;
mod table;

pub use carrier::{Carrier, ElectrodeCurrent, Waveform};
pub use coating::{Slab, VACUUM_PERMITTIVITY_F_PER_M, attraction_pa, contact_attraction_pa, effective_gap_m};
pub use contact::{Contact, FiniteContact, LoadedContact, LowerBound, PulledContact};
pub use error::{Expected, InverseError, ParameterError, StateError};
pub use finger::Finger;
pub use fixed::types::{U0F32, U1F31};
pub use real::Real;
pub use shear::{ShearOnset, TissueSpring};
pub use soft::{PowerLawShape, SoftContact, SoftFinger, SoftLoadedContact, SoftLowerBound, contact_exponent};
pub use state::{ContactModel, ContactState, Sensitivity};
pub use table::{
    FixedTable, InverseTable, InverseTableFilling, Precision, SizedTable, TableBuilder, TableError, TableShape,
};
