"""The study chaos."""
