"""What the answer hangs on, of fleets in parts: as in one graph, and as by brute force (rules S7, S8, S10, S11)."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.findings import Options
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.analysis.whatif.reliance import Reliance, reliances
from rosprivacy.parts import distributed, fleet_reliance
from rosprivacy.parts.crossings import Beyond, Crossroads
from rosprivacy.parts.distributed import analyse_in_parts
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import answer_fleet
from tests.helpers.brute_reliance import StatementKey, reliance_by_brute_force
from tests.helpers.fleet_files import policy, write
from tests.helpers.parts import in_list, question, scattered
from tests.helpers.random_fleets import Case, fleets
from tests.helpers.systems import HIERARCHY, PARENTS, statement

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from rosprivacy.ingest.fleet.fleet_graph import Placed


@pytest.fixture(autouse=True)
def large() -> Iterator[None]:
    """As if every fleet were too large to be shown as a whole."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(distributed, "MOST_WHOLE", 0)
        yield


@st.composite
def joined_fleets(draw: st.DrawFn) -> Case:
    """Also with what is said of shared elements, which takes something away."""
    case = draw(fleets())
    category = st.sampled_from(tuple(PARENTS))
    label = st.builds(statement, st.sampled_from(["mundane", "only", "never", "conduit"]), category)
    shared = {
        name: (kind, stated, [*said, *draw(st.lists(label, max_size=1))])
        for name, (kind, stated, said) in case.shared.items()
    }
    return replace(case, shared=shared)


def of_memory(case: Case) -> tuple[Placed, tuple[Reliance, ...]] | None:
    try:
        analysis, placed = case.analyse()
    except InputErrors:
        return None
    return placed, reliances(analysis, placed.bound, HIERARCHY)


def in_parts(case: Case, size: int) -> tuple[Reliance, ...]:
    asked = question(case)
    found = analyse_in_parts(replace(asked, hangs_on=True), partial(scattered, size=size))
    assert found.hangs_on is not None
    assert not found.hangs_on.cut
    return found.hangs_on.rows


@given(joined_fleets(), st.sampled_from([1, 2, 100]))
def test_the_rows_are_those_of_one_graph(case: Case, size: int) -> None:
    memory = of_memory(case)
    if memory:
        assert in_parts(case, size) == memory[1]


def named(row: Reliance) -> StatementKey:
    """The statement, and the names of what it is about, which are the same on all robots."""
    return (row.statement, row.elements[0].name, *sorted({element.name for element in row.to}))


@given(joined_fleets())
def test_the_rows_are_those_of_brute_force(case: Case) -> None:
    memory = of_memory(case)
    if memory is None:
        return
    placed = memory[0]
    rows = {named(row): row for row in in_parts(case, 1)}
    for lost, expected in reliance_by_brute_force(placed.graph, placed.bound, HIERARCHY, Options()).items():
        row = rows.get(lost)
        if expected is None:
            assert row is None or row.refused, lost
            continue
        found = {
            (f.kind, f.category, f.source, f.leak): (not f.dismissed, not f.pseudonymised)
            for f in (row.findings if row else ())
        }
        asked = {(e.shown_as, c) for e, names in (row.questions if row else ()) for c in names}
        assert (found, asked) == expected, lost
        assert row is None or not (row.refused or row.perhaps)


JOINED = """fleet: 1
robots:
  r1: {policies: p.xml, labels: [l.yaml, r1.yaml]}
  r2: {policies: p.xml, labels: l.yaml}
  r3: {policies: p.xml, labels: [l.yaml, r3.yaml]}
elements: {cloud: {kind: side-channel, conduit: [PersonalData]}}
flows: [{from: "*:/uplink", to: cloud}, {from: cloud, to: "*:/out"}]
"""


