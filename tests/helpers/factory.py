"""The paper's factory, as files."""

from __future__ import annotations

from tests.helpers.paths import ROOT

FACTORY = ROOT / "examples" / "factory"
BEFORE, RUN3 = FACTORY / "before.policy.xml", FACTORY / "run3.labels.yaml"
