"""A page of the report shows what its file holds, and offers the file itself."""

import base64
import re

import pandas as pd
import pytest
import xarray as xr

from fiberweb import pages, products


def offered(page):
    return base64.b64decode(re.search(r'<a download="[^"]+" href="data:[^,]+,([^"]+)"', page)[1])


@pytest.mark.parametrize(("rows", "said"), [(3, False), (1500, True)])
def test_a_table(tmp_path, rows, said):
    path = tmp_path / "a.csv"
    products.write(pd.DataFrame({"name": ["<b> & c"] * rows, "c_nl": 0.123456789}), path)
    page = pages.page(path)
    assert "&lt;b&gt; &amp; c" in page and "0.12346" in page
    assert page.count("<tr") == min(rows, pages.MOST_ROWS) + 1
    assert ("The first 1000 of 1500 rows" in page) == said
    assert offered(page) == path.read_bytes()


def test_a_dataset_and_an_animation(tmp_path):
    products.write(xr.Dataset({"c": ("order", [0.5])}, attrs={"status": "ok"}), tmp_path / "a.nc")
    page = pages.page(tmp_path / "a.nc")
    assert "status" in page and offered(page) == (tmp_path / "a.nc").read_bytes()
    (tmp_path / "b.gif").write_bytes(b"GIF89a")
    assert f"base64,{base64.b64encode(b'GIF89a').decode()}" in pages.page(tmp_path / "b.gif")


def test_no_page_asks_for_another_file(tmp_path):
    products.write(pd.DataFrame({"link": ["https://example.org"]}), tmp_path / "a.csv")
    for page in (pages.page(tmp_path / "a.csv"), pages.of_calls([{"commit": None}])):
        assert not re.search(r'(src|href)="(?!data:|#)', page)
