"""Names that look like one that is not there: bounded, and asked about in one way."""

from __future__ import annotations

from rosprivacy.analysis.written_names import LONGEST, did_you_mean, nearest


def test_the_likest_name_comes_first() -> None:
    assert nearest("/camra", ["/cameras", "/camera", "/lidar"], bound=2) == ["/camera", "/cameras"]


def test_a_name_of_endless_length_is_not_compared() -> None:
    endless = "/" + "x" * 10 * LONGEST
    assert nearest(endless, [endless + "y", "/x"]) == []
    assert nearest("/camra", [endless, "/camera"]) == ["/camera"]


def test_what_cannot_be_printed_is_escaped_in_the_question() -> None:
    assert did_you_mean(["/a\x1b[2J"], "nothing") == "did you mean /a\\x1b[2J?"
    assert did_you_mean((), "see the names") == "see the names"
