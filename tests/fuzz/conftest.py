"""How many cases `make fuzz` has hypothesis try of each test: three of configs and three of
recordings make some ten thousand of either."""

from hypothesis import HealthCheck, settings

settings.register_profile(
    "fuzz", max_examples=3_400, deadline=None, suppress_health_check=[*HealthCheck]
)
