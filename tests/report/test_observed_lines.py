"""Under Assumed: many files that say the same are one line, and many that say different things are few (S16)."""

from __future__ import annotations

from rosprivacy.report.catalogs.words import IN_ENGLISH
from rosprivacy.report.observed_lines import observed_lines


def test_many_files_are_few_lines() -> None:
    same = [{"code": "observed", "file": f"r{n}.xml", "message": "seen"} for n in range(9)]
    lines = list(observed_lines({"diagnostics": same}, IN_ENGLISH))
    assert lines == ["r0.xml, r1.xml, r2.xml, … (+6) tells what was seen running: seen."]
    other = [{"code": "observed", "file": f"r{n}.xml", "message": f"seen {n}"} for n in range(9)]
    lines = list(observed_lines({"diagnostics": [*other, {"code": "", "file": "x", "message": "y"}]}, IN_ENGLISH))
    assert len(lines) == 4
    assert lines[3].startswith("r3.xml, r4.xml, r5.xml, … (+3) ")
