"""Tables of the pages in docs/, from a small made-up results folder."""

import re

import pytest

from fiberweb.tools import docs

PAGE = """# Results

Text above.

<!-- table: described/topology -->

| old |
|---|

<!-- end -->

Text between, with a | in it.

<!-- table: claims -->
<!-- end -->
<!-- table: published/topology -->

kept

<!-- end -->
"""
TOPOLOGY = """setup,topology,n,buckling_number,c_nl,c_m,c_nl_se,c_m_se,status
described,crosshatch,4,0.3234,0.62951,0.3671,0.012,0.0048,ok
described,polygon,6,0.2587,,,,,unstable
"""
CLAIMS = "id,figure,kind,statement,paper,value,verdict\n"
DESCRIBED = CLAIMS + (
    'T1,topology,value,"8x8 crosshatch, c[P4]",0.999,1.000,calibrated\n'
    "N5,narma,order,|mean error| well under the RMSE,,,not computed\n"
)
PUBLISHED = CLAIMS + 'T1,topology,value,"8x8 crosshatch, c[P4]",0.999,0.998,holds\n'
STABILITY = """engine,network,ratio,automatic_step_status
kirchhoff,2x2,0.9751,ok
kirchhoff,2x2,,ok
kirchhoff,2x2,0.9999,unstable
cosserat,2x2,0.98,ok
"""

WRITTEN = """# Results

Text above.

<!-- table: described/topology -->

| network | B | C_nl | C_m |
| --- | --- | --- | --- |
| 4x4 | 0.32 | 0.630 ± 0.012 | 0.367 ± 0.005 |
| polygon, N = 6 | 0.26 | unstable | unstable |

<!-- end -->

Text between, with a | in it.

<!-- table: claims -->

| id | statement | paper | described | described verdict | published | published verdict |
| --- | --- | --- | --- | --- | --- | --- |
| T1 | 8x8 crosshatch, c[P4] | 0.999 | 1.000 | calibrated | 0.998 | holds |
| N5 | \\|mean error\\| well under the RMSE | – | – | not computed | – | – |

<!-- end -->
<!-- table: published/topology -->

kept

<!-- end -->
"""


@pytest.fixture
def results(tmp_path):
    """A results folder with a few small tables."""
    files = {
        "described/topology": TOPOLOGY,
        "described/claims": DESCRIBED,
        "published/claims": PUBLISHED,
        "stability": STABILITY,
    }
    for name, text in files.items():
        path = tmp_path / "results" / "tables" / f"{name}.csv"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path / "results"


@pytest.fixture
def page(tmp_path):
    path = tmp_path / "docs" / "results.md"
    path.parent.mkdir()
    path.write_text(PAGE)
    return path


def test_tables_are_written_and_a_missing_one_keeps_its_block(results, page, capsys):
    docs.main(results, page.parent)
    assert page.read_text() == WRITTEN
    first, second = capsys.readouterr().out.splitlines()
    assert first.startswith("results.md: published/topology stays as it is, because ")
    assert second == "results.md: written"


def test_a_second_call_changes_nothing(results, page, capsys):
    docs.main(results, page.parent)
    capsys.readouterr()
    before = page.stat().st_mtime_ns
    docs.main(results, page.parent)
    assert page.stat().st_mtime_ns == before
    assert "written" not in capsys.readouterr().out


def test_claims_of_one_setup_alone(results):
    (results / "tables" / "published" / "claims.csv").unlink()
    _, columns = docs.read("claims", results / "tables")
    assert list(columns) == ["id", "statement", "paper", "described", "described verdict"]


def rewritten_with_one(results, setup, text):
    """The page written with both setups, and again with the claims of one that has changed."""
    both, _ = docs.rewrite(PAGE, results / "tables")
    for path in (results / "tables").glob("*/claims.csv"):
        path.unlink()
    (results / "tables" / setup / "claims.csv").write_text(text)
    return docs.rewrite(both, results / "tables")[0]


def test_claims_of_a_setup_that_was_not_run_again_are_kept(results):
    again = rewritten_with_one(results, "published", PUBLISHED.replace("0.998", "0.997"))
    # N5 is not among the claims any more
    lines = WRITTEN.replace("0.998", "0.997").splitlines(keepends=True)
    assert again == "".join(line for line in lines if not line.startswith("| N5"))


def test_a_verdict_on_another_statement_is_not_kept(results):
    again = rewritten_with_one(results, "described", DESCRIBED.replace("8x8 cross", "6x6 cross"))
    assert "| T1 | 6x6 crosshatch, c[P4] | 0.999 | 1.000 | calibrated | – | – |" in again


def test_stable_steps_are_one_row_an_engine(results):
    page, left = docs.rewrite("<!-- table: stability -->\n<!-- end -->\n", results / "tables")
    assert left == []
    assert page.splitlines()[4:6] == [
        "| cosserat | 1 | 0.980 to 0.980 | 1 |",
        "| kirchhoff | 3 | 0.975 to 1.000 | 2 |",
    ]


def test_a_block_without_an_end_is_one_sentence(results):
    page = PAGE.replace("<!-- end -->\n\nText", "\n\nText")
    with pytest.raises(ValueError, match="'described/topology' does not end with a line"):
        docs.rewrite(page, results / "tables")


def test_an_unknown_table_is_one_sentence(results):
    with pytest.raises(ValueError, match="table 'described/topolgy' is not known; choose one of"):
        docs.rewrite("<!-- table: described/topolgy -->\n<!-- end -->\n", results / "tables")


def test_every_block_of_the_pages_is_known_and_ends(tmp_path):
    for path in docs.DOCS.glob("*.md"):
        page = path.read_text()
        assert docs.rewrite(page, tmp_path)[0] == page
        assert len(docs.BLOCK.findall(page)) == len(re.findall(f"^{docs.START}", page, re.M))


@pytest.mark.parametrize("page", sorted(docs.DOCS.glob("*.md")), ids=lambda page: page.stem)
def test_no_table_of_the_docs_is_empty(page):
    for name, body in docs.BLOCK.findall(page.read_text(encoding="utf-8")):
        assert len(body.strip().splitlines()) > 2, name
