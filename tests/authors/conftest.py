"""These tests need PyElastica 0.3.2, which the authors ran: `make test_authors` installs it into an
environment of its own. Elsewhere nothing here is collected."""

from importlib.metadata import version

collect_ignore_glob = [] if version("pyelastica") == "0.3.2" else ["test_*.py"]
