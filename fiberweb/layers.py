"""What a config is made of: files, each laid over the one before it, and the command line."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from datetime import date
from pathlib import Path


def read(path: str | Path) -> Mapping:
    """The keys of a YAML or JSON file.

    Raises:
        ValueError: one sentence, if it is neither, or gives a key twice.
    """
    import yaml

    try:
        values = yaml.safe_load(_text(path))
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = f" in line {mark.line + 1}" if mark else ""
        raise ValueError(
            f"{path} is no YAML: {getattr(error, 'problem', None) or 'it cannot be read'}{where}"
        ) from None
    if values is None:
        return {}
    if not isinstance(values, Mapping):
        raise ValueError(f"{path} holds {values!r}: a config is a group of keys")
    check_keys(path)
    return values


def check_keys(path: str | Path) -> None:
    """Raise ValueError, one sentence, if a file gives a key twice: YAML would keep the last one."""
    import yaml

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # the first is ten times as fast
    # JSON may be indented by tabs, which YAML refuses; no value of either holds one
    node = yaml.compose(_text(path).replace("\t", " "), Loader=loader)
    for key, first, second in _twice(node, ()):
        lines = f"line {first}" if first == second else f"lines {first} and {second}"
        raise ValueError(f"{path} gives {key} twice, in {lines}: keep one of them")


def check_call(arguments: Sequence[str]) -> None:
    """Raise ValueError, one sentence, if ``--config`` gives a key twice.

    Of ``--config 'scene={duration: 20, duration: 30}'`` Snakemake would keep the last one. Groups
    given in two parts are one group.
    """
    given = set()
    for key in _given_keys(arguments):
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
    try:
        read = yaml.safe_load(value)
    except yaml.YAMLError:
        return value
    if isinstance(read, str) and is_number(read):
        return float(read)  # 1e3, which YAML takes for text
    return value if isinstance(read, (Mapping, list, date)) else read


def _given_keys(arguments: Sequence[str]) -> Iterator[str]:
    """Every key that follows ``--config``, within groups as well."""
    import yaml

    within = False
    for argument in arguments:
        option, _, first = argument.partition("=")
        if argument.startswith("-"):
            within = option in ("--config", "-C")
            argument = first
        name, _, text = argument.partition("=")
        if within and name:
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


def _text(path: str | Path) -> str:
    return Path(path).read_text(encoding="utf-8-sig")


def _twice(node, above: tuple[str, ...]) -> Iterator[tuple[str, int, int]]:
    """(key, line, line) of every key that a mapping has twice, and of those within it."""
    import yaml

    if isinstance(node, yaml.SequenceNode):
        for each in node.value:
            yield from _twice(each, above)
    if not isinstance(node, yaml.MappingNode):
        return
    lines: dict[str, int] = {}
    for key, value in node.value:
        name, line = str(key.value), key.start_mark.line + 1
        if name in lines:
            yield ".".join((*above, name)), lines[name], line
        lines[name] = line
        yield from _twice(value, (*above, name))
