"""A session of six trials, which the tests of `test_interruptions.py` interrupt from outside.

Called with a folder and a port, or `sim`. Says each marker, and reads each answer from a line of standard input.
"""

import sys
import threading
import time

from frixel import Device, Stroke
from frixel.experiment import TWO_ALTERNATIVES, ConstantStimuli, Session, Trial

INTERRUPTED = 2
"""Number of the trial in which something goes wrong."""
STROKE = Stroke.straight((20, 40), (40, 40), speed_mm_s=100)


def said(marker: str, trial: Trial) -> None:
    """Say a marker."""
    print(marker, trial.number, flush=True)


def watch(device: Device, trial: Trial) -> None:
    """Say when the board plays."""
    while device._state != "active":
        time.sleep(0.01)
    said("active", trial)


def main(folder: str, port: str) -> None:
    """Run the session."""
    device = None if port == "sim" else Device.open(port)
    with Session(folder, "p01", TWO_ALTERNATIVES, seed=7, on_marker=said) as session:

        def play(trial: Trial) -> None:
            scene = {"layer": [{"kind": "constant", "above": "zero", "friction_n": 0.28 * (1 + trial.level)}]}
            if device is None:
                session.play(scene, stroke=STROKE, ideal=True)
            else:
                threading.Thread(target=watch, args=(device, trial), daemon=True).start()
                # The play that is interrupted has not ended before, on a busy machine either.
                session.play(scene, on=device, seconds=1.0 if trial.number < INTERRUPTED else 10.0)

        session.run(ConstantStimuli([0.1, 0.2, 0.3], 2, seed=3), play, lambda trial: int(sys.stdin.readline()))
    if device is not None:
        device.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
