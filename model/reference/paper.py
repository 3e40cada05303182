"""The paper's equations as they stand, in dimensional form, with 80 digits.

Argatov and Borodich, "A macro model for electroadhesive contact of a soft finger with a touchscreen". Nothing here is
scaled the way the crate scales it: this file is what the crate is measured against. Equation numbers are the paper's.
"""

from mpmath import cos, exp, log, mp, mpf, pi, sqrt, tan

mp.dps = 80

EPS0 = mpf("8.8541878188e-12")  # CODATA 2022


class NoContact(Exception):
    pass


class PassesOuterRadius(Exception):
    pass


class BelowNatural(Exception):
    pass


class Unstable(Exception):
    pass


def sigma0(p):
    """Eq. (8)."""
    return p["voltage"] ** 2 * EPS0 * p["eps"] ** 2 / (2 * p["h0"] ** 2)


def friction(p, k, area):
    """Eq. (21), with area = a^2."""
    return p["mu"] * k * pi * area**2 / (4 * p["R"])


def outer_term(p, k, s0):
    """The term of Eq. (43) for the attraction around the contact."""
    return 2 * pi * s0 * p["R"] * p["h0"] / p["eps"] / (1 + p["eps"] * s0 / (p["h0"] * k))


def finite_outer_term(p, k, s0, area):
    """The same with the outer radius b, Eq. (19)."""
    first = 1 + p["eps"] * s0 / (p["h0"] * k)
    second = first + p["eps"] * (p["b"] ** 2 - area) / (2 * p["R"] * p["h0"])
    return 2 * pi * s0 * p["R"] * p["h0"] / p["eps"] * (1 / first - 1 / second)


def stiffness(p, force):
    """Eq. (29), with force = F_T / mu."""
    g4 = 4 * gamma(p)
    return p["B"] ** g4 * p["E"] / (pi * p["R"]) * (p["E"] * p["R"] ** 2 / force) ** (g4 - 1)


def gamma(p):
    """Eq. (23)."""
    return p["s"] / (2 * p["s"] + 1)


def larger_area(p, k, s0, rest):
    """The larger a^2 of pi k a^4/(4 R) - pi s0 a^2 - rest = 0."""
    square = (pi * s0) ** 2 + pi * k / p["R"] * rest
    if square < 0:
        raise NoContact
    return (pi * s0 + sqrt(square)) / (pi * k / (2 * p["R"]))


def root_between(f, low, high):
    """Root of f between low and high, to 70 digits: Ridders' method, which never leaves the bracket."""
    flow, fhigh = f(low), f(high)
    if flow == 0:
        return low
    if fhigh == 0:
        return high
    assert flow * fhigh < 0, (low, high, flow, fhigh)
    tolerance = mpf(10) ** (10 - mp.dps)
    last = None
    for _ in range(500):
        middle = (low + high) / 2
        fmiddle = f(middle)
        if fmiddle == 0:
            return middle
        x = middle + (middle - low) * (1 if flow > fhigh else -1) * fmiddle / sqrt(fmiddle**2 - flow * fhigh)
        fx = f(x)
        if fx == 0 or (last is not None and abs(x - last) <= tolerance * abs(x)):
            return x
        last = x
        ends = sorted([(low, flow), (middle, fmiddle), (x, fx), (high, fhigh)], key=lambda end: end[0])
        (low, flow), (high, fhigh) = next((a, b) for a, b in zip(ends, ends[1:]) if a[1] * b[1] < 0)
    raise ArithmeticError("no convergence")


def forward(variant, p):
    """Contact radius, stiffness, friction and electric friction at p["voltage"] under p["load"]."""
    s0 = sigma0(p)
    load = p.get("load", mpf(0))
    if variant in ("wf-upper", "wf-loaded"):
        k = p["k"]
        area = larger_area(p, k, s0, load + outer_term(p, k, s0))  # (35), (43)
    elif variant == "wf-lower":
        k = p["k"]
        area = larger_area(p, k, s0, load)  # (37)
    elif variant == "wf-finite":
        k = p["k"]
        area = finite_area(p, k, s0, load)
    elif variant == "soft-lower":
        g = gamma(p)
        f = p["mu"] * (2 * pi * s0) ** (1 / (1 - 2 * g)) * p["R"] ** 2 * (p["B"] * p["E"]) ** (-2 * g / (1 - 2 * g))  # (40)
        area = (2 * pi) ** (1 / (1 - 2 * g)) * p["R"] ** 2 * (s0 / (p["B"] * p["E"])) ** (2 * g / (1 - 2 * g)) / pi  # (41)
        return sqrt(area), stiffness(p, f / p["mu"]), f, f
    elif variant == "soft-upper":
        alpha = soft_upper_alpha(p, s0)
        f = p["B"] / pi * (p["E"] / s0) * (alpha / sqrt(2)) ** (1 / gamma(p)) * p["mu"] * pi * p["R"] ** 2 * s0  # (32), (30)
        return alpha * p["R"], stiffness(p, f / p["mu"]), f, f
    elif variant == "soft-loaded":
        force = soft_loaded_force(p, s0, load)
        k = stiffness(p, force)
        f = p["mu"] * force
        return (4 * p["R"] * force / (pi * k)) ** mpf("0.25"), k, f, f - p["mu"] * load
    else:
        raise ValueError(variant)
    f = friction(p, k, area)
    return sqrt(area), k, f, f - p["mu"] * load


