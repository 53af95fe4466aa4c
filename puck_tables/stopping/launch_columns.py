"""What is known of launches that were found: the columns that one aim and many share."""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.result import Result


class Aimed(Result):
    """Launches of a ``puck``: velocities (n, 2) m/s and spins (n,) rad/s, and what follows."""

    puck: PuckSpec
    launch_velocity: FloatArray
    launch_spin: FloatArray

    @property
    def launch_vx(self) -> FloatArray:
        """Launch velocity along x, m/s."""
        return self.launch_velocity[:, 0]

    @property
    def launch_vy(self) -> FloatArray:
        """Launch velocity along y, m/s."""
        return self.launch_velocity[:, 1]

    @property
    def launch_speed(self) -> FloatArray:
        """Launch speed, m/s."""
        return np.hypot(self.launch_vx, self.launch_vy)

    @property
    def launch_heading(self) -> FloatArray:
        """Direction of the velocity at the launch, rad."""
        return np.arctan2(self.launch_vy, self.launch_vx)

    @property
    def launch_slip_angle(self) -> FloatArray:
        """Slip angle atan2(rω, v) at the launch, rad."""
        return np.arctan2(self.puck.radius * self.launch_spin, self.launch_speed)
