"""A hash of the engines' sources: part of every file, and of the place of compiled kernels."""

from __future__ import annotations

import hashlib
from pathlib import Path

HERE = Path(__file__).parent
PHYSICS = ("mesh.py", "drive.py", "scene.py", "network.py")


def source_hash() -> str:
    """Hash of everything that a trajectory depends on in this package."""
    files = sorted(HERE.glob("*.py")) + [HERE.parent / name for name in PHYSICS]
    digest = hashlib.sha256()
    for file in files:
        digest.update(file.read_bytes())
    return digest.hexdigest()[:12]
