"""How many cases a test tries, and what they have in common."""

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

FEW = settings(
    max_examples=25, deadline=None, derandomize=True, suppress_health_check=[*HealthCheck]
)
# always the same few, or as many others as `make fuzz` asks for
CASES = settings.default if settings.get_current_profile_name() == "fuzz" else FEW
LONGEST = 1500  # characters of a sentence that quotes what it was given


def is_one_sentence(error: Exception) -> bool:
    text = str(error)
    return 10 < len(text) < LONGEST and text.isprintable() and "Traceback" not in text


@st.composite
def damaged(draw, content: bytes, tokens: list[bytes]) -> bytes:
    """Bytes of which some are others, gone, there twice, or with a token in between."""
    for _ in range(draw(st.integers(1, 6))):
        at = draw(st.integers(0, len(content)))
        to = at + draw(st.sampled_from([1, 2, 8, 64, 1000]))
        put, rest = draw(
            st.one_of(
                st.tuples(st.binary(min_size=1, max_size=4), st.just(at + 1)),
                st.tuples(st.sampled_from(tokens), st.just(at)),
                st.sampled_from([(b"", to), (content[at:to], at), (b"", len(content))]),
            )
        )
        content = content[:at] + put + content[rest:]
    return content


# in a small process of its own: a child of a large one counts that one's memory as once its own
USED = """
import resource, subprocess, sys
ended = subprocess.run(sys.argv[1:])
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, file=open("used", "w"))
sys.exit(ended.returncode)
"""
