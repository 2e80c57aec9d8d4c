"""Figures: style and drawing only."""
