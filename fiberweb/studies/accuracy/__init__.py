"""The study accuracy."""