def finite_area(p, k, s0, load):
    """Eq. (19) for a^2 <= b^2."""

    def balance(area):
        return pi * area**2 * k / (4 * p["R"]) - pi * area * s0 - finite_outer_term(p, k, s0, area) - load

    top = p["b"] ** 2
    at_top = balance(top)
    if at_top < 0:
        raise PassesOuterRadius
    low = larger_area(p, k, s0, load)
    high = min(larger_area(p, k, s0, load + outer_term(p, k, s0)), top)
    if balance(high) == 0 or low >= high:
        return high
    return root_between(balance, low, high)


def first_fall(f, start, step):
    """Root of a falling f at or above start, where f is above zero or rounds to it."""
    low, high = start - mpf("1e-30"), start
    while f(high) > 0:
        low, high = high, high + step
        step *= 2
    return root_between(f, low, high)


def soft_upper_alpha(p, s0):
    """Eq. (33), as the logarithm of its right side over its left, so that no power leaves the range."""
    g = gamma(p)
    c = pi * s0 / (p["B"] * p["E"])

    def gap(lna):
        inner = 1 + c * p["eps"] * p["R"] / p["h0"] * (exp(lna) / sqrt(2)) ** ((4 * g - 1) / g)
        braces = exp(lna) ** 2 + 2 * p["h0"] / (p["eps"] * p["R"]) / inner
        return log(c) + log(2) / (2 * g) + log(braces) - lna / g

    lower_bound = (log(2) + 2 * p["s"] * log(2 * c)) / 2  # Eq. (41)
    return exp(first_fall(gap, lower_bound, mpf("0.1")))


def soft_loaded_force(p, s0, load):
    """Eq. (29) with (43): the force P = F_T/mu that carries load and attraction."""

    def gap(lnf):
        force = exp(lnf)
        k = stiffness(p, force)
        area = sqrt(4 * p["R"] * force / (pi * k))  # (21)
        return log((load + pi * area * s0 + outer_term(p, k, s0)) / force)

    lower = (2 * pi * s0) ** (2 * p["s"] + 1) * p["R"] ** 2 * (p["B"] * p["E"]) ** (-2 * p["s"])  # Eq. (40)
    return exp(first_fall(gap, log(max(load, lower)), mpf("0.1")))


def inverse(variant, p, f):
    """Voltage at which the friction is f."""
    load = p.get("load", mpf(0))
    if f < p["mu"] * load or f < 0:
        raise BelowNatural
    if f == p["mu"] * load:
        return mpf(0)
    if variant == "soft-lower":
        g = gamma(p)
        base = f / p["mu"] / p["R"] ** 2 * (p["B"] * p["E"]) ** (2 * g / (1 - 2 * g))
        s0 = base ** (1 - 2 * g) / (2 * pi)  # (40)
        return sqrt(2 * s0 / EPS0) * p["h0"] / p["eps"]
    if f == 0:
        raise Unstable
    k = stiffness(p, f / p["mu"]) if variant.startswith("soft") else p["k"]
    area = sqrt(4 * p["R"] * f / (pi * k * p["mu"]))  # (21)
    spring = pi * area**2 * k / (4 * p["R"])
    if variant == "wf-lower":
        s0 = (spring - load) / (pi * area)  # (37)
        if area < 2 * p["R"] * s0 / k:
            raise Unstable
    elif variant == "wf-finite":
        if area > p["b"] ** 2:
            raise PassesOuterRadius
        high = (spring - load) / (pi * area)
        low = stress_of_area(p, k, area, spring - load)

        def balance(s0):
            return pi * area * s0 + finite_outer_term(p, k, s0, area) - (spring - load)

        s0 = high if low >= high else root_between(balance, low, high)
    else:
        s0 = stress_of_area(p, k, area, spring - load)  # (35), (43)
        if load < 0 and area < 2 * p["R"] * s0 / k:
            raise Unstable
    return sqrt(2 * s0 / EPS0) * p["h0"] / p["eps"]  # (8)


def stress_of_area(p, k, area, attraction):
    """sigma0 of pi a^2 s0 + d s0/(1 + c s0) = attraction, cleared of the fraction."""
    c = p["eps"] / (p["h0"] * k)
    d = 2 * pi * p["R"] * p["h0"] / p["eps"]
    a2, a1, a0 = pi * area * c, pi * area + d - attraction * c, -attraction
    return (-a1 + sqrt(a1**2 - 4 * a2 * a0)) / (2 * a2)


def shear_onset(f_a, k, l, h, mu):
    """Eq. (48) for the angle, and the displacement above it."""
    chi = h / l

    def gap(phi):
        return (tan(phi) / mu + 1) * (chi + 1 - cos(phi)) / chi - f_a / (k * h)

    phi = root_between(gap, mpf(0), pi / 2 - mpf(10) ** -30)
    return phi, h * (1 + 1 / chi) * tan(phi)


def capacitance(p, k, area):
    """Parallel plates, Eq. (11) with (17): inside eps0 pi a^2 eps/h0, around it the integral over the gap."""
    s0 = sigma0(p)
    g = p["h0"] / p["eps"]
    inner = g + s0 / k
    outer = g + s0 / k + (p["b"] ** 2 - area) / (2 * p["R"])
    return EPS0 * pi * area / g + 2 * pi * EPS0 * p["R"] * log(outer / inner)


def pull_off_voltage(p):
    """Where the two areas of (43) meet."""
    k = p["k"]

    def square(lnv):
        s0 = sigma0({**p, "voltage": exp(lnv)})
        return (pi * s0) ** 2 + pi * k / p["R"] * (p["load"] + outer_term(p, k, s0))

    low, high = log(mpf("1e-20")), log(mpf("1e20"))
    return exp(root_between(square, low, high))
