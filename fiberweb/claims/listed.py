"""The list of the paper's claims."""

from __future__ import annotations

from pathlib import Path

import yaml


def load() -> list[dict]:
    """The claims in the paper's order: dicts with id, figure, kind, statement and, by kind,
    paper and tolerance, or range."""
    text = Path(__file__).with_name("claims.yaml").read_text(encoding="utf-8")
    return yaml.safe_load(text)
