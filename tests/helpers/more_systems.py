"""Random systems with more than ``systems.py`` draws: wildcards, ranks, sources that name channels."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import strategies as st

from rosprivacy.analysis.model import GLOB, NAME, SEGMENT, Place, Statement
from tests.helpers.systems import ABSENT, PARENTS, System, statement, systems

EXACT = 1_000_000
NAMINGS = [(EXACT, NAME), (EXACT, NAME), (4, SEGMENT), (4, GLOB), (7, GLOB), (7, SEGMENT)]
SHIPPED = Statement("mundane", (), (0, 6), Place("rosprivacy:standard", 1), shipped=True, naming=SEGMENT)


@st.composite
def ranked(draw: st.DrawFn) -> System:
    """Statements by names and globs of one or two files; sources that name channels; standard channels."""
    system = draw(systems(outside=2))
    if system.channels > 1:
        system = replace(system, service=draw(st.booleans()))
    names = system.graph().elements
    channels = range(system.nodes, system.nodes + system.channels)
    one_file, two = st.just("a"), st.sampled_from(["a", "b"])
    where = two if draw(st.integers(0, 2)) == 0 else one_file

    def placed(one: Statement, vertex: int) -> Statement:
        rank, naming = draw(st.sampled_from(NAMINGS)) if vertex not in system.facts else NAMINGS[0]
        return one._replace(rank=(1, rank), naming=naming, place=Place(draw(where), vertex + 1))

    category = st.sampled_from(tuple(PARENTS))
    more = st.builds(
        lambda r, c: statement(r, *sorted(c)), st.sampled_from(["only", "never"]), st.sets(category, min_size=1)
    )
    plain = st.sampled_from([statement("mundane"), statement("sensitive")])
    nones = st.sampled_from(["no-leak", "no-source"])
    some_none = st.one_of(st.builds(statement, nones), st.builds(statement, nones, category))
    words = st.one_of(some_none, st.sampled_from([statement("conduit"), ABSENT]))
    for vertex, said in system.said.items():
        extra = st.one_of(more, plain) if vertex in channels else words
        some = [*said, *draw(st.lists(extra, max_size=2))]
        system.said[vertex] = [placed(one, vertex) for one in dict.fromkeys(some)]
        if draw(st.booleans()) and vertex in channels:
            kinds = draw(st.sampled_from([(), ("Face", "Loc")]))  # of a log what no text holds (S13)
            system.said[vertex].append(SHIPPED._replace(categories=kinds))
        written = [names[b].name for a, b in system.edges if a == vertex and b in channels]
        if draw(st.booleans()) and written:
            through = tuple(sorted(draw(st.sets(st.sampled_from(written), min_size=1))))
            system.said[vertex] = [
                s._replace(through=through) if s.role == "source" else s for s in system.said[vertex]
            ]
    if system.service:
        system.said[channels[-1]] = system.said[channels[-2]]
    return system


@st.composite
def wildcards(draw: st.DrawFn) -> System:
    """The last two channels are the sides of a wildcard, which may match others; labels name both sides."""
    system = draw(systems().filter(lambda system: system.channels > 1))
    written, read = system.nodes + system.channels - 2, system.nodes + system.channels - 1
    edges = {(a, b) for a, b in system.edges if a != written and b != read} | {(written, read)}
    for channel in range(system.nodes, written):
        edges |= draw(st.sampled_from([set(), {(written, channel)}, {(channel, read)}]))
    system.said[read] = system.said[written]
    never = {at: some for at, some in system.never.items() if at < len(edges)}
    exposed = system.exposed - {read}  # what is read from a wildcard is told where it is written
    return replace(system, edges=sorted(edges), never=never, exposed=exposed, wildcard=True)
