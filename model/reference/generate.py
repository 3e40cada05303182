"""Writes the fixtures of `tests/`: run `pip install mpmath==1.4.1`, then `python3 model/reference/generate.py`.

Every input is exact in f32, so that both precisions are held against the same numbers; `f32` is 1 where every answer is a
normal number of f32 too. `condition` is the sum of the relative changes of the answer over those of the inputs.
"""

import csv
import random
import struct
import sys
from pathlib import Path

import paper
import stability
from mpmath import mp, mpf, pi, sqrt

OUT = Path(__file__).resolve().parent.parent / "tests" / "fixtures"
INPUTS = {
    "radius_m": "R",
    "stiffness_pa_per_m": "k",
    "coating_m": "h0",
    "permittivity": "eps",
    "friction_coefficient": "mu",
    "voltage_v": "voltage",
    "normal_force_n": "load",
    "outer_radius_m": "b",
    "modulus_pa": "E",
    "stress_exponent": "s",
    "shape_constant": "B",
}
STATUS = {
    paper.NoContact: "no-contact",
    paper.PassesOuterRadius: "passes-outer-radius",
    paper.BelowNatural: "below-natural",
    paper.Unstable: "unstable",
}
WF = ("wf-upper", "wf-loaded", "wf-lower", "wf-finite")
SOFT = ("soft-upper", "soft-loaded", "soft-lower")

rng = random.Random(20240229)


def f32(x):
    """The nearest f32, as an exact float."""
    return struct.unpack("<f", struct.pack("<f", float(x)))[0]


def log_uniform(low, high):
    return f32(low * (high / low) ** rng.random())


def normal_in_f32(x):
    return x == 0 or mpf("1e-36") < abs(x) < mpf("1e37")


def digits(x):
    return mp.nstr(x, 25) if x else "0"


def exact(p):
    return {name: mpf(value) for name, value in p.items()}


def condition(function, p, names):
    """Largest condition number of the answers: the sum of their relative sensitivities to the named inputs."""
    step = mpf("1e-25")
    base = function(p)
    sums = [mpf(0)] * len(base)
    for name in names:
        if not p.get(name):
            continue
        try:
            near = function({**p, name: p[name] * (1 + step)})
        except tuple(STATUS):
            near = function({**p, name: p[name] * (1 - step)})
        for i, (a, b) in enumerate(zip(base, near)):
            if a:
                sums[i] += abs((b - a) / a / step)
    return max(sums)


def slope(function, p, name):
    """Derivative of friction; from one side where the other has no contact."""
    base = function(p)[2]
    step = mpf("1e-25") * (p[name] if p[name] else base / p["mu"])
    try:
        return (function({**p, name: p[name] + step})[2] - function({**p, name: p[name] - step})[2]) / (2 * step)
    except tuple(STATUS):
        return (function({**p, name: p[name] + step})[2] - base) / step


CONDITIONED = ("voltage", "load", "k", "h0", "R", "b")


