"""The study memory_origin."""
