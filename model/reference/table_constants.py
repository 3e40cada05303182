"""The constants of the tables' error bound, `CURVATURE` in `src/table/bound.rs`.

For every dimensionless friction u and load n of zero or more, with V(x) the inverse curve and s = d ln x / d ln V, this finds
the supremum of s |x^C V^(C)| / (C! V) for C = 2, 3, 4: over a grid of 40 decades each way, then by halving the step around the
highest points. Far from the origin the curve is a power law, and the quantity flat. Also prints the extremes of s, and the
bound of `InverseTable` (four rows an octave, C = 4): the supremum of the sum of all that adds to its error.
"""

from mpmath import mp, mpf, sqrt, taylor

mp.dps = 50


def curve(u, n):
    """(V/V*) of Eq. (43) solved for the voltage."""
    y = sqrt(n + u)
    r = u / y
    b = 2 + 2 / y - r
    return sqrt(2 * r / (b + sqrt(b * b + 8 * r)))


def quantities(log_u, log_n):
    u = mpf(10) ** log_u
    n = mpf(0) if log_n is None else mpf(10) ** log_n
    t = taylor(lambda e: curve(u * (1 + e), n), 0, 4)
    s = t[0] / t[1]
    curvature = [abs(s * t[c] / t[0]) for c in (2, 3, 4)]
    # Interpolation in rows of half width 1/8, rounding of 6.3 half-units, and 0.44 of the margin below the largest voltage.
    rest = (mpf("6.3") / 2**24 + mpf("0.44") / 2**21) * s
    return s, [*curvature, curvature[2] * (3 - 2 * sqrt(2)) / 8**4 + rest]


def main():
    step = mpf("0.5")
    grid = [i * step for i in range(-40, 41)]
    points = [(u, n) for u in grid for n in [None, *grid]]
    found = {point: quantities(*point) for point in points}
    slopes = [s for s, _ in found.values()]
    print("s from", mp.nstr(min(slopes), 8), "to", mp.nstr(max(slopes), 8))
    for index, name in enumerate(("C = 2", "C = 3", "C = 4", "InverseTable")):
        best = max(points, key=lambda point: found[point][1][index])
        value, width = found[best][1][index], step
        while width > mpf("1e-4") and best[1] is not None:
            width /= 2
            near = [(best[0] + i * width, best[1] + j * width) for i in (-1, 0, 1) for j in (-1, 0, 1)]
            best = max(near, key=lambda point: quantities(*point)[1][index])
            value = quantities(*best)[1][index]
        print(name, mp.nstr(value, 8), "at log10 u, log10 n =", [None if v is None else mp.nstr(v, 5) for v in best])


if __name__ == "__main__":
    main()
