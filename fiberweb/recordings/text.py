"""Text files of numbers as trackers and spreadsheets write them: encoding, separators, cells."""

from __future__ import annotations

import codecs
import csv
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd

from fiberweb.errors import brief, unknown_key
from fiberweb.recordings.base import Finding, check_size, head
from fiberweb.recordings.options import Reading

ROWS, CELLS = 200_000, 10_000_000  # held as text at once
MOST_COLUMNS = 20_000


@dataclass
class Text:
    """How the text of a file is to be read, and what is unusual about it."""

    path: Path
    encoding: str
    separator: str
    decimal: str
    lines: list[list[str]]  # the first ones, as cells
    findings: list[Finding] = field(default_factory=list)


def sniff(path: Path) -> Text:
    """Encoding, separator and decimal mark of a file, and the cells of its first lines.

    Raises:
        ValueError: it cannot be read, is empty, or is no text; one sentence.
    """
    first, findings = head(path), []
    if b"\0" in first:
        raise ValueError(f"{path} holds bytes that are no text: name the format, or another file")
    encoding = _encoding(path)
    if first.startswith(codecs.BOM_UTF8):
        findings.append(Finding("encoding", "repair", "a byte-order mark was left out"))
    if encoding == "latin-1":
        findings.append(Finding("encoding", "repair", "no UTF-8, so it was read as Latin-1"))
    if b"\r\n" in first:
        findings.append(Finding("encoding", "note", "lines end as on Windows (CRLF)"))
    text = first.decode(encoding, errors="ignore").replace("\r\n", "\n")
    lines = text.split("\n")[:20]
    header = next((line for line in lines if line.strip()), "")
    separator = max("\t;,", key=header.count)
    try:
        cells = list(csv.reader(lines, delimiter=separator))
    except csv.Error as error:
        raise ValueError(f"{path} cannot be read as a table: {error}") from None
    if (width := max(map(len, cells))) > MOST_COLUMNS:
        raise ValueError(
            f"{path} has {width} columns: more than {MOST_COLUMNS} are no recording: export fewer"
        )
    decimal = "."
    values = [cell.strip() for row in cells[1:] for cell in row]
    if separator != "," and any(_decimal_comma(value) for value in values):
        decimal = ","
        findings.append(Finding("encoding", "repair", "decimal commas were read as points"))
    return Text(path, encoding, separator, decimal, cells, findings)


def numbers(
    text: Text, wanted: Mapping[str, int], skip: int, width: int
) -> tuple[dict[str, np.ndarray], int]:
    """Columns of numbers, and the line that their first row stands in.

    Args:
        text: from `sniff`.
        wanted: what each column is called, and its number in the file.
        skip: lines of the header.
        width: columns that the header has.

    Returns:
        (T,) float of each column; NaN where a cell is empty.

    Raises:
        ValueError: a cell that is no number, or a row with too many; with file, column and row.
    """
    blocks = _blocks(text, width, skip)
    parts: dict[str, list[np.ndarray]] = {name: [] for name in wanted}
    start = skip + 1
    for block in blocks:
        if (beyond := block[width].notna().to_numpy()).any():
            comma = " (decimal commas need another separator)" if text.separator == "," else ""
            raise ValueError(
                f"{text.path}, row {start + int(np.argmax(beyond))} has more cells than the "
                f"header's {width}{comma}"
            )
        for name, number in wanted.items():
            column = block[number]
            if column.dtype.kind not in "fiu":
                column = _as_numbers(text, column, name, start)
            parts[name].append(column.to_numpy(float))
        start += len(block)
        check_size(text.path, start * len(wanted))
    if start == skip + 1:
        raise ValueError(f"{text.path} has a header and no rows of numbers")
    return {name: np.concatenate(parts.pop(name)) for name in wanted}, skip + 1


def find(text: Text, header: list[str], name: str, key: str) -> int:
    """The number of a column by its name; ValueError, one sentence, if there is not exactly one."""
    found = [number for number, column in enumerate(header) if column == name]
    if len(found) == 1:
        return found[0]
    if found:
        raise ValueError(
            f"{text.path}: its header has {len(found)} columns {name!r}, numbers "
            f"{', '.join(str(n + 1) for n in found)}: give each a name of its own"
        )
    raise ValueError(f"{text.path}: {key}: {unknown_key(name, header, kind='column')}")


def refuse_markers(path: Path, options: Reading) -> None:
    """Raise ValueError, one sentence, if markers are named for a file that names them itself."""
    if options.markers is not None:
        raise ValueError(
            f"{path}: markers = {brief(options.markers)}: a file of this format names its markers "
            "itself: leave it out"
        )


def duplicated(names: Iterable[str]) -> list[str]:
    """The names that come more than once."""
    return [name for name, count in Counter(names).items() if count > 1 and name]


def _encoding(path: Path) -> str:
    """UTF-8 if all of the file is, else Latin-1, in which every byte is a character."""
    decoder = codecs.getincrementaldecoder("utf-8-sig")()
    with path.open("rb") as file:
        try:
            while block := file.read(1 << 24):
                decoder.decode(block)
            decoder.decode(b"", final=True)
        except UnicodeDecodeError:
            return "latin-1"
    return "utf-8-sig"


def _decimal_comma(cell: str) -> bool:
    whole, comma, rest = cell.lstrip("+-").partition(",")
    return bool(comma) and whole.isdigit() and rest[:1].isdigit()


def _blocks(text: Text, width: int, skip: int):
    try:
        # one column more than the header has shows what lies beyond it
        yield from pd.read_csv(
            text.path, sep=text.separator, decimal=text.decimal, encoding=text.encoding,
            header=None, names=range(width + 1), skiprows=skip, index_col=False,
            skip_blank_lines=False, low_memory=False, skipinitialspace=True, compression=None,
            chunksize=min(ROWS, CELLS // (width + 1)),
        )  # fmt: skip
    except pd.errors.EmptyDataError:
        return
    except (pd.errors.ParserError, UnicodeDecodeError) as error:
        raise ValueError(f"{text.path} cannot be read as a table: {str(error).strip()}") from None


def _as_numbers(text: Text, column: pd.Series, name: str, start: int) -> pd.Series:
    """A column of cells, some of them text, as numbers if only blanks are in the way."""
    cells = column.astype(str).str.strip()
    plain = cells.str.replace(",", ".") if text.decimal == "," else cells
    values = pd.to_numeric(plain, errors="coerce")
    blank = column.isna() | cells.isin(["", "nan", "NaN"])
    wrong = (values.isna() & ~blank).to_numpy()
    if not wrong.any():
        return values
    at = int(np.argmax(wrong))
    cell = cells.iloc[at]
    if cell == name:
        raise ValueError(
            f"{text.path} repeats its header in row {start + at}: two takes were joined there, so "
            "split them"
        )
    raise ValueError(
        f"{text.path}, column {name!r}, row {start + at}: {cell[:40]!r} is no number; leave the "
        "cell empty if nothing was measured"
    )