class Fixtures:
    def __init__(self):
        self.forward, self.inverse = [], []

    def add(self, variant, p, name=""):
        """A forward row and, where there is a state, inverse rows from its rounded friction."""
        p = {key: f32(value) for key, value in p.items()}
        q = exact(p)
        if "load" not in q:
            q["load"] = mpf(0)
        row = {"name": name, "variant": variant, **self.columns(p)}
        call = lambda inputs: paper.forward(variant, inputs)
        try:
            radius, k, friction, electric = call(q) if q["voltage"] or q["load"] else (mpf(0), q.get("k", mpf(0)), mpf(0), mpf(0))
        except (paper.NoContact, paper.PassesOuterRadius) as error:
            row.update(status=STATUS[type(error)], f32=1)
            self.forward.append(row)
            return
        answers = (paper.sigma0(q), radius, k, friction, electric)
        row.update(
            sigma0_pa=digits(answers[0]),
            contact_radius_m=digits(radius),
            effective_stiffness_pa_per_m=digits(k),
            friction_n=digits(friction),
            electric_friction_n=digits(electric),
            status="ok",
            f32=int(all(map(normal_in_f32, answers))),
            condition="1",
        )
        if q["voltage"] and variant in WF:
            row["condition"] = mp.nstr(condition(call, q, CONDITIONED), 6)
        if q["voltage"] and variant != "soft-lower":
            row["friction_per_volt"] = digits(slope(call, q, "voltage"))
            if variant != "wf-upper" and variant != "soft-upper":
                row["friction_per_load"] = digits(slope(call, q, "load"))
        if variant == "wf-finite":
            row["capacitance_f"] = digits(paper.capacitance(q, k, radius**2))
        self.forward.append(row)
        if friction and electric:
            self.add_inverse(variant, p, electric=electric, name=name)
            if q["load"] and (name or abs(electric) > mpf("1e-6") * friction):
                self.add_inverse(variant, p, friction=friction, name=name)

    def add_inverse(self, variant, p, friction=None, electric=None, name=""):
        given = "friction_n" if electric is None else "electric_friction_n"
        wanted = friction if electric is None else electric
        if not normal_in_f32(wanted):
            return
        wanted = f32(wanted)
        p = {key: f32(value) for key, value in p.items() if key != "voltage"}
        q = exact(p)
        q.setdefault("load", mpf(0))
        row = {"name": name, "variant": variant, **self.columns(p), given: repr(wanted)}

        def call(inputs):
            total = inputs["wanted"] + (inputs["mu"] * inputs["load"] if given == "electric_friction_n" else 0)
            return (paper.inverse(variant, inputs, total),)

        q["wanted"] = mpf(wanted)
        try:
            (voltage,) = call(q)
        except tuple(STATUS) as error:
            # In f32, a friction within rounding of natural friction may fall on either side.
            clear = abs(q["wanted"] - q["mu"] * q["load"]) > mpf("1e-5") * q["wanted"]
            row.update(status=STATUS[type(error)], f32=int(clear or electric is not None))
            self.inverse.append(row)
            return
        c = condition(call, q, (*CONDITIONED, "wanted")) if voltage and variant in WF else mpf(1)
        if given == "friction_n" and voltage:
            # Condition of the electric part, from the rounding of mu F_N and of the total.
            c = max(c, 12 * mpf(wanted) / (mpf(wanted) - q["mu"] * q["load"]))
        row.update(voltage_v=digits(voltage), status="ok", f32=int(normal_in_f32(voltage) and c < 1e6), condition=mp.nstr(c, 6))
        self.inverse.append(row)

    @staticmethod
    def columns(p):
        return {column: repr(p[key]) for column, key in INPUTS.items() if key in p}


def winkler(scale):
    """A Winkler-Fuss finger; `scale` narrows the extremes."""
    return {
        "R": log_uniform(2e-3, 2e-2),
        "k": log_uniform(1e3, 1e14) if scale == "extreme" else log_uniform(1e6, 1e9),
        "h0": log_uniform(1e-8, 1e-3) if scale == "extreme" else log_uniform(1e-6, 1e-4),
        "eps": log_uniform(1, 1e4) if scale == "extreme" else log_uniform(1, 10),
        "mu": log_uniform(0.05, 3),
    }


def voltage_for(p, q):
    """Voltage that makes sigma0 eps/(h0 k) equal q."""
    x = exact({key: f32(value) for key, value in p.items()})
    return f32(sqrt(2 * q * x["k"] / paper.EPS0 * (x["h0"] / x["eps"]) ** 3))


def load_for(p, n):
    x = exact({key: f32(value) for key, value in p.items()})
    return f32(n * pi * x["k"] * x["R"] * (x["h0"] / x["eps"]) ** 2)


