"""The study robustness."""
