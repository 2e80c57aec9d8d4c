"""The study topology."""
