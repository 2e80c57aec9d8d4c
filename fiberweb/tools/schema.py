"""What is generated from the config's models; `python -m fiberweb.tools.schema` writes it.

config/schema.json is for editors, and config/README.md has a table of every key.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import get_args

from fiberweb.config import Config
from fiberweb.sections import Section, is_section

FOLDER = Path(__file__).parents[2] / "config"
TABLE_STARTS = "<!-- The table is written by `python -m fiberweb.tools.schema`. -->\n"


def schema() -> str:
    """The JSON schema of the config, as config/schema.json has it."""
    return json.dumps(Config.model_json_schema(), indent=2) + "\n"


def table() -> str:
    """Every key with default, unit, range, meaning and section of the paper, in Markdown."""
    lines = ["| key | default | unit | range | meaning | paper |", "|---|---|---|---|---|---|"]
    lines += ["| " + " | ".join(row) + " |" for row in rows(Config())]
    return "\n".join(lines) + "\n"


def rows(section: Section, prefix: str = "") -> Iterator[tuple[str, ...]]:
    """The cells of the table, section by section, for a config of default values."""
    properties = section.model_json_schema()["properties"]
    for name, field in type(section).model_fields.items():
        value = getattr(section, name, "")  # a key that has to be given has none
        if isinstance(value, Section):
            yield from rows(value, f"{prefix}{name}.")
            continue
        if isinstance(value, list) and is_section(item := get_args(field.annotation)[0]):
            yield from rows(item.model_construct(), f"{prefix}{name}[].")
            continue
        extra = field.json_schema_extra
        default = json.dumps(value).strip('"')
        yield (
            f"`{prefix}{name}`", f"`{default}`", extra["unit"] or "–",
            _range(properties[name]), field.description, extra["paper"] or "–",
        )  # fmt: skip


def _range(schema: dict) -> str:
    if "const" in schema:
        return str(schema["const"])
    if "anyOf" in schema:
        return " or ".join(_range(part) for part in schema["anyOf"])
    if "enum" in schema:
        return ", ".join(map(str, schema["enum"]))
    if schema["type"] == "array":
        return f"list: {_range(schema['items'])}"
    bounds = {"exclusiveMinimum": "> {:.10g}", "minimum": "≥ {:.10g}", "maximum": "≤ {:.10g}"}
    parts = ["even"] if schema.get("multipleOf") == 2 else []
    parts += ["whole"] if schema["type"] == "integer" and not parts else []
    parts += [text.format(schema[name]) for name, text in bounds.items() if name in schema]
    names = {"string": "text", "boolean": "true, false", "object": "group"}
    return ", ".join(parts) or names.get(schema["type"], schema["type"])


def main() -> None:
    """Write both files."""
    (FOLDER / "schema.json").write_text(schema(), encoding="utf-8")
    readme = FOLDER / "README.md"
    above = readme.read_text(encoding="utf-8").split(TABLE_STARTS)[0]
    readme.write_text(above + TABLE_STARTS + "\n" + table(), encoding="utf-8")


if __name__ == "__main__":
    main()
