"""The study ridge."""
