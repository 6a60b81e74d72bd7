"""Bags, and what people said of the channels that were recorded -> the kinds of data that can be in them.

In: paths of bags, policies, label files. Out: ``BagsAnswer``. Without policies the label files alone tell what is in a
channel. A topic of which people say nothing is open, never empty. What its type suggests is a question beside that, by
the table in force: it adds no kind, but 'nothing' is then said only where a person's label says it of the topic itself
(S7, S8, S11, S15).
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.kernel.roles import facts
from rosprivacy.analysis.model import NOTHING_FOLLOWED, Place, by_confidence, unread
from rosprivacy.analysis.model.recording import JudgedBag, TopicKinds
from rosprivacy.analysis.written_names import bare_name, is_glob
from rosprivacy.assumptions import files_read
from rosprivacy.ingest.policies.names import covered, covers, is_pattern, recorded_channels
from rosprivacy.ingest.running.bag_folders import read_bags
from rosprivacy.ingest.types import TABLE
from rosprivacy.ingest.types.type_table import read_table
from rosprivacy.question import question_of
from rosprivacy.report.bags import bags_document
from rosprivacy.systems.robot_system import answer_robot, read_label_files
from rosprivacy.version import __version__

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.kernel.roles import Facts
    from rosprivacy.analysis.model import Element, Statement, Suggestion
    from rosprivacy.analysis.model.recording import Bag, BagTopic
    from rosprivacy.ingest.labels.entries import Entry
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.ingest.neo4j_graph.bag_rows import BagRows
    from rosprivacy.ingest.types.type_table import TypeTable
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.report.schemas.bags import BagsDocument
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings


Channel = tuple[str, str, str]  # kind, name, leg
NO_MESSAGE = "no message of it was recorded"


@dataclass(frozen=True, slots=True)
class BagsAnswer:
    """Bags with what can be in them.

    Attributes
    ----------
    assumptions
        What the answer rests on (S12).
    """

    bags: tuple[JudgedBag, ...]
    assumptions: Mapping[str, Any]
    vocabulary: Vocabulary

    def document(self) -> BagsDocument:
        """Return the document ``rosprivacy.bags/1``."""
        return bags_document(self.bags, self.assumptions)

    def rows(self, robot: str) -> list[BagRows]:
        """Return what is written into a database; ``robot`` is the one that was recorded, empty for none."""
        from rosprivacy.ingest.neo4j_graph.bag_rows import bag_rows  # noqa: PLC0415 - light start

        return [bag_rows(bag, robot, self.assumptions) for bag in self.bags]


def answer_bags(
    bags: Sequence[str],
    policies: tuple[str, ...],
    labels: tuple[str, ...],
    settings: Settings,
    progress: Callable[[Sequence[str]], Iterable[str]] = lambda files: files,
) -> BagsAnswer:
    """Read bags, and say what kinds of data can be in them; ``InputErrors`` has every problem."""
    read = read_bags(bags, progress)
    vocabulary = question_of(settings).vocabulary
    table = read_table(settings.type_limits or TABLE, vocabulary, settings.bounds)
    suggested_by = {"suggested_by": {"file": table.limits.file, "sha256": table.limits.sha256}}
    if policies or settings.add:
        result = answer_robot(policies, labels, settings)
        return BagsAnswer(
            judged(read, by_system(result), table), {**result.assumptions, **suggested_by}, result.vocabulary
        )
    files = read_label_files(labels, vocabulary, settings)
    rests_on = {
        "rosprivacy": __version__,
        "ontologies": [{"file": name, "sha256": digest} for name, digest in vocabulary.sources],
        **files_read((), files, settings),
        **suggested_by,
    }
    return BagsAnswer(judged(read, by_labels(files, vocabulary), table), rests_on, vocabulary)


@dataclass(frozen=True, slots=True)
class SaidOfBags:
    """What is said of a topic by its name.

    Attributes
    ----------
    kinds, unknown, why
        As of ``TopicKinds``.
    covered
        Whether a person's label says it of the topic itself.
    shipped
        Whether only the program's own labels say it (S13).
    bound, doubt
        As of ``TopicKinds``.
    """

    kinds: tuple[str, ...] = ()
    unknown: str = ""
    why: str = ""
    covered: bool = False
    shipped: bool = False
    bound: tuple[str, ...] | None = None
    doubt: str = ""


def judged(bags: Iterable[Bag], said_of: Callable[[str], SaidOfBags], table: TypeTable) -> tuple[JudgedBag, ...]:
    """Return bags with what can be in them; ``said_of`` tells it of the name of a topic."""
    known = cache(said_of)
    return tuple(JudgedBag(bag, tuple(_judged(bag, topic, known, table) for topic in bag.topics)) for bag in bags)


def _judged(bag: Bag, topic: BagTopic, said_of: Callable[[str], SaidOfBags], table: TypeTable) -> TopicKinds:
    if topic.messages == 0 and bag.complete:
        return TopicKinds(topic, why=NO_MESSAGE)
    said = said_of(topic.name)
    suggested = tuple(sorted((rule for name in topic.types for rule in table.suggested(name)), key=by_confidence))
    if not (said.kinds or said.unknown or said.covered):
        looked_at = bool(topic.types) and all(table.knows(name) for name in topic.types)
        said = _questions(said, suggested, looked_at=looked_at)
    labelled = said.covered and said.bound is not None
    return TopicKinds(topic, said.kinds, said.unknown, said.why, suggested, said.bound, said.doubt, labelled)


def _questions(statements: SaidOfBags, suggested: Sequence[Suggestion], *, looked_at: bool) -> SaidOfBags:
    """What is said of a topic that no person's label names, under the question of its types."""
    whose = (
        "only the program's own labels say that it carries nothing"
        if statements.shipped
        else "no label of the topic itself"
    )
    kinds = sorted({kind for rule in suggested for kind in rule.kinds})
    if kinds:
        return replace(statements, unknown=f"{whose}, and its type suggests {', '.join(kinds)}", why="")
    if statements.shipped and not looked_at:
        return replace(statements, unknown=f"{whose}, and the table of types does not know its type", why="")
    return statements


