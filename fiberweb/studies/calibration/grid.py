"""What the grid is over; apart, since the figure needs it and not what makes the table."""

SIZE = 8  # N of the crosshatch of Fig. 1d
# columns of the grid's axes, and the fields of a scene that they are
GRID = {
    "crossing_stiffness_N_m": "crossing_stiffness",
    "crossing_damping_Ns_m": "crossing_damping",
    "damping_per_s": "damping",
}
