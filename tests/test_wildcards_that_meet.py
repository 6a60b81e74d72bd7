"""Whether pairs of wildcards that meet are stored or not, every answer is the same, byte for byte (rules S4, S10)."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rosprivacy.analysis.errors import RosPrivacyError
from rosprivacy.analysis.findings import review_order
from rosprivacy.api import analyze
from rosprivacy.ingest.policies import flow_graph
from tests.helpers.fleet_files import policy
from tests.helpers.written_systems import ROLES

NODES = tuple(f"/n{i}" for i in range(5))
NAMES = ("/r*", "/r*/s*", "/ro*", "/*", "/*/s1", "/r*1", "/r[ab]*", "/*/rosout", "/ra/s1", "/ro")
DENIED = ("!/r*/s*", "!/ro*", "!/*1", "!/ra/s1")
CHANNEL = ("mundane", "sensitive", "{only: [Video]}", "{never: [Voice]}")
FORMATS = ("json", "text", "sarif", "turtle", "cnil-pia")
ALL_STORED = 10**9


@st.composite
def systems(draw: st.DrawFn) -> tuple[str, str]:
    """The texts of a policy and of a label file."""
    names = st.sets(st.sampled_from((*NAMES, *NAMES, *DENIED)), max_size=5).map(lambda some: ",".join(sorted(some)))
    profiles = {node: f"{node}>{draw(names)}<{draw(names)}" for node in NODES}
    roles = {node: draw(st.sampled_from(ROLES)) for node in NODES[1:] if draw(st.booleans())}
    roles["/n0"] = ROLES[0]
    granted = [name for text in profiles.values() for name in text.partition(">")[2].replace("<", ",").split(",")]
    own = sorted({name for name in granted if name and name[0] != "!"})
    channels = {name: draw(st.sampled_from(CHANNEL)) for name in own if draw(st.booleans()) and draw(st.booleans())}
    lines = ["labels: 1", "nodes:", *(f"  {name}: {said}" for name, said in sorted(roles.items()))]
    lines += ["channels:", *(f'  "={name}": {said}' for name, said in channels.items())] if channels else []
    lines += ["elements:", "  disk: {kind: storage, country: US, retention: P3D}"]
    lines += ["flows:", f"  - {{from: {draw(st.sampled_from(NODES))}, to: disk}}"]
    if draw(st.booleans()):
        lines += ['  - {from: {topic: "/r*"}, to: {topic: "/r*"}, never: [Voice]}']
    return policy(*profiles.values()), "\n".join([*lines, ""])


def told(stored: int, most: int) -> list[str]:
    """All that is told of a system, or why nothing is."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(flow_graph, "STORED", stored)
        patch.setattr(review_order, "MOST", most)
        try:
            result = analyze("p.xml", labels="l.yaml", paths="disjoint")
        except RosPrivacyError as error:
            return [str(error)]
        why = [repr(result.why_not("/n0", node)) for node in NODES[1:3]]
        return [*(str(result.to(name)) for name in FORMATS), json.dumps(result.proposals()), *why]


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(system=systems(), most=st.sampled_from((0, 200_000)))
def test_every_answer_is_that_of_all_pairs(
    system: tuple[str, str], most: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    for name, text in zip(("p.xml", "l.yaml"), system, strict=True):
        Path(name).write_text(text, "utf-8")
    assert told(0, most) == told(ALL_STORED, most)