def by_system(result: Result) -> Callable[[str], SaidOfBags]:
    """Return what tells of a topic what it carries in the system that was analysed."""
    analysis, bound = result.analysis, result.bound
    graph, spread = analysis.graph, analysis.spread
    labels = by_labels(result.labels, result.vocabulary)
    unread_files = unread(result.diagnostics)
    unreached = {end.element for end in analysis.unknown_ends if end.missing == "flow"}  # nobody says what is in these
    vertices: dict[Channel, list[int]] = defaultdict(list)
    patterns: dict[tuple[str, str], list[int]] = defaultdict(list)
    for vertex, element in enumerate(graph.elements):
        if element.is_channel and element.side == "write":
            patterns[element.kind, element.leg].append(vertex)
        elif element.is_channel and not element.pattern:
            vertices[element.kind, element.name, element.leg].append(vertex)
    writers: dict[int, list[int]] = defaultdict(list)
    for flow in graph.flows:
        writers[flow.target].append(flow.source)

    doubt_behind = _doubts(result, unreached)

    def statement_of(channel: Channel) -> list[int]:
        kind, name, leg = channel
        if vertices.get(channel) or is_pattern(name):
            return vertices.get(channel, [])
        return [vertex for vertex in patterns[kind, leg] if covers(graph.elements[vertex].name, name)]

    def said_of(topic: str) -> SaidOfBags:
        here = [vertex for channel in recorded_channels(topic) for vertex in statement_of(channel)]
        if not here:
            return SaidOfBags(unknown="the policies do not name it")
        kinds = {name for vertex in here for name in spread.names(spread.present(vertex))}
        stated = labels(topic)
        if kinds:
            return _arriving(kinds, stated, doubt_behind(here))
        if not stated.unknown:
            return stated
        if analysis.lacking in NOTHING_FOLLOWED:
            return SaidOfBags(unknown="no label names a source whose data goes anywhere")
        if unread_files:
            return SaidOfBags(unknown=f"grants were not read: {shown(str(unread_files[0]))}")
        return by_writers(here)

    def by_writers(vertices: Sequence[int]) -> SaidOfBags:
        """A channel to which no data gets: that is known if all that write to it were looked at."""
        for vertex in vertices:
            sending = _senders(vertex, writers, analysis)
            if not sending:
                return SaidOfBags(unknown="no node of the policies writes to it")
            spoken = {one for one in sending if bound.elements.get(one) and graph.elements[one] not in unreached}
            silent = sorted(graph.elements[one].name for one in sending - spoken)
            if silent:
                more = f" and {len(silent) - 1} more" if len(silent) > 1 else ""
                return SaidOfBags(unknown=f"no label says what {shown(silent[0])}{more} sends")
        doubt = doubt_behind(vertices)
        why = "no kind of data gets to those that write to it, and labels speak of all of them"
        return SaidOfBags(why=why, bound=None if doubt else (), doubt=doubt)

    return said_of


def _arriving(kinds: Collection[str], stated: SaidOfBags, doubt: str) -> SaidOfBags:
    """What is said of a topic to which kinds get: others can get there, too, unless its label or all behind it tell."""
    limit = stated.bound if stated.covered else None
    return SaidOfBags(
        tuple(sorted(kinds)),
        why="what the policies and labels let arrive there",
        covered=limit is not None,
        bound=None if limit is None and doubt else tuple(sorted({*kinds, *(limit or ())})),
        doubt=doubt if limit is None else "",
    )


