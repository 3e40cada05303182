"""Draw the paper's Fig. 4: the contact radius over the voltage, for relative normal forces of both signs."""

import sys

import matplotlib.pyplot as plt
import numpy as np
from frixel import model

finger = model.Contact(radius_m=8e-3, stiffness_pa_per_m=1.8e7, friction_coefficient=0.5, gap_m=10e-6)
voltage = np.linspace(0, 1.8, 400)[:, None] * finger.voltage_scale_v_rms
relative_force = np.array([-20, -10, -5, -1, 0, 1, 5, 10, 20])
states = model.eval(finger, voltage, relative_force / np.pi * finger.load_scale_n)
plt.plot(voltage, 1e3 * states.contact_radius_m, label=[f"f_N = {force}" for force in relative_force])
plt.xlabel("voltage, V rms")
plt.ylabel("contact radius, mm")
plt.legend()
plt.savefig(sys.argv[1] if len(sys.argv) > 1 else "fig4.png")