def winkler_rows(fixtures):
    for _ in range(70):
        for scale in ("usual", "extreme"):
            p = winkler(scale)
            q = mpf(10) ** rng.uniform(-12, 12)
            n = mpf(10) ** rng.uniform(-6, 8)
            upper = {**p, "voltage": voltage_for(p, q)}
            fixtures.add("wf-upper", upper)
            loaded = {**upper, "load": load_for(p, n)}
            fixtures.add("wf-loaded", loaded)
            fixtures.add("wf-lower", upper if rng.random() < 0.5 else loaded)
    for _ in range(40):
        # Plain voltages and loads, whatever q and n come of it.
        p = {**winkler("extreme"), "voltage": log_uniform(1e-6, 1e4), "load": log_uniform(1e-6, 50)}
        for variant in ("wf-upper", "wf-loaded", "wf-lower"):
            fixtures.add(variant, p if variant != "wf-upper" else {**p, "load": 0})
    for _ in range(50):
        p = winkler("usual")
        q = mpf(10) ** rng.uniform(-3, 3)
        # Pull at a part of the pull-off load, half of them close to it.
        part = 1 - mpf(10) ** rng.uniform(-5, -1) if rng.random() < 0.5 else mpf(rng.uniform(0.01, 0.95))
        upper_pull = q * q + 2 * q / (1 + q)
        loaded = {**p, "voltage": voltage_for(p, q), "load": load_for(p, -part * upper_pull)}
        fixtures.add("wf-loaded", loaded)
        fixtures.add("wf-lower", {**loaded, "load": load_for(p, -part * q * q)})
        fixtures.add("wf-loaded", {**loaded, "load": load_for(p, -mpf("1.01") * upper_pull)})


def finite_rows(fixtures):
    for i in range(110):
        p = winkler("usual" if i % 2 else "extreme")
        q = mpf(10) ** rng.uniform(-12, 9)
        p["voltage"] = voltage_for(p, q)
        p["load"] = load_for(p, mpf(10) ** rng.uniform(-6, 8)) if rng.random() < 0.6 else 0.0
        x = exact({key: f32(value) for key, value in p.items()})
        _, k, _, _ = paper.forward("wf-loaded", x)
        area = paper.larger_area(x, k, paper.sigma0(x), x["load"] + paper.outer_term(x, k, paper.sigma0(x)))
        # An outer radius from just beyond the contact to far away.
        p["b"] = f32(sqrt(area * (1 + mpf(10) ** rng.uniform(-4, 6))))
        fixtures.add("wf-finite", p)
    for _ in range(10):
        p = winkler("usual")
        p.update(voltage=voltage_for(p, mpf(10)), load=load_for(p, mpf(100)))
        radius = paper.forward("wf-lower", exact({key: f32(value) for key, value in p.items()}))[0]
        fixtures.add("wf-finite", {**p, "b": f32(radius * mpf("0.99"))})


def soft(exponent=None):
    return {
        "R": log_uniform(2e-3, 2e-2),
        "E": log_uniform(1e3, 1e9),
        "s": f32(exponent) if exponent else log_uniform(0.02, 1),
        "B": log_uniform(0.1, 10),
        "h0": log_uniform(1e-7, 1e-4),
        "eps": log_uniform(1, 10),
        "mu": log_uniform(0.05, 3),
    }


def soft_voltage(p, tau):
    """Voltage that makes pi sigma0/(B E) equal tau."""
    x = exact({key: f32(value) for key, value in p.items()})
    return f32(sqrt(2 * tau * x["B"] * x["E"] / pi / paper.EPS0) * x["h0"] / x["eps"])


def soft_rows(fixtures):
    for exponent in [None] * 100 + [0.02, 0.1, 0.25, 0.5, 0.75, 1.0] * 4:
        p = soft(exponent)
        p["voltage"] = soft_voltage(p, mpf(10) ** rng.uniform(-12, 2))
        x = exact({key: f32(value) for key, value in p.items()})
        alone = paper.forward("soft-upper", x)[2] / x["mu"]
        load = alone * mpf(10) ** rng.uniform(-4, 6)
        fixtures.add("soft-upper", p)
        fixtures.add("soft-loaded", {**p, "load": f32(load) if normal_in_f32(load) else 0.5})
        fixtures.add("soft-lower", p)


EXAMPLE = {"R": 8e-3, "k": 1.8e7, "mu": 0.5, "h0": 1e-5, "eps": 1.0}
SOFT_EXAMPLE = {"R": 8e-3, "E": 1e5, "B": 4.5, "mu": 0.5, "h0": 1e-5, "eps": 1.0}


