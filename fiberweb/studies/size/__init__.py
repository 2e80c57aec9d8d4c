"""The study size."""
