"""`python -m fiberweb.tools.resume [option ...]`: go on with the last call of the workflow in this
folder that did not come to its end, whatever ended it.

Target and config are those of that call, and options are added to them, such as `--cores 8`. The
folder is unlocked if and only if nobody is at work in it. All files are read, and those whose
content is not what their jobs wrote are made again.
"""

from __future__ import annotations

import os
import shlex
import signal
import subprocess
import sys

from fiberweb import calls
from fiberweb.written import READ_ALL

LOOKS = ("dryrun", "unlock", "summary", "detailed_summary", "dag")  # options that make nothing


def added(arguments: list[str], more: list[str]) -> list[str]:
    """The arguments of a call with more options: behind `--`, all would be targets."""
    end = arguments.index("--") if "--" in arguments else len(arguments)
    return [*arguments[:end], *more, *arguments[end:]]


def only_looks(arguments: list[str]) -> bool:
    """Whether a call that Snakemake took makes nothing, as a dry run."""
    from snakemake.cli import get_argument_parser  # a second, and of a call that ended well alone

    given, _ = get_argument_parser().parse_known_args(arguments)
    return any(getattr(given, option) for option in LOOKS)


def main() -> int:
    """The exit code of the call; a sentence where there is nothing to resume."""
    if (found := calls.unfinished()) is None:
        print("Every call in this folder came to its end: there is nothing to resume.")
        return 0
    note, call = found
    if refusal := calls.at_work(call):
        sys.exit(refusal)
    snakemake = [sys.executable, "-m", "snakemake"]
    arguments = added(call["arguments"], sys.argv[1:])
    where = {"cwd": call["from"], "env": os.environ | {READ_ALL: "1", "PWD": call["from"]}}
    print("Going on with:", shlex.join(["snakemake", *arguments]), flush=True)
    signal.signal(signal.SIGINT, lambda *_: None)  # Ctrl-C is for Snakemake, which takes its time
    if calls.SNAKEMAKES.is_dir():
        code = subprocess.run([*snakemake, *added(arguments, ["--unlock"])], **where).returncode
        if code:
            return code
    code = subprocess.run([*snakemake, *arguments], **where).returncode
    if code == 0 and not only_looks(arguments):
        note.unlink(missing_ok=True)
    return code


if __name__ == "__main__":
    sys.exit(main())