def named_rows(fixtures):
    huge = {**EXAMPLE, "k": 1e3, "h0": 1e-8, "eps": 1e4, "voltage": 1e4}
    tiny = {**EXAMPLE, "k": 1e14, "h0": 1e-3, "voltage": 1e-6}
    for p, name in ((huge, "squares overflow f32"), (tiny, "q = 4e-29")):
        fixtures.add("wf-upper", p, name)
        fixtures.add("wf-lower", p, name)
        fixtures.add("wf-loaded", {**p, "load": 0.5}, name)
        fixtures.add("wf-loaded", {**p, "load": 50.0}, name)
    fixtures.add("wf-upper", {**tiny, "voltage": voltage_for(tiny, mpf("1e-38") / 2)}, "y = 1e-19")
    fixtures.add("wf-upper", {**huge, "voltage": voltage_for(huge, mpf("1e19"))}, "y = 2e19")
    fixtures.add("wf-finite", {**tiny, "b": 6e-3}, "q = 4e-29")
    for variant in ("wf-upper", "wf-lower", "wf-finite"):
        ends = {"b": 6e-3} if variant == "wf-finite" else {}
        for load in (0.0, 0.5):
            if variant == "wf-upper" and load:
                continue
            fixtures.add(variant, {**EXAMPLE, **ends, "voltage": 0.0, "load": load}, "no voltage")
        fixtures.add_inverse(variant, {**EXAMPLE, **ends}, electric=mpf(0), name="no friction")
        fixtures.add_inverse(variant, {**EXAMPLE, **ends}, friction=mpf(0), name="no friction")
    for load in (0.0, 0.5):
        for variant in ("soft-upper", "soft-loaded", "soft-lower"):
            if variant != "soft-loaded" and load:
                continue
            p = {**SOFT_EXAMPLE, "s": 0.5}
            fixtures.add(variant, {**p, "voltage": 0.0, "load": load}, "no voltage")
            fixtures.add_inverse(variant, {**p, "load": load}, electric=mpf(0), name="no electric friction")
            if not load:
                fixtures.add_inverse(variant, {**p, "load": load}, friction=mpf(0), name="no friction")
    fixtures.add_inverse("wf-loaded", {**EXAMPLE, "load": -0.001}, friction=mpf(0), name="no friction under a pull")
    fixtures.add_inverse("wf-lower", {**EXAMPLE, "load": -0.001}, friction=mpf(0), name="no friction under a pull")
    for variant in ("wf-loaded", "wf-lower", "wf-finite"):
        p = {**EXAMPLE, "load": 0.5, **({"b": 6e-3} if variant == "wf-finite" else {})}
        fixtures.add_inverse(variant, p, friction=mpf("0.2499"), name="less than natural")
        fixtures.add_inverse(variant, p, friction=mpf("0.25"), name="natural")
        fixtures.add_inverse(variant, p, friction=mpf("0.25001"), name="barely above natural")
    fixtures.add_inverse("soft-loaded", {**SOFT_EXAMPLE, "s": 0.5, "load": 0.5}, friction=mpf("0.2"), name="less than natural")
    for q, name in (("4e-6", "wrong branch off by 245 %"), ("7e7", "wrong branch overflows")):
        fixtures.add("wf-upper", {**EXAMPLE, "voltage": voltage_for(EXAMPLE, mpf(q))}, name)
    p = {**EXAMPLE, "voltage": voltage_for(EXAMPLE, mpf("1e-12")), "load": load_for(EXAMPLE, mpf("6e7"))}
    fixtures.add("wf-loaded", p, "y^2 - n cancels")
    for q in ("1e-3", "1", "1e3"):
        q = mpf(q)
        p = {**EXAMPLE, "voltage": voltage_for(EXAMPLE, q)}
        x = exact({key: f32(value) for key, value in p.items()})
        k = x["k"]
        off = -paper.pi * paper.sigma0(x) ** 2 * x["R"] / k - paper.outer_term(x, k, paper.sigma0(x))
        inside = f32(off * (1 - mpf("1e-6")))
        fixtures.add("wf-loaded", {**p, "load": inside}, "within 1e-6 of pull-off")
        fixtures.add("wf-loaded", {**p, "load": f32(off * (1 + mpf("1e-6")))}, "beyond pull-off by 1e-6")
        # A friction on the lower branch, two parts in a hundred below that at pull-off.
        unstable = paper.friction(x, k, 2 * x["R"] * paper.sigma0(x) / k) * mpf("0.98")
        fixtures.add_inverse("wf-loaded", {**EXAMPLE, "load": inside}, friction=unstable, name="below pull-off")
    for load in (0.0, 0.5):
        p = {**EXAMPLE, "voltage": 150.0, "load": load}
        x = exact({key: f32(value) for key, value in p.items()})
        reach = paper.larger_area(x, x["k"], paper.sigma0(x), x["load"])  # where the ring around the contact is gone
        b = f32(sqrt(reach))
        b = b if mpf(b) ** 2 >= reach else f32(b * (1 + 2**-23))
        fixtures.add("wf-finite", {**p, "b": b}, "beta = y")
        fixtures.add("wf-finite", {**p, "b": f32(b * (1 - 1e-5))}, "just passes the outer radius")
        state = paper.forward("wf-lower", x)
        inside = {key: value for key, value in p.items() if key != "voltage"}
        fixtures.add_inverse("wf-finite", {**inside, "b": f32(b * (1 - 1e-5))}, friction=state[2], name="just passes the outer radius")
    for tau in ("1e-6", "0.1"):
        p = {**SOFT_EXAMPLE, "s": 1e-6}
        p["voltage"] = soft_voltage(p, mpf(tau))
        for variant in SOFT:
            with_load = {**p, "load": 0.5} if variant == "soft-loaded" else p
            fixtures.add(variant, with_load, "stress exponent 1e-6")


