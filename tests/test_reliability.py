"""docs/reliability.md says what `make test-faults` does."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).parents[1]


def test_every_fault_is_a_test_and_every_test_of_a_fault_is_listed():
    files = [ast.parse(path.read_text()) for path in (ROOT / "tests" / "faults").glob("test_*.py")]
    tests = [node.name for file in files for node in file.body if isinstance(node, ast.FunctionDef)]
    text = (ROOT / "docs" / "reliability.md").read_text()
    listed = re.findall(r"`(test_\w+)` \|$", text, re.MULTILINE)
    assert sorted(listed) == sorted(name for name in tests if name.startswith("test_"))
