//! Contact model of an electrovibration touchscreen: computes the voltage for a friction on a finger, and the friction
//! that a voltage causes.
//!
//! Start at [`InverseTable::of_finger`]. It builds the table that a device reads in every tick: from electric friction
//! in newtons to volts, without root or division. It takes 2 KB and is built without `f64`.
//!
//! ```
//! use frixel_model::{Finger, InverseTable, Ripple};
//! // 10 um of coating, 0.5 N of load, an ideal square carrier, at most 150 V, no limit on the friction.
//! let table = InverseTable::of_finger(&Finger::<f32>::EXAMPLE, 10e-6, 0.5, &Ripple::NONE, 150.0, f32::INFINITY)?;
//! let voltage_v_rms = table.voltage_v_rms(0.02);
//! assert!((voltage_v_rms - 128.0).abs() < 0.5);
//! # Ok::<(), frixel_model::TableError>(())
//! ```
//!
//! On a desktop, [`Contact`] evaluates the model itself: create it from a finger and a coating, apply a load, then
//! evaluate it at a voltage or a friction.
//!
//! The crate is `no_std`, does not allocate or panic, and gives the same bits on a desktop and on a microcontroller.
//! Units are SI and part of the names; a voltage is the root mean square of the drive. The crate works with the
//! **electric friction** `F_T - mu F_N` throughout: under a load it is small compared to the total friction, and a
//! difference of totals would lose its precision.
//!
//! The model is by I.I. Argatov and F.M. Borodich, "A macro model for electroadhesive contact of a soft finger with a
//! touchscreen"; equation numbers are theirs. Beyond the paper, [`Carrier`] models the losses between the DAC and the
//! electrode, and [`TouchBound`] the largest voltage at which the electrode is safe to touch, even through a bridged or
//! thin coating.
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
//! | (30), (44), the groups under (36) | [`Contact::attraction`], [`Contact::load`], [`Contact::area`] |
//! | the curve of (36) in these groups | [`Contact::universal`] |
//! | (37)-(39), (42) | [`LowerBound`] |
//! | (40), (41) | [`SoftLowerBound`] |
//! | (43), (21) | [`LoadedContact`]; [`PulledContact`] for negative loads; [`Contact::normal_load_n`] |
//! | (45)-(47) | [`PowerLawShape`] |
//! | (48) and the text above it | [`TissueSpring`] |
//!
//! # Accuracy
//!
//! The tests compare the results with 80-digit arithmetic on the paper's dimensional equations (`reference/`); each
//! test is also shown to fail when the output is forced to zero. `docs/inside/model.md` lists how much of each bound is
//! used. The bounds are relative to the result. They hold for every input for which the results, and for a soft finger
//! also `F_T/(mu B E R^2)`, are in the normal range of the precision:
//!
//! | | f64 | f32 |
//! |---|---|---|
//! | [`LoadedContact`], [`PulledContact`], [`LowerBound`], forward and inverse | 4e-15 | 1e-6 |
//! | [`FiniteContact`] | 4e-14 | 1e-6 |
//! | [`SoftLoadedContact`], [`SoftLowerBound`], stress exponents from 0.02 | 4e-14 | 1e-5 |
//! | [`Sensitivity`] of all of them, with the square of the factor below | 4e-14 | 1e-5 |
//! | capacitance, pull-off, onset of slip | 4e-15 | 1e-6 |
//!
//! The bound of an ill-conditioned result is multiplied by `max(1, c/12)`. The condition number `c` is the sum of the
//! relative sensitivities of the result to voltage or friction, load, stiffness, coating, radius and outer radius.
//! Without a pull `c` is at most 10. Under a pull it grows as `q/(y - q)` towards pull-off; a voltage computed from a
//! *total* friction has `c = 12 F_T/(F_T - mu F_N)`.
//!
//! # Where the paper's text and its equations differ
//!
//! - Section VI.A compares lower bounds, and states that Eq. (34) gives `F_T ~ sigma0^2` as `sigma0 -> 0`. This is true
//!   of Eq. (42) instead. Eqs. (34), (36) begin with `F_T = 2 pi mu R g sigma0`, slope 1, because the attraction around
//!   the contact dominates at low voltage; with an outer radius this is multiplied by `beta/(1 + beta)`:
//!
//!   | `q` | slope of (34), (36) in `sigma0` | slope of (42) | (34), (36) over (42) |
//!   |---|---|---|---|
//!   | 1e-6 | 1.0007 | 2 | 500,707 |
//!   | 1e-3 | 1.0214 | 2 | 522 |
//!   | 0.1 | 1.158 | 2 | 7.24 |
//!   | 1 | 1.561 | 2 | 1.457 |
//!   | 10 | 1.983 | 2 | 1.009 |
//!   | 1e3 | 1.999998 | 2 | 1.000001 |
//! - "The solution to Eqs. (21) and (44)", under Eq. (44), should read Eqs. (21) and (43): (44) only defines a
//!   dimensionless group.
//! - Eq. (44) scales the load by `k R h0^2`. The dimensionless curve uses `pi k R (h0/eps)^2`: `f_N = n pi/eps^2`.
//! - Eq. (22) allows a stress exponent of 0, but Eq. (24) contains its reciprocal. This crate refuses zero.
//!
//! Print these figures and those of the next section with
//! `cargo test -p frixel-model --test main documented -- --nocapture`.
//!
//! # What friction can and cannot identify
//!
//! Friction as a function of voltage and load depends only on the coefficient of friction `mu`, the friction scale
//! `F* = mu pi k R g^2` and the voltage scale `V* = sqrt(2 k g^3/eps0)`. Twice the gap and twice the radius with an
//! eighth of the stiffness give the same friction at every voltage and load, over a contact of twice the radius. A
//! measured contact radius also identifies the product `R g`; a measured capacitance, the outer radius and `R`.
//!
//! Where the load dominates, the electric friction is `2 F* sqrt(n) (V/V*)^2`, and data identify only `mu` and `F*
//! sqrt(n)/V*^2`; only the departure from that square law separates the two scales. For the example finger (8 mm, 1.8e7
//! Pa/m, 10 um, 0.5 N: `n` is 11,052) the departure is 1 % at 1 V, 5.6 % at 150 V, 9.9 % at 200 V: the first 1 % is
//! present at any small voltage and is itself a square law. If the noise exceeds the rest, the data identify only that
//! ratio, and a fit must report so.
//!
//! ```
//! use frixel_model::{Contact, ContactModel, Finger};
//! let one = Finger::<f64>::EXAMPLE;
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
mod division;
mod double_single;
mod empirical;
mod error;
mod finger;
mod friction_law;
mod real;
mod ripple;
mod root;
mod shear;
mod soft;
mod state;
mod table;
mod touch_current;

