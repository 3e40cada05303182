"""The contact model of Argatov and Borodich over arrays; equation numbers are those of their paper.

The paper's Fig. 4, the contact radius over the voltage for relative normal forces of both signs::

    import numpy as np
    import matplotlib.pyplot as plt
    from frixel import model

    finger = model.Contact(radius_m=8e-3, stiffness_pa_per_m=1.8e7, friction_coefficient=0.5, gap_m=10e-6)
    voltage = np.linspace(0, 1.8, 400)[:, None] * finger.voltage_scale_v_rms
    load = np.array([-20, -10, -5, -1, 0, 1, 5, 10, 20]) / np.pi * finger.load_scale_n
    plt.plot(voltage, model.eval(finger, voltage, load).contact_radius_m)

Units are SI and part of the names. A voltage is the root mean square of the drive.
"""

from __future__ import annotations

import warnings
from dataclasses import KW_ONLY, dataclass, fields
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _frixel
from ._arguments import array, check_finite, flag, real, refusal
from .errors import FrixelWarning, ParameterError

__all__ = ["Contact", "SoftContact", "States", "eval", "invert"]


@dataclass(frozen=True)
class Contact:
    """A paraboloid finger on Winkler-Fuss springs, Eqs. (1), (10) of Argatov and Borodich, on a coating.

    Parameters
    ----------
    radius_m
        Radius of curvature `R`, m: 8e-3 for a fingertip.
    stiffness_pa_per_m
        Winkler-Fuss stiffness `k`, Pa/m: 1.8e7 for a fingertip.
    friction_coefficient
        Coefficient of friction `mu`, without a unit.
    gap_m
        Effective gap of the coating and the skin, thickness over relative permittivity, m: some 5e-6. Layers in series
        add theirs.
    outer_radius_m
        Radius `b` beyond which nothing attracts, Eq. (19), m; `None` for infinity.

    Raises
    ------
    ParameterError
        A parameter is no finite number above zero.
    """

    _: KW_ONLY
    radius_m: float
    stiffness_pa_per_m: float
    friction_coefficient: float
    gap_m: float
    outer_radius_m: float | None = None

    def __post_init__(self) -> None:
        _check(self)

    @property
    def voltage_scale_v_rms(self) -> float:
        """The voltage scale `V* = sqrt(2 k g^3/eps0)`, V rms: the model's dimensionless attraction is `(V/V*)^2`."""
        return self._scales()[0]

    @property
    def friction_scale_n(self) -> float:
        """The friction scale `F* = mu pi k R g^2`, N."""
        return self._scales()[1]

    @property
    def load_scale_n(self) -> float:
        """The load scale `pi k R g^2`, N. The paper's relative force of Eq. (44) is `pi` times load over this scale."""
        return self._scales()[2]

    def _scales(self) -> tuple[float, float, float]:
        scales = _frixel.contact_scales(self)
        assert scales is not None
        return scales


@dataclass(frozen=True)
class SoftContact:
    """A finger of a soft material, Eqs. (22) to (29) of Argatov and Borodich, on a coating.

    Parameters
    ----------
    radius_m
        Radius of curvature `R`, m.
    modulus_pa
        Modulus `E`, Pa.
    stress_exponent
        Stress exponent, above 0 and at most 1, without a unit. The paper calls it `n`.
    shape_constant
        Constant `B` of Eq. (24), without a unit.
    friction_coefficient
        Coefficient of friction `mu`, without a unit.
    gap_m
        Effective gap of the coating and the skin, thickness over relative permittivity, m.

    Raises
    ------
    ParameterError
        A parameter is no finite number above zero, or `stress_exponent` is above 1.
    """

    _: KW_ONLY
    radius_m: float
    modulus_pa: float
    stress_exponent: float
    shape_constant: float
    friction_coefficient: float
    gap_m: float

    def __post_init__(self) -> None:
        _check(self)


def _check(contact: Contact | SoftContact) -> None:
    """Convert the fields to floats, and refuse values outside of the model's range."""
    for field in fields(contact):
        value = getattr(contact, field.name)
        if not (value is None and field.default is None):
            object.__setattr__(contact, field.name, real(field.name, value))
    _frixel.contact_scales(contact)


