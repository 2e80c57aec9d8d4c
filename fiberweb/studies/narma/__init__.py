"""The study narma."""
