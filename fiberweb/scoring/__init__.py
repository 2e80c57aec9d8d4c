"""From responses to capacities and tables."""
