"""The study features."""
