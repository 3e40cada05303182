"""Electric friction of a recording by averages alone: no contact model, no code of frixel, Python's standard library.

    frixel finger calibrate --finger-seed 3 --seed 103 -o recording.csv
    frixel finger fit recording.csv -o finger.toml
    python3 host/lab/reference/switched_means.py recording.csv finger.toml

prints the electric friction at the highest voltage with its standard error, and the 95 % interval of the fit. Several
recordings and fits may be named in turn; the last line then says how they agree.
"""

import csv
import math
import statistics
import sys
import tomllib

# Rows of 1 ms. Friction follows a switch within 10 rows at 70 mm/s (the lag is 13.8 Hz per mm/s, and the envelope rises in
# less than 10 ms); the row at a switch is a mean over both voltages.
SETTLING_ROWS = 10
ROWS_BEFORE_SWITCH = 2
# Voltages that differ by less are one level.
LEVEL_V = 1.0


def levels(rows):
    """Settled rows of each run of one voltage, as (voltage, rows). Ramps of the envelope are too short to be runs."""
    runs = []
    for row in rows:
        if runs and abs(runs[-1][0] - row["voltage_v_rms"]) < LEVEL_V:
            runs[-1][1].append(row)
        else:
            runs.append((row["voltage_v_rms"], [row]))
    shortest = SETTLING_ROWS + ROWS_BEFORE_SWITCH + 1
    return [(voltage, run[SETTLING_ROWS:-ROWS_BEFORE_SWITCH]) for voltage, run in runs if len(run) >= shortest]


def mean(rows, column):
    return statistics.fmean(row[column] for row in rows)


def differences_n(rows, highest_v):
    """Friction of each run at the highest voltage, less what the runs without voltage on both sides predict for its load."""
    runs = levels(rows)
    for before, driven, after in zip(runs, runs[1:], runs[2:]):
        if abs(driven[0] - highest_v) < LEVEL_V and before[0] == after[0] == 0:
            coefficient = statistics.fmean(
                mean(rest, "friction_n") / mean(rest, "normal_force_n") for _, rest in (before, after)
            )
            yield mean(driven[1], "friction_n") - coefficient * mean(driven[1], "normal_force_n")


def electric_friction_n(recording):
    """Mean over strokes, and its standard error."""
    strokes = {}
    with open(recording, newline="") as file:
        for text in csv.DictReader(file):
            row = {name: float(value) for name, value in text.items()}
            strokes.setdefault(row["stroke"], []).append(row)
    highest_v = max(row["voltage_v_rms"] for rows in strokes.values() for row in rows)
    by_stroke = [list(differences_n(rows, highest_v)) for rows in strokes.values()]
    means = [statistics.fmean(found) for found in by_stroke if found]
    return statistics.fmean(means), statistics.stdev(means) / math.sqrt(len(means))


def fitted_interval_n(profile):
    with open(profile, "rb") as file:
        return tomllib.load(file)["electric_friction_interval_n"]


def main(names):
    if not names or len(names) % 2:
        sys.exit("usage: switched_means.py RECORDING.csv FINGER.toml [RECORDING.csv FINGER.toml ...]")
    differences, inside = [], 0
    for recording, profile in zip(names[::2], names[1::2]):
        value, error = electric_friction_n(recording)
        low, high = fitted_interval_n(profile)
        print(f"{recording}: {1e3 * value:.2f} mN, standard error {1e3 * error:.2f}; fit {1e3 * low:.2f} to {1e3 * high:.2f}")
        differences.append(2 * value / (low + high) - 1)
        inside += low <= value <= high
    rms = math.sqrt(statistics.fmean(difference**2 for difference in differences))
    print(
        f"{len(differences)} recordings: difference {statistics.fmean(differences):+.2%}, rms {rms:.2%}; "
        f"{inside} means in the interval of their fit"
    )


main(sys.argv[1:])
