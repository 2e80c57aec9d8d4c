"""How far off our numbers are, and where the steps end."""