def write(name, rows, columns):
    with open(OUT / name, "w", newline="") as file:
        writer = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def shear_rows():
    rows = []
    for _ in range(60):
        k, l, h, mu = log_uniform(1, 1e5), log_uniform(1e-4, 1e-1), log_uniform(1e-6, 1e-3), log_uniform(0.05, 3)
        force = f32(mpf(k) * mpf(h) * (1 + mpf(10) ** rng.uniform(-2, 4)))
        phi, displacement = paper.shear_onset(*map(mpf, (force, k, l, h, mu)))
        rows.append(
            {
                "attraction_n": repr(force),
                "stiffness_n_per_m": repr(k),
                "length_m": repr(l),
                "gap_m": repr(h),
                "friction_coefficient": repr(mu),
                "angle_rad": digits(phi),
                "displacement_m": digits(displacement),
                "condition": mp.nstr(mpf(force) / (mpf(force) - mpf(k) * mpf(h)), 6),
            }
        )
    return rows


def pull_off_rows():
    rows = []
    for _ in range(60):
        p = winkler("usual")
        p["load"] = load_for(p, -(mpf(10) ** rng.uniform(-8, 6)))
        p = {key: f32(value) for key, value in p.items()}
        voltage = paper.pull_off_voltage(exact(p))
        x = {**exact(p), "voltage": voltage}
        friction = paper.friction(x, x["k"], 2 * x["R"] * paper.sigma0(x) / x["k"])
        rows.append({**Fixtures.columns(p), "voltage_v": digits(voltage), "friction_n": digits(friction)})
    return rows


def main():
    fixtures = Fixtures()
    named_rows(fixtures)
    winkler_rows(fixtures)
    finite_rows(fixtures)
    soft_rows(fixtures)
    OUT.mkdir(exist_ok=True)
    inputs = list(INPUTS)
    answers = ["sigma0_pa", "contact_radius_m", "effective_stiffness_pa_per_m", "friction_n", "status"]
    extras = ["electric_friction_n", "friction_per_volt", "friction_per_load", "capacitance_f", "condition", "f32"]
    write("forward.csv", fixtures.forward, ["name", "variant", *inputs, *answers, *extras])
    without_voltage = [column for column in inputs if column != "voltage_v"]
    given = ["friction_n", "electric_friction_n", "voltage_v", "status", "condition", "f32"]
    write("inverse.csv", fixtures.inverse, ["name", "variant", *without_voltage, *given])
    shear = shear_rows()
    write("shear.csv", shear, list(shear[0]))
    pull_off = pull_off_rows()
    write("pull_off.csv", pull_off, list(pull_off[0]))
    write("stability.csv", list(stability.rows(sys.modules[__name__])), stability.COLUMNS)


if __name__ == "__main__":
    main()
