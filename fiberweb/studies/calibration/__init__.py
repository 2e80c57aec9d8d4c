"""The study calibration."""
