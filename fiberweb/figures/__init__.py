"""What figures share: their look, axes of capacities, and parts of panels.

Each study's `figure.py` has ``draw(given, setup, **options)``, a `style.drawing`, so called with a
path too. It only draws: every number comes from ``given``, tables and datasets by file name without
suffix. It draws one setup, writes PNG and PDF beside each other, whichever suffix the path has, and
returns the figure. Rows of the other setup are left out, and an unstable run is an X. ValueError,
one sentence: a table has no run of the setup.
"""