class States(NamedTuple):
    """Contacts, as arrays of one shape, or as numbers if all arguments are numbers."""

    contact_radius_m: NDArray[np.float64]
    """Contact radius `a`, m."""
    stiffness_pa_per_m: NDArray[np.float64]
    """Winkler-Fuss stiffness, Pa/m: the finger's own, or that of a soft finger at this friction."""
    friction_n: NDArray[np.float64]
    """Friction `F_T` while sliding, Eq. (21), N."""
    electric_friction_n: NDArray[np.float64]
    """The part of the friction that the voltage adds, `F_T - mu F_N`, N; computed without cancellation."""


def eval(contact: Contact | SoftContact, voltage_v_rms: ArrayLike, normal_load_n: ArrayLike = 0.0) -> States:  # noqa: A001
    """The contact at each voltage, Eqs. (36), (43) of Argatov and Borodich.

    Parameters
    ----------
    contact
        Finger and coating.
    voltage_v_rms
        Rms voltages of 0 or more, V. Any shape.
    normal_load_n
        Normal loads, N, of a shape that NumPy broadcasts with the voltages. A negative load pulls; only a `Contact`
        without an outer radius accepts one.

    Returns
    -------
    States
        Arrays of the broadcast shape. An element is NaN where there is no contact: it is pulled off, or would pass the
        outer radius, or is beyond the range of numbers.

    Raises
    ------
    ParameterError
        A voltage or load is not finite, or not accepted.

    Warns
    -----
    FrixelWarning
        A contact would be wider than the finger, where the model is not valid.
    """
    voltage, load = _broadcast(contact, {"voltage_v_rms": voltage_v_rms, "normal_load_n": normal_load_n})
    columns, doubt = _frixel.eval_contact(contact, _flat(voltage), _flat(load))
    if doubt is not None:
        warnings.warn(doubt, FrixelWarning, stacklevel=2)
    return States(*(column.reshape(voltage.shape)[()] for column in columns))


def invert(
    contact: Contact | SoftContact,
    friction_n: ArrayLike,
    normal_load_n: ArrayLike = 0.0,
    *,
    electric: bool = False,
) -> NDArray[np.float64]:
    """The voltage for each friction, the inverse of `eval`.

    Parameters
    ----------
    contact
        Finger and coating.
    friction_n
        Frictions `F_T`, N. Any shape.
    normal_load_n
        Normal loads, N, of a shape that NumPy broadcasts with the frictions.
    electric
        Whether `friction_n` is the electric friction `F_T - mu F_N`. Under a load, electric friction is a small part of
        the total, so the voltage from a total has fewer correct digits.

    Returns
    -------
    numpy.ndarray
        Rms voltages, V, of the broadcast shape. An element is NaN where no voltage has this friction: it is below the
        friction at no voltage, or on the unstable branch, or beyond the outer radius.

    Raises
    ------
    ParameterError
        A friction or load is not finite, or not accepted.
    """
    friction, load = _broadcast(contact, {"friction_n": friction_n, "normal_load_n": normal_load_n})
    voltages = _frixel.invert_contact(contact, _flat(friction), _flat(load), flag("electric", electric))
    return voltages.reshape(friction.shape)[()]


def _broadcast(contact: object, given: dict[str, ArrayLike]) -> tuple[NDArray[np.float64], ...]:
    if not isinstance(contact, (Contact, SoftContact)):
        raise refusal("contact", "a Contact or a SoftContact", contact)
    arrays = {name: array(name, values) for name, values in given.items()}
    for name, values in arrays.items():
        check_finite(name, values)
    try:
        return tuple(np.broadcast_arrays(*arrays.values()))
    except ValueError as error:
        shapes = " and ".join(f"{name} has the shape {values.shape}" for name, values in arrays.items())
        raise ParameterError(f"{shapes}, which do not broadcast: give one load, or as many as there are") from error


def _flat(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.ascontiguousarray(values).reshape(-1)