def test_of_many_findings_the_first_are_listed_and_a_doubt_names_the_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No row is lost, and no other one is cut; what would stand comes before what would be dismissed."""
    monkeypatch.chdir(tmp_path)
    write("p.xml", policy("camera>/image", "uplink></image", "out<x"))
    labels = "labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /uplink: {sanitizer: {Video: drop}}\n"
    write("l.yaml", f"{labels}  /out: {{leak: [Video]}}\n")
    write("r1.yaml", "labels: 1\nchannels: {/image: {never: [Voice]}}\n")
    write("r3.yaml", "labels: 1\nnodes: {/uplink: {leak: [Video]}}\n")
    write("f.yaml", JOINED)
    monkeypatch.setattr(fleet_reliance, "MOST_OF_ROW", 4)
    whole = answer_fleet("f.yaml", Settings(hangs_on=True)).document()
    answer = in_list("f.yaml").document()
    assert len(whole["hangs_on"]) == len(answer["hangs_on"]) > 0
    cut = set()
    for row, known in zip(answer["hangs_on"], whole["hangs_on"], strict=True):
        if row != known:
            cut.add((row["file"], row["line"]))
            assert {**row, "findings": []} == {**known, "findings": []}
            assert len(row["findings"]) == 4 < len(known["findings"])
            assert all(finding in known["findings"] for finding in row["findings"])
            assert not any(finding["dismissed"] for finding in row["findings"])
    assert cut == {("l.yaml", 4)}
    assert {(d["file"], d["line"]) for d in answer["doubts"] if d["doubt"] == "hangs-on-cut"} == cut


def test_a_border_forgets_what_a_unit_did_and_no_other_does() -> None:
    """Data that gets out at 0 comes in at 0; from there two units bring it to 1, and from there to 2."""
    bringing, core = ({0: 0b10, 1: 0b100},), ({0: 0b1, 1: 0b10, 2: 0b100},)
    nothing: dict[int, int] = {}
    border = Crossroads.of([bringing, bringing], core)
    now_and_then = [(bringing, (nothing,))]
    assert border.beyond((0b1,), of_core=False) == (Beyond(0b111, 0b111),)
    assert border.changed(now_and_then, core).beyond((0b1,), of_core=False) == (Beyond(0b111, 0b111),)
    assert border.changed(now_and_then * 2, core).beyond((0b1,), of_core=False) == (Beyond(0b1, 0b1),)
    assert border.changed([], (nothing,)).beyond((0b1,), of_core=False) == (Beyond(0b1, 0),)
    assert border.beyond((0b10,), of_core=True) == (Beyond(0b100, 0b110),)


CHAIN = """fleet: 1
robots:
  r1: {policies: p.xml, labels: [l.yaml, r1.yaml]}
  r2: {policies: p.xml, labels: [l.yaml, r2.yaml]}
  r3: {policies: p.xml, labels: [l.yaml, r3.yaml]}
elements: {hub: {kind: side-channel, conduit: [PersonalData]}, tap: {kind: side-channel, conduit: [PersonalData]}}
flows:
  - {from: "r1:/out", to: hub}
  - {from: hub, to: "r2:/in"}
  - {from: "r2:/out", to: tap}
  - {from: tap, to: "r3:/in"}
  - {from: "r3:/out", to: hub}
"""
AT_IN = ("{source: [Video, Voice]}", "{source: [Voice]}", "conduit", "{sanitizer: {Video: drop}}", "{leak: [Video]}")
AT_OUT = ("conduit", "{leak: [Voice]}", "{sanitizer: {Voice: pseudonymise}}", "{sanitizer: {Video: drop}}")
AT_CHANNEL = ("sensitive", "mundane", "{never: [Voice]}", "{only: [Video]}")
OF_ALL = ("", "channels: {/t*: mundane}\n", "nodes: {/o*: {sanitizer: {Voice: drop}}}\n")
LABELS = st.tuples(st.sampled_from(AT_IN), st.sampled_from(AT_OUT), st.sampled_from(AT_CHANNEL))


FAR = [(AT_IN[0], AT_OUT[3], "sensitive"), (AT_IN[2], AT_OUT[0], "sensitive"), (AT_IN[4], AT_OUT[1], "sensitive")]


@given(st.lists(LABELS, min_size=3, max_size=3), st.sampled_from(OF_ALL))
@example(FAR, OF_ALL[0])
@example(FAR, OF_ALL[1])
def test_what_goes_through_several_robots(
    tmp_path_factory: pytest.TempPathFactory, labels: list[tuple[str, str, str]], of_all: str
) -> None:
    """From one by what they share to the next, and around; what a name lets pass, a glob would close."""
    with chdir(tmp_path_factory.mktemp("chain")):
        write("p.xml", policy("in>/t<x", "out></t"))
        write("l.yaml", f"labels: 1\n{of_all}")
        for number, (at_in, at_out, at_channel) in enumerate(labels, 1):
            nodes = f"nodes: {{/in: {at_in}, /out: {at_out}}}"
            write(f"r{number}.yaml", f"labels: 1\n{nodes}\nchannels: {{/t: {at_channel}}}\n")
        write("f.yaml", CHAIN)
        try:
            whole = answer_fleet("f.yaml", Settings(hangs_on=True))
        except InputErrors:
            return
        assert in_list("f.yaml").hangs_on == whole.hangs_on
