"""What is round-off of a pair; apart, since the figure needs it and not what makes the table."""

import sys

# of the network's length; our own choice, above what remains between the runs of a pair that
# forgets
ROUND_OFF = 100 * sys.float_info.epsilon
