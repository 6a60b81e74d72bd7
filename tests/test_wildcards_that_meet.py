"""Whether pairs of wildcards that meet are stored or not, every answer is the same, byte for byte (rules S4, S10)."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rosprivacy.analysis.findings import review_order
from rosprivacy.ingest.policies import flow_graph
from tests.helpers.fleet_files import policy
from tests.helpers.written_systems import ROLES, every_answer

NODES = tuple(f"/n{i}" for i in range(5))
NAMES = ("/r*", "/r*/s*", "/ro*", "/*", "/*/s1", "/r*1", "/r[ab]*", "/*/rosout", "/ra/s1", "/ro")
DENIED = ("!/r*/s*", "!/ro*", "!/*1", "!/ra/s1")
CHANNEL = ("mundane", "sensitive", "{only: [Video]}", "{never: [Voice]}")
FORMATS = ("json", "text", "sarif", "turtle", "cnil-pia")
ALL_STORED = 10**9


@st.composite
def systems(draw: st.DrawFn) -> tuple[str, str]:
    """The texts of a policy and of a label file."""
    some = st.sets(st.sampled_from(NAMES), min_size=1, max_size=4)
    sides = {node: [draw(some), draw(some)] for node in NODES}
    if draw(st.integers(0, 3)) == 0:  # a DENY is about the whole enclave
        draw(st.sampled_from(draw(st.sampled_from(sorted(sides.items())))[1])).add(draw(st.sampled_from(DENIED)))
    profiles = [
        f"{node}>{','.join(sorted(written))}<{','.join(sorted(read))}" for node, (written, read) in sides.items()
    ]
    roles = {node: draw(st.sampled_from(ROLES)) for node in NODES[1:]}
    wild = [name for name in sorted(sides["/n0"][0]) if name in NAMES and "*" in name]
    through = [f"{{source: {{Video: ['={name}']}}}}" for name in wild]
    roles["/n0"] = draw(st.sampled_from((ROLES[0], ROLES[0], *through)))
    granted = [name for pair in sides.values() for side in pair for name in side]
    own = sorted({name for name in granted if name and name[0] != "!"})
    channels = {name: draw(st.sampled_from(CHANNEL)) for name in own if draw(st.integers(0, 5)) == 0}
    lines = ["labels: 1", "nodes:", *(f"  {name}: {said}" for name, said in sorted(roles.items()))]
    lines += ["channels:", *(f'  "={name}": {said}' for name, said in channels.items())] if channels else []
    lines += ["elements:", "  disk: {kind: storage, country: US, retention: P3D}"]
    lines += ["flows:", f"  - {{from: {draw(st.sampled_from(NODES))}, to: disk}}"]
    if all(any("/r*" in pair[side] for pair in sides.values()) for side in (0, 1)) and draw(st.booleans()):
        lines += ['  - {from: {topic: "/r*"}, to: {topic: "/r*"}, never: [Voice]}']
    return policy(*profiles), "\n".join([*lines, ""])


def told(stored: int, most: int) -> list[str]:
    """All that is told of a system, or why nothing is."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(flow_graph, "STORED", stored)
        patch.setattr(review_order, "BOUND", most)
        return every_answer(FORMATS)


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