def _doubts(result: Result, unreached: Collection[Element]) -> Callable[[Sequence[int]], str]:
    """What tells why data of which nobody speaks can get to some channels, however far it comes; empty if none can."""
    unread_files = unread(result.diagnostics)
    if unread_files:
        return lambda _: f"grants were not read: {shown(str(unread_files[0]))}"
    graph, statements = result.analysis.graph, result.bound.elements
    readers: dict[int, list[int]] = defaultdict(list)
    for flow in graph.flows:
        readers[flow.source].append(flow.target)
    silent = sorted(
        (element.name, vertex)
        for vertex, element in enumerate(graph.elements)
        if not element.is_channel
        and (element in unreached or all(one.pinned is not None for one in statements.get(vertex) or ()))
    )
    doubts: dict[int, str] = {}
    for name, start in silent:
        waiting = [start]
        while waiting:
            vertex = waiting.pop()
            if vertex not in doubts:
                doubts[vertex] = f"data can get there from {shown(name)}, of which no label speaks"
                waiting += readers[vertex]
    return lambda vertices: next((doubts[vertex] for vertex in vertices if vertex in doubts), "")


def _senders(vertex: int, writers: dict[int, list[int]], analysis: Analysis) -> set[int]:
    """Who writes to a channel, by its name or through wildcards that match it (S4)."""
    sending: set[int] = set()
    waiting, entered = [vertex], {vertex}
    while waiting:
        for source in writers.get(waiting.pop(), ()):
            if not analysis.graph.elements[source].is_channel:
                sending.add(source)
            elif source not in entered:
                entered.add(source)
                waiting.append(source)
    return sending


def by_labels(files: Sequence[Labels], vocabulary: Vocabulary) -> Callable[[str], SaidOfBags]:
    """Return what tells of a topic what label files say of it, where no policy says who writes to it."""
    entries = [entry for file in files for entry in file.entries]
    pinned = {id(entry) for file in files if file.pins is not None for entry in file.entries}
    sources = [one for entry in entries for one in entry.statements if one.role == "source" and one.through]
    named: dict[str, list[int]] = defaultdict(list)  # a bag can have more topics than a system has channels
    globs = [at for at, entry in enumerate(entries) if is_glob(entry.name)]
    for at, entry in enumerate(entries):
        if not is_glob(entry.name):
            named[bare_name(entry.name)].append(at)
    decided: dict[tuple[Statement, ...], SaidOfBags] = {}

    def said_of(topic: str) -> SaidOfBags:
        channels = recorded_channels(topic)
        names = {name for _, name, _ in channels}
        kinds = {kind for one in sources if any(covered(end, names) for end in one.through) for kind in one.categories}
        near = [entries[at] for at in sorted({at for name in names for at in named.get(name, ())}.union(globs))]
        about = [entry for entry in near if _is_about(entry, channels)]
        stated = decision(topic, tuple(statement for entry in about for statement in entry.statements))
        reviewed = decision(
            topic,
            tuple(one for entry in about for one in entry.statements if not (one.to_be_seen and id(entry) in pinned)),
        )
        bound = (
            None
            if stated.bound is None or reviewed.bound is None
            else tuple(sorted({*kinds, *stated.bound, *reviewed.bound}))
        )
        if kinds:
            return SaidOfBags(tuple(sorted(kinds)), why="sources that name the channel", covered=True, bound=bound)
        return replace(stated, bound=bound)

    def decision(topic: str, statements: tuple[Statement, ...]) -> SaidOfBags:
        if statements not in decided:
            decided[statements] = _decided(topic, statements, vocabulary)
        return decided[statements]

    return said_of


def _is_about(entry: Entry, channels: Sequence[Channel]) -> bool:
    return any(kind in entry.kinds and covered(entry.name, [name]) for kind, name, _ in channels)


def _decided(topic: str, statements: Sequence[Statement], vocabulary: Vocabulary) -> SaidOfBags:
    """What some statements say of a topic; of most topics the same ones speak, or none."""
    decided = {name: facts(topic, statements, name, vocabulary.hierarchy) for name in sorted(vocabulary.categories)}
    passing = [name for name, fact in decided.items() if fact.passes]
    if not passing:
        own = [statement for statement in statements if not statement.shipped]
        shipped = len(own) < len(statements) and any(
            facts(topic, own, name, vocabulary.hierarchy).passes for name in decided
        )
        why = f"{_lines(statements)}: it carries no kind of data"
        return SaidOfBags(why=why, covered=not shipped, shipped=shipped, bound=())
    if len(passing) < len(decided) and (only := {s for fact in decided.values() for s in fact.by_role("only")}):
        stated = {name for statement in only for name in statement.categories}.intersection(passing)
        if stated:
            why = f"{_lines(only)}: it carries these at most"
            kinds = tuple(sorted(stated))
            limited = all(_by_only(decided[name]) for name in passing)
            return SaidOfBags(kinds, why=why, covered=True, bound=kinds if limited else None)
    return SaidOfBags(unknown="no label says what it carries")


def _by_only(fact: Facts) -> bool:
    """Whether a kind passes since 'only' names one like it, not since 'sensitive' of a higher rank lets it pass."""
    return next((one.role for one in fact.accepted if one.role in ("only", "sensitive")), "") == "only"


def _lines(statements: Iterable[Statement]) -> str:
    places: list[Place] = sorted(
        {statement.place for statement in statements}, key=lambda place: (place.file, place.line)
    )
    return ", ".join(shown(str(place)) for place in places)
