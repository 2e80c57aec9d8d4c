"""From a scene to its response: plan, simulate, explain, and the NetCDF file."""
