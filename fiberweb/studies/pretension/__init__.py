"""The study pretension."""