pub use carrier::{Carrier, ElectrodeCurrent, Waveform};
pub use coating::{Slab, VACUUM_PERMITTIVITY_F_PER_M, attraction_pa, contact_attraction_pa, effective_gap_m};
pub use contact::{CarriedContact, Contact, FiniteContact, LoadedContact, LowerBound, PulledContact};
pub use division::divide_wide;
pub use empirical::{EmpiricalLaw, LawError, LawPoint};
pub use error::{Expected, InverseError, ParameterError, StateError};
pub use finger::Finger;
pub use fixed::types::{U0F32, U1F31};
pub use friction_law::{FrictionLaw, MeasuredFriction};
pub use real::Real;
pub use ripple::Ripple;
pub use shear::{ShearOnset, TissueSpring};
pub use soft::{PowerLawShape, SoftContact, SoftFinger, SoftLoadedContact, SoftLowerBound, contact_exponent};
pub use state::{ContactModel, ContactState, Sensitivity};
pub use table::{
    EmpiricalTableFilling, FixedTable, InverseTable, InverseTableFilling, Precision, SizedTable, TableBuilder,
    TableError, TableShape,
};
pub use touch_current::{
    Coating, SINGLE_FAULT_CURRENT_MAX_A_PEAK, TOUCH_CURRENT_MAX_A_PEAK, TouchBound, TouchCurrent, TouchPath,
};
