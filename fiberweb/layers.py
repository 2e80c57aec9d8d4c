"""What a config is made of: files, each laid over the one before it, and the command line."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from datetime import date
from pathlib import Path

from fiberweb.arguments import shown
from fiberweb.untrusted import called, check_entry, other_base, values


def read(path: str | Path) -> Mapping:
    """The keys of a YAML or JSON file.

    Raises:
        ValueError: one sentence, if it is neither, gives a key twice, or is refused otherwise by
            `fiberweb.untrusted`.
    """
    held = values(path)
    if held is None:
        return {}
    if not isinstance(held, Mapping):
        raise ValueError(f"{path} holds {shown(held)}: a config is a group of keys")
    return held


def check_call() -> None:
    """Raise ValueError, one sentence, if ``--config`` of this call of Snakemake gives a key twice.

    Of ``--config 'scene={duration: 20, duration: 30}'`` Snakemake would keep the last one. Groups
    given in two parts are one group.
    """
    try:
        entries = called().config or ()
    except LookupError:
        return  # a library's call has no command line
    given = set()
    for entry in entries:
        check_entry(entry)
        for key in _keys(entry):
            if key in given:
                raise ValueError(f"--config gives {key} twice: keep one of them")
            given.add(key)


def overlay(below: Mapping, above: Mapping) -> dict:
    """Both groups of keys; what is above wins, key by key also within groups."""
    merged = dict(below)
    for name, value in above.items():
        both = isinstance(value, Mapping) and isinstance(merged.get(name), Mapping)
        merged[name] = overlay(merged[name], value) if both else value
    return merged


def typed(given: Mapping) -> dict:
    """What the command line gave, as a file would.

    Of ``--config published_all=True 'scene={duration: 20}'`` Snakemake gives the first value as
    such, and the one within a group as text.
    """
    groups = (Mapping, list)
    return {name: _typed(at) if isinstance(at, groups) else at for name, at in given.items()}


def is_number(text: str) -> bool:
    """Whether text is a number to Python, if not to YAML."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def _typed(value):
    import yaml

    if isinstance(value, Mapping):
        return {name: _typed(each) for name, each in value.items()}
    if isinstance(value, list):
        return [_typed(each) for each in value]
    if not isinstance(value, str):
        return value
    if other_base(value):
        return value
    loader = yaml.SafeLoader("")
    kind = loader.resolve(yaml.ScalarNode, value, (True, False))
    try:
        read = loader.construct_object(yaml.ScalarNode(kind, value))
    except (ValueError, OverflowError):  # 2024-99-99, or thousands of digits
        return value
    if isinstance(read, str) and is_number(read):
        return float(read)  # 1e3, which YAML takes for text
    return value if isinstance(read, date) else read


def _keys(entry: str) -> Iterator[str]:
    """The key of an entry of ``--config``, or those within it."""
    import yaml

    name, _, text = entry.partition("=")
    try:
        yield from _leaves(yaml.compose(text), (name,))
    except yaml.YAMLError:  # text to Snakemake, too
        yield name


def _leaves(node, above: tuple[str, ...]) -> Iterator[str]:
    import yaml

    if not isinstance(node, yaml.MappingNode):
        yield ".".join(above)
        return
    for key, value in node.value:
        yield from _leaves(value, (*above, str(key.value)))
