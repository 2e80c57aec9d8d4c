"""What the report shows of a table, a dataset or an animation: a page of its own that asks for no
other file, since Snakemake's report shows pictures and pages alone."""

from __future__ import annotations

from base64 import b64encode
from html import escape
from pathlib import Path

from fiberweb import products

MOST_ROWS = 1000  # of a table; the file that the page offers has all
STYLE = """
body { font: 14px sans-serif; margin: 1em }
table { border-collapse: collapse; width: max-content }
th { position: sticky; top: 0; background: #eee }
th, td { max-width: 36em; padding: 2px 8px; border-bottom: 1px solid #ddd }
th, td { text-align: left; font-weight: normal }
img { max-width: 100% }
"""


def page(path: str | Path) -> str:
    """HTML of a table (.csv), a dataset (.nc) or an animation (.gif), which it offers as a file."""
    path = Path(path)
    if path.suffix == ".gif":
        return _whole(path.name, f'<img alt="{escape(path.name)}" src="{_embedded(path)}">')
    offered = f'<p><a download="{escape(path.name)}" href="{_embedded(path)}">Save the file</a></p>'
    product = products.read(path)
    if path.suffix == ".nc":
        return _whole(path.name, offered, product._repr_html_())
    shown = product.head(MOST_ROWS).to_html(index=False, na_rep="", float_format="{:.5g}".format)
    cut = f"<p>The first {MOST_ROWS} of {len(product)} rows; the file has all.</p>"
    return _whole(path.name, offered, cut if len(product) > MOST_ROWS else "", shown)


def of_calls(calls: list[dict]) -> str:
    """HTML of what made the results (`fiberweb.provenance`), the last call first."""
    rows = [
        f"<tr><th>{escape(key)}</th><td>{escape(_words(value))}</td></tr>"
        for call in reversed(calls)
        for key, value in {"": "", **call}.items()
    ]
    return _whole("provenance", '<table style="white-space: pre-wrap">', *rows, "</table>")


def _whole(title: str, *parts: str) -> str:
    head = f'<meta charset="utf-8"><title>{escape(title)}</title><style>{STYLE}</style>'
    body = "\n".join(parts)
    return f'<!doctype html>\n<html lang="en"><head>{head}</head>\n<body>\n{body}\n</body></html>\n'


def _embedded(path: Path) -> str:
    kinds = {".gif": "image/gif", ".csv": "text/csv", ".nc": "application/x-netcdf"}
    return f"data:{kinds[path.suffix]};base64,{b64encode(path.read_bytes()).decode()}"


def _words(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{key} {version}" for key, version in value.items())
    return "unknown" if value is None else str(value)
