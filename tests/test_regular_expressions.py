"""No regular expression of the program takes a time that is not in proportion to its text.

A linter says so of each: recheck, which also finds what lookaheads hide. It is written for JavaScript, so that node has
to be there: ``npm ci --ignore-scripts --prefix tests/patterns``.
"""

from __future__ import annotations

import re
import shutil
import time

import pytest

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.ingest.deployed.access_file import MAX_BYTES
from rosprivacy.ingest.policies.names import matcher
from rosprivacy.ingest.scan.cpp.cpp_units import LONGEST_LOOP
from rosprivacy.ingest.scan.packages import LONGEST_ENTRY
from tests.helpers.regular_expressions import LINTER, Expression, asked, expressions

pytestmark = [
    pytest.mark.slow,  # a minute of the linter
    pytest.mark.skipif(
        not (shutil.which("node") and (LINTER / "node_modules").is_dir()),
        reason=f"no linter of regular expressions: npm ci --ignore-scripts --prefix {LINTER.name}",
    ),
]
ARGUMENT, MESSAGE, OURS, NAME = 131_072, 20_000, 5_000, 255
# Where the steps grow with the square of a text: how long it can be, and whose it is.
SQUARE = {
    "cli/wrong_values.py:LISTED": (ARGUMENT, "an argument of the user's own"),
    "ingest/policies/joint_policies.py:_WILDCARD": (BOUNDS.name, "a name in a policy"),
    "ingest/deployed/access_file.py:_TOKEN": (MAX_BYTES, "a file that json5 has read before"),
    "ingest/scan/outside/bridge_configs.py:MOSQUITTO": (NAME, "the name of a file"),
    "ingest/scan/outside/compose_files.py:NAMED_COMPOSE": (NAME, "the name of a file"),
    "ingest/scan/cpp/cpp_units.py:COUNTING_LOOP": (LONGEST_LOOP, "the head of a loop"),
    "ingest/scan/packages.py:ENTRY": (LONGEST_ENTRY, "an entry point"),
    "queries/library.py:TEXT": (OURS, "a question that comes with the program"),
    "queries/run.py:_EARLIER": (MESSAGE, "a message of the server"),
    "queries/run.py:_MISSING_NAME": (MESSAGE, "a message of the server"),
    "queries/saved.py:_TOKEN": (OURS, "a question that comes with the program"),
}
GLOBS = "analysis/expressions.py:regex"  # made of a stranger's glob, with groups that JavaScript does not have
SECONDS = 5.0  # of one core; the worst takes a tenth of it


@pytest.mark.parametrize(
    ("source", "why"),
    [
        (r"(?:_(?:(?=[a-f]*[0-9])[0-9a-f]{8,}|[0-9]{3,}))+(?=/|$)", "that of diff in an earlier version: exponential"),
        (r"(?:_[0-9]*|_[0-9]*)+$", "alternatives that are the same"),
        (r"(a+)+$", "a star in a star"),
    ],
)
def test_the_linter_knows_a_bad_one(source: str, why: str) -> None:
    (said,) = asked([Expression("", source, 0, frozenset({"sub"})).in_javascript])
    assert said.status == "vulnerable", why


def test_every_expression_of_the_program_is_linear_or_bounded() -> None:
    """Those of ``SQUARE`` are run on the worst text of the linter, as long as it can be."""
    all_of_them = [one for one in expressions() if one.place != GLOBS]
    assert len(all_of_them) > 50
    said = asked([one.in_javascript for one in all_of_them])
    bad = {one.place: (one, answer) for one, answer in zip(all_of_them, said, strict=True) if answer.status != "safe"}
    assert bad.keys() == SQUARE.keys(), {place: (one, said) for place, (one, said) in bad.items()}
    for place, (one, answer) in bad.items():
        assert answer.status == "vulnerable"  # and not 'unknown'
        text = answer.text(SQUARE[place][0])
        started = time.process_time()
        re.sub(one.source, "", text, flags=one.flags)
        assert time.process_time() - started < SECONDS, place


def test_globs_are_linear_in_the_name() -> None:
    """A glob is a stranger's, and so is the name."""
    globs = ["/" + "*a" * 1000 + "b", "/" + "*?" * 1000 + "b", "/" + "[a-b]*" * 1000 + "c", "/*" + "a" * 2000 + "*b"]
    name = "/" + "a" * (BOUNDS.name - 1)
    started = time.process_time()
    assert not any(matcher(glob)(name) for glob in globs)
    assert time.process_time() - started < SECONDS
