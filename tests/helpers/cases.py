"""The folders of ``cases/``."""

from __future__ import annotations

from tests.helpers.paths import ROOT

CASES = sorted(path.parent for path in (ROOT / "tests" / "cases").glob("*/case.json"))
FLEETS = sorted(path.parent for path in (ROOT / "tests" / "cases").glob("*/fleet.json"))
