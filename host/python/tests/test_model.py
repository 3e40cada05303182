"""The contact model over arrays."""

from __future__ import annotations

import math
import pickle
import sys
import threading

import numpy as np
import pytest
from frixel import FrixelError, FrixelWarning, ParameterError, model

FINGER = model.Contact(radius_m=8e-3, stiffness_pa_per_m=1.8e7, friction_coefficient=0.5, gap_m=10e-6)
SOFT = model.SoftContact(
    radius_m=8e-3, modulus_pa=2e5, stress_exponent=0.5, shape_constant=1.0, friction_coefficient=0.5, gap_m=10e-6
)


def closed_form(voltage: float, load: float) -> tuple[float, float]:
    """Contact radius and friction by Eqs. (8), (43), (21) with g = h0/eps, term by term."""
    eps0, k, r, g, mu = 8.8541878188e-12, 1.8e7, 8e-3, 10e-6, 0.5
    q = eps0 * voltage**2 / (2 * g**3 * k)
    n = load / (math.pi * k * r * g**2)
    y = q + math.sqrt(q * q + 2 * q / (1 + q) + n)
    return math.sqrt(2 * r * g * y), mu * math.pi * k * r * g**2 * y * y


@pytest.mark.parametrize("load", [0.0, 0.1, 0.5, -1e-5])
def test_radius_and_friction_are_those_of_the_paper(load: float) -> None:
    voltages = np.linspace(40, 200, 9)
    states = model.eval(FINGER, voltages, load)
    expected = np.array([closed_form(voltage, load) for voltage in voltages])
    np.testing.assert_allclose(states.contact_radius_m, expected[:, 0], rtol=1e-12)
    np.testing.assert_allclose(states.friction_n, expected[:, 1], rtol=1e-12)
    np.testing.assert_allclose(states.friction_n - states.electric_friction_n, 0.5 * load, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("contact", [FINGER, SOFT])
def test_the_inverse_gives_the_voltage_back(contact: model.Contact | model.SoftContact) -> None:
    voltages = np.geomspace(1, 200, 50)
    loads = np.array([[0.0], [0.2], [0.5]])
    states = model.eval(contact, voltages, loads)
    assert states.friction_n.shape == (3, 50)
    inverse = model.invert(contact, states.electric_friction_n, loads, electric=True)
    np.testing.assert_allclose(inverse, np.broadcast_to(voltages, (3, 50)), rtol=1e-12)
    total = model.invert(contact, states.friction_n[:, -1], loads[:, 0])
    np.testing.assert_allclose(total, 200, rtol=1e-9)


def test_numbers_give_numbers_and_strided_arrays_their_shape() -> None:
    assert float(model.eval(FINGER, 150).friction_n) == pytest.approx(closed_form(150, 0)[1], rel=1e-12)
    assert isinstance(model.invert(FINGER, 0.3, 0.5), float)
    table = np.arange(12.0).reshape(3, 4).T[::2]
    np.testing.assert_array_equal(model.eval(FINGER, table).friction_n, model.eval(FINGER, table.copy()).friction_n)
    assert model.eval(FINGER, []).friction_n.shape == (0,)


def test_where_nothing_is_there_is_no_number() -> None:
    assert np.isnan(model.eval(FINGER, 1.0, -1.0).friction_n), "pulled off"
    assert np.isnan(model.invert(FINGER, 0.1, 0.5)), "below the friction at no voltage"
    inside = model.Contact(
        radius_m=8e-3, stiffness_pa_per_m=1.8e7, friction_coefficient=0.5, gap_m=10e-6, outer_radius_m=1e-3
    )
    states = model.eval(inside, [1, 10_000])
    assert np.isfinite(states.friction_n[0])
    assert np.isnan(states.friction_n[1]), "it passes the outer radius"


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: model.eval(FINGER, -1), "voltage_v_rms must be finite and not below zero, but is -1e0"),
        (lambda: model.eval(FINGER, [1, np.nan]), "voltage_v_rms[1] must be finite, but is nan"),
        (lambda: model.eval(SOFT, 1, -1), "normal_load_n must be finite and not below zero, but is -1e0"),
        (lambda: model.invert(FINGER, np.inf), "friction_n must be finite, but is inf"),
        (
            lambda: model.Contact(radius_m=0, stiffness_pa_per_m=1e7, friction_coefficient=0.5, gap_m=1e-5),
            "radius_m must be finite and above zero, but is 0e0",
        ),
    ],
)
def test_what_is_not_taken_is_said(call: object, sentence: str) -> None:
    assert callable(call)
    with pytest.raises(ParameterError) as caught:
        call()
    assert str(caught.value) == sentence
    assert isinstance(caught.value, FrixelError)
    assert isinstance(caught.value, ValueError)


def test_a_contact_that_would_be_wider_than_the_finger_is_told() -> None:
    thin = model.Contact(radius_m=8e-3, stiffness_pa_per_m=1.8e7, friction_coefficient=0.5, gap_m=1e-8)
    with pytest.warns(FrixelWarning) as told:
        model.eval(thin, [0.0, 100.0, 150.0])
    assert str(told[0].message) == (
        "at 2 voltages the contact would be wider than the finger, where the model is not valid: is a skin gap missing "
        "from the coating?"
    )


def test_scales_are_those_of_the_paper() -> None:
    assert pytest.approx(math.sqrt(2 * 1.8e7 * 1e-15 / 8.8541878188e-12), rel=1e-14) == FINGER.voltage_scale_v_rms
    assert pytest.approx(math.pi * 1.8e7 * 8e-3 * 1e-10, rel=1e-14) == FINGER.load_scale_n
    assert pytest.approx(0.5 * FINGER.load_scale_n, rel=1e-14) == FINGER.friction_scale_n


def test_contacts_are_values() -> None:
    for contact in (FINGER, SOFT):
        assert pickle.loads(pickle.dumps(contact)) == contact
        assert hash(contact) == hash(pickle.loads(pickle.dumps(contact)))


def test_pythons_lock_is_released_while_the_model_computes() -> None:
    voltages = np.full(3_000_000, 150.0)
    counted, over = 0, threading.Event()

    def count() -> None:
        nonlocal counted
        while not over.is_set():
            counted += 1

    # A thread that holds the lock for all of its run would let the counter run only before and after.
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-4)
    counter = threading.Thread(target=count)
    counter.start()
    before = counted
    model.eval(FINGER, voltages, 0.5)
    during = counted - before
    over.set()
    counter.join()
    sys.setswitchinterval(interval)
    assert during > 10_000
