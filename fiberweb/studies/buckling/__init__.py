"""The study buckling."""
