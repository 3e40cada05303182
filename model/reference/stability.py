"""The rows of `stability.csv`: stiff, soft and extreme fingers under loads of both signs.

`generate.py` writes them; `frixel report` compares the model with them. Every input is exact in f32, so that both
precisions are compared with the same answers, and has the nine digits that an f32 takes; only a negative load and its
friction are exact in f64 alone. An answer is the nearest f64, and in the column `..._rest` what it lacks. Friction is
the electric part, and under a negative load the total.
"""

import random

import paper
from mpmath import mp, mpf

# Powers of two: exact in f32.
GRIP = {"R": 1 / 128, "mu": 0.5, "h0": 2.0**-17, "eps": 1.0}
SOFT = {**GRIP, "E": 2.0**17, "B": 4.5}
# 1.3e5, 1.7e7 and 8.8e12 Pa/m.
STIFFNESSES = (2.0**17, 2.0**24, 2.0**43)
LOADS_N = (0.0, 0.5, 2.0)
VOLTAGE_DECADES = (-6, 4)
STRESS_EXPONENTS = 9
Q_DECADES = (-12, 12)
N_DECADES = (-6, 8)
PART_DECADES = (-13, 0)
POINTS = 4

COLUMNS = (
    "finger",
    "stiffness_pa_per_m",
    "stress_exponent",
    "voltage_v",
    "normal_force_n",
    "friction_n",
    "friction_n_rest",
    "given_friction_n",
    "answer_voltage_v",
    "answer_voltage_v_rest",
    "condition",
)


def rows(generate):
    """All rows, as dictionaries; `generate` is the module that writes them."""
    rng = random.Random(20261126)
    yield from springs_under_loads(generate)
    yield from plane(generate, rng)
    yield from soft(generate)
    yield from pulled(generate, rng)


def split(name, x):
    """The nearest f64, and the rest."""
    nearest = float(x)
    return {name: repr(nearest), f"{name}_rest": mp.nstr(x - mpf(nearest), 2)}


def single(x):
    """A number that is exact in f32."""
    return f"{x:.9g}"


def row(generate, finger, p, condition=""):
    """A state at the voltage, and the voltage at a friction that an f32 holds; under a pull, an f64."""
    q = generate.exact(p)
    is_pulled = p["load"] < 0
    variant = "wf-loaded" if "k" in p else "soft-loaded" if p["load"] else "soft-upper"
    _, _, total, electric = paper.forward(variant, q)
    friction = total if is_pulled else electric
    given = float(friction) if is_pulled else generate.f32(friction)
    natural = 0 if is_pulled else q["mu"] * q["load"]
    return {
        "finger": finger,
        "stiffness_pa_per_m": single(p["k"]) if "k" in p else "",
        "stress_exponent": single(p["s"]) if "s" in p else "",
        "voltage_v": single(p["voltage"]),
        "normal_force_n": (repr if is_pulled else single)(p["load"]),
        **split("friction_n", friction),
        "given_friction_n": (repr if is_pulled else single)(given),
        **split("answer_voltage_v", paper.inverse(variant, q, mpf(given) + natural)),
        "condition": condition,
    }


def even(decades, count):
    low, high = decades
    return [10 ** (low + (high - low) * i / (count - 1)) for i in range(count)]


def springs_under_loads(generate):
    for k in STIFFNESSES:
        for load in LOADS_N:
            for voltage in even(VOLTAGE_DECADES, 31):
                yield row(generate, "springs", {**GRIP, "k": k, "voltage": generate.f32(voltage), "load": load})


def plane(generate, rng):
    """Points in each cell of a decade of q and two of n, and without a load."""
    for n_decade in (*range(*N_DECADES, 2), None):
        for q_decade in range(*Q_DECADES):
            for point in range(POINTS):
                finger = {**GRIP, "k": STIFFNESSES[point % len(STIFFNESSES)]}
                q = mpf(10) ** (q_decade + rng.random())
                n = mpf(0) if n_decade is None else mpf(10) ** (n_decade + 2 * rng.random())
                p = {**finger, "voltage": generate.voltage_for(finger, q), "load": generate.load_for(finger, n)}
                yield row(generate, "springs", p)


def soft(generate):
    for load in LOADS_N:
        for i in range(STRESS_EXPONENTS):
            exponent = generate.f32(0.02 + (1 - 0.02) * i / (STRESS_EXPONENTS - 1))
            for voltage in even(VOLTAGE_DECADES, 11):
                yield row(generate, "soft", {**SOFT, "s": exponent, "voltage": generate.f32(voltage), "load": load})


def pulled(generate, rng):
    """Two points in each cell of two decades of q and a decade of the part of the load that is missing to pull-off."""
    for part_decade in range(*PART_DECADES):
        for q_decade in range(*Q_DECADES, 2):
            for k in STIFFNESSES[:2]:
                finger = {**GRIP, "k": k}
                p = {**finger, "voltage": generate.voltage_for(finger, mpf(10) ** (q_decade + 2 * rng.random()))}
                x = generate.exact(p)
                # Where the square root of Eq. (43) is zero.
                off = -paper.pi * paper.sigma0(x) ** 2 * x["R"] / k - paper.outer_term(x, x["k"], paper.sigma0(x))
                p["load"] = float(off * (1 - mpf(10) ** (part_decade + rng.random())))
                call = lambda inputs: paper.forward("wf-loaded", inputs)[2:3]
                condition = generate.condition(call, generate.exact(p), generate.CONDITIONED)
                yield row(generate, "pulled", p, mp.nstr(condition, 4))
