"""What the CF conventions ask of a file beside a name and a unit for every variable, which
`fiberweb.meanings` gives: what it is, and what made it.

Time is in seconds from the start, and no date: it has no standard_name, since CF's `time` is one.
"""

from __future__ import annotations

import xarray as xr

CONVENTIONS = "CF-1.11"
OF_FILES = {"Conventions": CONVENTIONS, "source": "fiberweb"}


def labelled(data: xr.Dataset) -> xr.Dataset:
    """A Dataset with the attributes that CF asks for; a value of its own stays as it is."""
    title = str(data.attrs.get("run", "fibre networks as physical reservoirs"))
    return data.assign_attrs(OF_FILES | {"title": title} | data.attrs)


def unlabelled(data: xr.Dataset) -> xr.Dataset:
    """The same without what `labelled` said of the file."""
    said = [name for name, value in OF_FILES.items() if data.attrs.get(name) == value]
    return data.drop_attrs(deep=False).assign_attrs(
        {name: value for name, value in data.attrs.items() if name not in (*said, "title")}
    )
