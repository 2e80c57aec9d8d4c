"""Commands: what a run costs, what two tables differ by, the config's schema."""
