"""What a glob of a file with pins takes away holds for what a person has seen, against brute force (rule S11)."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.whatif.answered_by_globs import answered_by_globs
from tests.helpers.more_systems import ranked
from tests.helpers.systems import PARENTS, System, analysed, findings_and_questions, index, sent, those_of_brute_force

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.model import Statement

WORSE = {("no-leak-found", "undetermined"), ("no-leak-found", "leak"), ("undetermined", "leak")}
KINDS = st.sets(st.sampled_from([*PARENTS])).map(lambda names: tuple(sorted(names)))


@st.composite
def pinned(draw: st.DrawFn) -> System:
    """What globs take away or call reviewed holds at each element for some kinds."""
    system = draw(ranked())
    for vertex, said in system.said.items():
        kinds = draw(KINDS)
        system.said[vertex] = [s._replace(pinned=kinds) if s.to_be_seen and not s.shipped else s for s in said]
    return system


@st.composite
def changed(draw: st.DrawFn) -> tuple[System, System]:
    """The same labels, and how they hold where the code of some nodes is another than they were said of."""
    system = draw(ranked())
    nodes = {v for v in range(system.nodes - len(system.outside)) if draw(st.booleans())}
    said = {v: [s._replace(pinned=()) for s in said] if v in nodes else said for v, said in system.said.items()}
    return system, replace(system, said=said)


def facts_of(system: System, found: Analysis) -> object:
    number = index(system)
    findings = {(f.kind, f.category, number[f.source], number[f.leak], f.dismissed) for f in found.findings}
    return findings, found.carried, [(q.element, q.categories) for q in found.open], found.verdict


def with_pins(system: System, pins: Mapping[int, Collection[str]] | None) -> System:
    """The same with these pins at each element; without any for None."""

    def under(s: Statement, vertex: int) -> Statement:
        kinds = None if pins is None else tuple(sorted(pins.get(vertex, ())))
        return s._replace(pinned=kinds) if s.to_be_seen and not s.shipped else s

    return replace(system, said={v: [under(s, v) for s in said] for v, said in system.said.items()})


def pins_of(system: System, found: Analysis) -> dict[int, set[str]]:
    """The pins that are missing; that of a service holds for both of its legs, as in a label file."""
    pins: dict[int, set[str]] = defaultdict(set)
    for row in answered_by_globs(found.spread, system.bound(), system.hierarchy):
        for element, vertex in index(system).items():
            if element.identity == row.element.identity:
                pins[vertex].update(row.categories)
    return pins


def there(found: Analysis) -> list[set[str]]:
    return [{*found.spread.names(found.spread.present(v))} for v in range(len(found.graph.elements))]


@given(pinned())
def test_what_is_carried_and_refused_is_what_brute_force_says(system: System) -> None:
    found, brute = analysed(system), system.brute()
    assert found is None or not brute.refused()
    if found is None:  # two lines of a file may contradict each other although nobody has seen where
        assert brute.refused() or with_pins(system, None).brute().refused()
        return
    brute.spread(brute.sources())
    assert sent(system, found) == brute.along


@given(pinned())
def test_findings_and_open_questions_are_those_of_brute_force(system: System) -> None:
    found = analysed(system)
    if found is None:
        return
    assert findings_and_questions(system, found) == those_of_brute_force(system.brute())


@given(ranked())
def test_under_fresh_pins_the_answer_is_that_without_pins(system: System) -> None:
    found = analysed(system)
    if found is None:
        return
    fresh = with_pins(system, pins_of(system, found))
    after = fresh.analyse()
    assert facts_of(system, after) == facts_of(system, found)
    assert not answered_by_globs(after.spread, fresh.bound(), system.hierarchy)  # nothing is left to doubt


@given(ranked(), st.data())
def test_with_fewer_pins_no_data_and_no_question_is_gone(system: System, data: st.DataObject) -> None:
    found = analysed(system)
    if found is None:
        return
    pins = pins_of(system, found).items()
    some = {v: [kind for kind in sorted(kinds) if data.draw(st.booleans())] for v, kinds in pins}
    doubted = with_pins(system, some)
    after = analysed(doubted)
    if after is None:  # what kept two other labels apart no longer counts: an error names both
        assert doubted.brute().refused()
        return
    assert all(kinds <= now for kinds, now in zip(there(found), there(after), strict=True))
    asked, now = ({(q.element, kind) for q in one.open for kind in q.categories} for one in (found, after))
    assert asked <= now | {(f.leak, f.category) for f in after.findings}  # a glob took the leak back: it is there again


@given(changed())
def test_labels_of_other_code_say_what_brute_force_says(systems: tuple[System, System]) -> None:
    _, system = systems
    found, brute = analysed(system), system.brute()
    if found is None:
        return
    brute.spread(brute.sources())
    assert sent(system, found) == brute.along
    assert findings_and_questions(system, found) == those_of_brute_force(brute)


@given(changed())
def test_with_labels_of_other_code_no_data_no_finding_and_no_question_is_gone(systems: tuple[System, System]) -> None:
    """What adds data holds, and what takes it away or calls it reviewed does not."""
    found, after = map(analysed, systems)
    if found is None:
        return
    if after is None:  # what kept two other labels apart no longer counts: an error names both
        assert systems[1].brute().refused()
        return
    assert all(kinds <= now for kinds, now in zip(there(found), there(after), strict=True))
    ways, now = ({(f.kind, f.category, f.source, f.leak) for f in one.findings} for one in (found, after))
    assert ways <= now
    asked, open_now = ({(q.element, kind) for q in one.open for kind in q.categories} for one in (found, after))
    assert asked <= open_now
    if found.verdict != after.verdict:
        assert (found.verdict, after.verdict) in WORSE
