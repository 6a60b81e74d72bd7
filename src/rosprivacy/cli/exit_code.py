"""The exit code of ``analyze``: what a build in CI goes by (rules S11, S12; the table of all codes).

In: a ``Result`` and what a user lets the build fail on. Out: a number.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import NOTHING_FOLLOWED
from rosprivacy.analysis.python_311 import StrEnum

if TYPE_CHECKING:
    from collections.abc import Collection

    from rosprivacy.result import Result

CODES = {
    0: "no leak found; of other commands: done",
    1: "what the command exists to find: a leak; for `bag` personal data; for `diff` a finding, doubt or verdict that "
    "is new or worse, with `--as usage` something that runs and is not granted; for `lint` a broken rule; "
    "for `decisions verify` an entry that was changed, moved or removed; for `check` "
    "and `annotations --check` a difference",
    2: "bad input or usage",
    3: "a server (database, middleware, Spark) cannot be reached",
    4: "`analyze` and `bag`: undetermined; `--fail-on leak` makes it 0, but never where no data was followed, and "
    "`--fail-on doubt` adds a doubt that nobody has accepted; `check`: nothing differs, but not all is known; "
    "`bag --without`: no topic is left; `observe`: nothing was seen; `scan`: always, as code does not say all; "
    "`diff`: labels are given and no data was followed on a side, with `--as usage` the observation has gaps; "
    "`query`: `--limit` cuts JSON or CSV",
    70: "an error of the program itself: no answer; the message says which file to send",
}
LEAK, UNDETERMINED, OWN_ERROR = 1, 4, 70
SIGPIPE = 13  # the module signal lacks it on Windows; who is gone is told with 128 more


class FailOn(StrEnum):
    """What ends with an exit code other than 0."""

    undetermined = "undetermined"
    leak = "leak"
    undecided = "undecided"
    doubt = "doubt"
    never = "never"


REMOVED_VALUES = {  # words of earlier versions -> what to write; no alias, since what ends with 0 is another one now
    "off": "write never",
    "todo": "write leak; or leave it out, to fail on undetermined too",
    "all": "leave out --decisions, so that no finding is accepted",
}
REMOVED_OPTIONS = {  # options of earlier versions -> what to write
    "--max-bytes": "write --bound policy_bytes=N",
    "--no-standard-channels": "write --standard-channels none",
    "--no-type-limits": "write --type-limits none",
}


def exit_code(result: Result, fail_on: Collection[FailOn]) -> int:
    """Return 1 for a finding that counts, 4 for an answer that is undetermined or in doubt, else 0.

    Parameters
    ----------
    fail_on
        What ends with another code than 0; the strictest of them counts.

    Notes
    -----
    A leak that may be, because nobody named a source whose data goes anywhere, is not let through by ``leak``: nothing
    was looked at then. ``doubt`` fails on what fails otherwise too, and on doubts that ride on the verdict and that
    nobody has accepted (rule S11).
    """
    analysis, decided, words = result.analysis, result.decided, set(fail_on)
    if words == {FailOn.never}:
        return 0
    left = [finding for finding in analysis.findings if finding.stands]
    if FailOn.undecided in words and words <= {FailOn.undecided, FailOn.doubt}:
        left = [finding for finding in left if not (decided and decided.valid(finding))]
    if left:
        return LEAK
    if FailOn.doubt in words and any(doubt.accepted is None for doubt in result.doubts):
        return UNDETERMINED
    let_through = words == {FailOn.leak} and analysis.lacking not in NOTHING_FOLLOWED
    return UNDETERMINED if analysis.verdict == "undetermined" and not let_through else 0
