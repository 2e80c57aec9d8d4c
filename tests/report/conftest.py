"""These tests need Chromium and what envs/report.lock installs: `make test-report`. Elsewhere
nothing here is collected."""

from importlib.util import find_spec

collect_ignore_glob = [] if find_spec("playwright") else ["test_*.py"]
