"""Writes what `frixel report` compares the model with: run `pip install mpmath==1.4.1`, then
`python3 model/reference/report.py FOLDER`; FOLDER is `reference` beside the report's source.

`plane.csv` has a finger on springs over the plane of attraction and load, `pulled.csv` one that is pulled off, over attraction
and distance from pull-off, and `soft.csv` a soft finger over its exponent. Every input is exact in f32, so that both precisions are
compared with the same answers; those of `pulled.csv`, which has friction in total, are exact in f64. An answer is the nearest f64, and in the
column `..._rest` what it lacks.
"""

import csv
import sys
from pathlib import Path

import paper
from generate import exact, f32, load_for, voltage_for
from mpmath import mp, mpf

# Powers of two: exact in f32.
SPRINGS = {"R": 1 / 128, "k": 2.0**24, "mu": 0.5, "h0": 2.0**-17, "eps": 1.0}
SOFT = {"R": 1 / 128, "E": 2.0**17, "B": 4.5, "mu": 0.5, "h0": 2.0**-17, "eps": 1.0}
CELLS_PER_DECADE = 3
Q_DECADES = (-12, 12)
N_DECADES = (-6, 8)
PULLED_CELLS_PER_DECADE = 2
PULLED_DECADES = (-13, 0)
STRESS_EXPONENTS = 33
SOFT_LOADS_N = (0.0, 0.5)
SOFT_VOLTAGES_V = range(-6, 5)


def split(x):
    """The nearest f64, and the rest."""
    nearest = float(x)
    return [repr(nearest), mp.nstr(x - mpf(nearest), 4)]


def answers(variant, p):
    """Voltage, load, electric friction there; a friction that is exact in f32, and its voltage."""
    q = exact(p)
    _, _, _, electric = paper.forward(variant, q)
    given = f32(electric)
    voltage = paper.inverse(variant, q, mpf(given) + q["mu"] * q["load"])
    return [repr(p["voltage"]), repr(p["load"]), *split(electric), repr(given), *split(voltage)]


COLUMNS = [
    "voltage_v",
    "normal_force_n",
    "electric_friction_n",
    "electric_friction_n_rest",
    "given_electric_friction_n",
    "answer_voltage_v",
    "answer_voltage_v_rest",
]


def cells(decades, per_decade=CELLS_PER_DECADE):
    return range(decades[0] * per_decade, decades[1] * per_decade)


def middle(cell, per_decade=CELLS_PER_DECADE):
    return mpf(10) ** ((mpf(cell) + mpf("0.5")) / per_decade)


def plane():
    """A place in the middle of each cell; without a load in the last row of cells."""
    for n_cell in (*cells(N_DECADES), None):
        for q_cell in cells(Q_DECADES):
            n = middle(n_cell) if n_cell is not None else mpf(0)
            p = {**SPRINGS, "voltage": voltage_for(SPRINGS, middle(q_cell)), "load": load_for(SPRINGS, n)}
            yield ["" if n_cell is None else n_cell, q_cell, *answers("wf-loaded", p)]


def pulled():
    """A place in the middle of each cell: the load is that of pull-off, less a part of it."""
    for part_cell in cells(PULLED_DECADES, PULLED_CELLS_PER_DECADE):
        for q_cell in cells(Q_DECADES, PULLED_CELLS_PER_DECADE):
            voltage = voltage_for(SPRINGS, middle(q_cell, PULLED_CELLS_PER_DECADE))
            x = exact({**SPRINGS, "voltage": voltage})
            q = paper.sigma0(x) * x["eps"] / (x["h0"] * x["k"])
            # Where the square root of Eq. (43) is zero.
            n = -(q**2 + 2 * q / (1 + q)) * (1 - middle(part_cell, PULLED_CELLS_PER_DECADE))
            load = float(n * mp.pi * x["k"] * x["R"] * (x["h0"] / x["eps"]) ** 2)
            x["load"] = mpf(load)
            _, _, friction, _ = paper.forward("wf-loaded", x)
            given = float(friction)
            voltage_v = paper.inverse("wf-loaded", x, mpf(given))
            yield [part_cell, q_cell, repr(voltage), repr(load), *split(friction), repr(given), *split(voltage_v)]


def soft():
    for load in SOFT_LOADS_N:
        for i in range(STRESS_EXPONENTS):
            exponent = f32(0.02 + (1 - 0.02) * i / (STRESS_EXPONENTS - 1))
            for power in SOFT_VOLTAGES_V:
                p = {**SOFT, "s": exponent, "voltage": f32(10.0**power), "load": load}
                yield [repr(exponent), *answers("soft-loaded" if load else "soft-upper", p)]


def write(path, columns, rows):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(rows)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    write(folder / "plane.csv", ["n_cell", "q_cell", *COLUMNS], plane())
    in_total = [name.replace("electric_", "") for name in COLUMNS]
    write(folder / "pulled.csv", ["part_cell", "q_cell", *in_total], pulled())
    write(folder / "soft.csv", ["stress_exponent", *COLUMNS], soft())
