"""What a module depends on in this package, read off its imports, and a digest of all of it.

The digest is that of the code alone: comments, docstrings and layout do not enter. A string that
names a module of the package, as in a table of things to import later, counts as an import; one
that names a file beside the module, as that file being read.
"""

from __future__ import annotations

import ast
import hashlib
import re
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parent
NAMED = re.compile(rf"({ROOT.name}(?:\.\w+)+)(?::\w+)?")  # module, or module:function
RUN = "fiberweb.simulation.simulate"  # all that a response depends on hangs on this module


@cache
def source_hash() -> str:
    """Digest of everything that a response depends on: part of its file, and of the place of
    compiled kernels."""
    return digest(RUN)[:12]


def digest(*names: str, script: str | Path | None = None) -> str:
    """SHA-256 of the code of modules and of all that they import, as hexadecimal digits.

    Args:
        names: of modules, or of functions as in "fiberweb.scoring.tables:study".
        script: a file whose own code counts as well, but not what it imports.

    Raises:
        ValueError: there is no such module.
    """
    total = hashlib.sha256(_read(Path(script))[1].encode() if script else b"")
    for path in sorted(files(*names)):
        total.update(f"{path.relative_to(ROOT)} {_read(path)[1]}\n".encode())
    return total.hexdigest()


def files(*names: str) -> set[Path]:
    """The files of modules and of everything that they import; arguments as for `digest`."""
    queue, found = [_file(name.partition(":")[0]) for name in names], set()
    for name, path in zip(names, queue):
        if path is None:
            raise ValueError(f"{name} names no module of {ROOT.name}")
    while queue:
        path = queue.pop()
        if path not in found:
            found.add(path)
            queue += _read(path)[0]
    return found


def _named_by(folder: Path, nodes: Iterable[ast.AST]) -> Iterator[Path]:
    for node in nodes:
        match node:
            case ast.Import(names=aliases):
                modules = [_file(alias.name) for alias in aliases]
            case ast.ImportFrom(module=str(module), names=aliases):
                # a name is a module of the package, or else something within its __init__
                inner = [_file(f"{module}.{alias.name}") for alias in aliases]
                modules = inner if all(inner) else [*inner, _file(module)]
            case ast.Constant(value=str(text)) if len(text) < 100:
                named = NAMED.fullmatch(text)
                beside = folder / text if re.fullmatch(r"\w+\.(yaml|json|mplstyle)", text) else None
                modules = [_file(named[1]) if named else None]
                modules += [beside] if beside and beside.is_file() else []
            case _:
                continue
        yield from filter(None, modules)


@cache
def _file(name: str) -> Path | None:
    """The file of a module of the package, or None."""
    package, *parts = name.split(".")
    if package != ROOT.name:
        return None
    place = ROOT.joinpath(*parts)
    module = place.with_name(f"{place.name}.py")
    inner = place / "__init__.py"
    return module if parts and module.is_file() else inner if inner.is_file() else None


@cache
def _read(path: Path) -> tuple[tuple[Path, ...], str]:
    """What one file imports or names, and a digest of what it does."""
    text = path.read_bytes()
    if path.suffix != ".py":
        return (), hashlib.sha256(text).hexdigest()
    tree = ast.parse(text)
    nodes = list(ast.walk(tree))  # once: every simulation pays for this at its start
    used = tuple(dict.fromkeys(_named_by(path.parent, nodes)))
    for node in nodes:
        owner = isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef))
        if owner and ast.get_docstring(node, clean=False) is not None:
            node.body = node.body[1:]
    return used, hashlib.sha256(ast.dump(tree).encode()).hexdigest()
