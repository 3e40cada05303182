"""Play a grating under the fingers of simulated people, on all processors, and print what each felt."""

from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import frixel
import numpy as np

GRATING = {"kind": "grating", "wavelength_mm": 4, "low_fraction": 0.1, "high_fraction": 0.9}


def main() -> None:
    """Play the same stroke under each finger."""
    stroke = frixel.Stroke.straight((10, 40), (110, 40), minimum_jerk=True)
    cells = [{"scene": {"layer": [GRATING]}, "stroke": stroke, "person": person} for person in range(4)]
    # With "spawn", each process imports the module itself, on every system and on clusters.
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        for cell, recording in zip(cells, pool.map(frixel.run, cells), strict=True):
            least, most = np.nanpercentile(recording["felt_n"], [5, 95])
            print(f"person {cell['person']}: {1e3 * least:.0f} to {1e3 * most:.0f} mN")


if __name__ == "__main__":
    main()
