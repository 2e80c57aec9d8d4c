"""These tests run the smallest of workflows in clones of their own, from a minute to some minutes
each: `make test-anywhere`. Elsewhere nothing here is collected."""

import os

collect_ignore_glob = [] if os.environ.get("ANYWHERE") else ["test_*.py"]
