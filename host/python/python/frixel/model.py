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

from dataclasses import KW_ONLY, dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _frixel

__all__ = ["Contact", "SoftContact", "States", "eval", "invert"]


@dataclass(frozen=True)
class Contact:
    """A paraboloid finger on springs of one stiffness, Eqs. (1), (10), on a coating."""

    _: KW_ONLY
    radius_m: float
    """Radius of curvature `R`, m."""
    stiffness_pa_per_m: float
    """Winkler-Fuss stiffness `k`, Pa/m."""
    friction_coefficient: float
    """Coefficient of friction `mu`."""
    gap_m: float
    """Effective gap of the coating, thickness over relative permittivity, m; layers in series add theirs."""
    outer_radius_m: float | None = None
    """Radius `b` beyond which nothing attracts, Eq. (19), m; `None` for infinity."""

    def __post_init__(self) -> None:
        _frixel.contact_scales(self)

    @property
    def voltage_scale_v_rms(self) -> float:
        """The voltage `V* = sqrt(2 k g^3/eps0)` at which the model's one curve has the attraction 1, V rms."""
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
    """A finger of a soft material, Eqs. (22) to (29), on a coating."""

    _: KW_ONLY
    radius_m: float
    """Radius of curvature `R`, m."""
    modulus_pa: float
    """Modulus `E`, Pa."""
    stress_exponent: float
    """Stress exponent, above 0 and at most 1. The paper calls it `n`."""
    shape_constant: float
    """Dimensionless constant `B` of Eq. (24)."""
    friction_coefficient: float
    """Coefficient of friction `mu`."""
    gap_m: float
    """Effective gap of the coating, thickness over relative permittivity, m."""

    def __post_init__(self) -> None:
        _frixel.contact_scales(self)


class States(NamedTuple):
    """Contacts, as arrays of one shape; numbers if all that was given are numbers."""

    contact_radius_m: NDArray[np.float64]
    """Contact radius `a`, m."""
    stiffness_pa_per_m: NDArray[np.float64]
    """Winkler-Fuss stiffness, Pa/m: the finger's own, or that of a soft finger at this friction."""
    friction_n: NDArray[np.float64]
    """Friction `F_T` while sliding, Eq. (21), N."""
    electric_friction_n: NDArray[np.float64]
    """The part of the friction that the voltage adds, `F_T - mu F_N`, N; computed without cancellation."""


def eval(contact: Contact | SoftContact, voltage_v_rms: ArrayLike, normal_load_n: ArrayLike = 0.0) -> States:  # noqa: A001
    """The contact at each voltage, Eqs. (36), (43).

    Parameters
    ----------
    contact
        Finger and coating.
    voltage_v_rms
        Rms voltages of 0 or more, V. Any shape.
    normal_load_n
        Normal loads, N, of a shape that NumPy broadcasts with the voltages. A negative load pulls; only a `Contact`
        without an outer radius takes one.

    Returns
    -------
    States
        Arrays of the broadcast shape. An element is not a number where there is no contact: it is pulled off, or would
        pass the outer radius, or is beyond the range of numbers.

    Raises
    ------
    ParameterError
        A voltage or load is not finite, or not taken.
    """
    voltage, load = np.broadcast_arrays(_real(voltage_v_rms), _real(normal_load_n))
    columns = _frixel.eval_contact(contact, _flat(voltage), _flat(load))
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
        Whether `friction_n` is the electric friction `F_T - mu F_N`. Under a load it is small beside the total, so that
        the voltage of a total has fewer digits.

    Returns
    -------
    numpy.ndarray
        Rms voltages, V, of the broadcast shape. An element is not a number where no voltage has this friction: it is
        below the friction at no voltage, or on the unstable branch, or beyond the outer radius.

    Raises
    ------
    ParameterError
        A friction or load is not finite, or not taken.
    """
    friction, load = np.broadcast_arrays(_real(friction_n), _real(normal_load_n))
    voltages = _frixel.invert_contact(contact, _flat(friction), _flat(load), electric)
    return voltages.reshape(friction.shape)[()]


def _real(values: ArrayLike) -> NDArray[np.float64]:
    return np.asarray(values, dtype=np.float64)


def _flat(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.ascontiguousarray(values).reshape(-1)
