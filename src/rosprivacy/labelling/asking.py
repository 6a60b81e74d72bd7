"""Questions about a robot, and what becomes of the answers: labels and refusals in the label file.

In: policies and label files. Out: the questions that are asked now; a file with what was said of one. No list of
channels that a person can confirm closes a known finding. That is no estimate: the labels are put on, and the analysis
runs again. What a name or a library says of a node is often another kind of data than the right one: a person can type
another label, which takes nothing away.
"""

from __future__ import annotations

import json
from collections import defaultdict
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import InputErrors, shown
from rosprivacy.analysis.suggesting.channels import traffic
from rosprivacy.analysis.suggesting.evidence import SOURCE, WrittenLabel
from rosprivacy.analysis.suggesting.label_questions import LISTED, NOTHING, TYPED_AS, questions, reached_kinds
from rosprivacy.analysis.suggesting.outdated_reasons import grounds_of
from rosprivacy.analysis.suggesting.screens import screens
from rosprivacy.analysis.written_names import did_you_mean, literal, nearest
from rosprivacy.ingest.labels.label_file import STANDARD, parse_labels
from rosprivacy.ingest.suggestion_rules.accepting import NewLabel, with_labels
from rosprivacy.ingest.suggestion_rules.comments import refusal, with_refusals
from rosprivacy.labelling.conversation import NO, by_likeness
from rosprivacy.labelling.label_lines import LabelLines
from rosprivacy.labelling.suggested_lines import check_room, text_of
from rosprivacy.labelling.suggesting import refused_in
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.suggesting.label_questions import LabelQuestion, Reply, Row
    from rosprivacy.analysis.suggesting.screens import Screen, ScreenLine
    from rosprivacy.labelling.suggesting import Suggested
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings

FROM_AND_TO = 2


def asked_now(suggestions: Suggested) -> tuple[LabelQuestion, ...]:
    """Return what a person is asked under the labels that there are; no list of channels would close a finding."""
    return tuple(_without_closing(one, suggestions.result) for one in _questions(suggestions))


def _questions(suggestions: Suggested) -> tuple[LabelQuestion, ...]:
    result = suggestions.result
    read, hierarchy = traffic(result.analysis.graph, result.bound), result.vocabulary.hierarchy
    return questions(suggestions.proposals, result.analysis, result.bound, read, hierarchy, refused_in(result).says)


def screens_now(suggestions: Suggested) -> tuple[Screen, ...]:
    """Return the screens that a person is shown under the labels that there are."""
    result = suggestions.result
    return screens(
        _questions(suggestions), suggestions.proposals, reached_kinds(result.analysis), result.vocabulary.hierarchy
    )


def off_screens(suggestions: Suggested) -> int:
    """Return how many elements can be asked about as lists, and are on no screen."""
    asked = {row.element.identity for question in _questions(suggestions) for row in question.rows}
    return len(asked - {screen.element.identity for screen in screens_now(suggestions)})


def without_channels(result: Result) -> tuple[str, ...]:
    """Return the nodes that have no channel but standard ones, and of which nobody says anything.

    Nothing can be asked about them: what they do with data, they do outside ROS, such as who reads files of logs.
    """
    graph, labels = result.analysis.graph, result.bound.elements
    busy = {vertex for vertex, said in labels.items() if any(not one.shipped for one in said)}
    for flow in graph.flows:
        for vertex, other in ((flow.source, flow.target), (flow.target, flow.source)):
            if not any(one.place.file == STANDARD for one in labels.get(other, ())):
                busy.add(vertex)
    return tuple(one.name for vertex, one in enumerate(graph.elements) if one.is_node and vertex not in busy)


def unanswered_sources(suggestions: Suggested) -> tuple[str, ...]:
    """Return the nodes that perhaps bring in data that no label says of them: an answer knows nothing of it."""
    return tuple(dict.fromkeys(one.label.element.name for one in suggestions.proposals if one.label.role == SOURCE))


def with_lines(file: str, lines: Sequence[ScreenLine], person: str, day: str, settings: Settings) -> LabelLines:
    """Return a label file with the lines of a screen that a person has ticked, as an answer to a question writes them.

    Raises
    ------
    InputErrors
        If the file is no label file, or cannot be changed without losing something.
    """
    text, vocabulary = _begun(file, settings)
    note = _answered_by(person, day)
    labels = [_label(reply, note) for line in lines for reply in line.replies]
    done = with_labels(file, text, labels, vocabulary)
    return LabelLines(file, done.text, done.count, done.remarks)


def with_refusal(file: str, labels: Iterable[WrittenLabel], person: str, day: str, settings: Settings) -> LabelLines:
    """Return a label file that remembers a no to some labels.

    Raises
    ------
    InputErrors
        If the file is no label file, or has no room for comments.
    """
    text, vocabulary = _begun(file, settings)
    lines = [refusal(label, person, day) for label in labels]
    new = with_refusals(text, lines)
    check_room(file, text, new, vocabulary)
    return LabelLines(file, new, len(lines))


def with_answer(file: str, question: LabelQuestion, key: str, person: str, day: str, settings: Settings) -> LabelLines:
    """Return a label file with what a person has said of all rows of a question.

    Raises
    ------
    InputErrors
        If the file is no label file, or cannot be changed without losing something.
    """
    if key == NO:
        return with_refusal(file, (label for row in question.rows for label in row.refused), person, day, settings)
    text, vocabulary = _begun(file, settings)
    note = f"{_answered_by(person, day)}{_in_list(question)}"
    done = with_labels(file, text, list(_labels(question, key, note)), vocabulary)
    return LabelLines(file, done.text, done.count, done.remarks)


def with_label(file: str, label: WrittenLabel, person: str, day: str, settings: Settings) -> LabelLines:
    """Return a label file with a label that a person has typed.

    Raises
    ------
    InputErrors
        If the file is no label file, or cannot be changed without losing something.
    """
    text, vocabulary = _begun(file, settings)
    done = with_labels(file, text, [NewLabel(*label, f"typed by {person} on {day}")], vocabulary)
    return LabelLines(file, done.text, done.count, done.remarks)


def _begun(file: str, settings: Settings) -> tuple[str, Vocabulary]:
    """The text of a label file that has room for answers, and in whose words it is written."""
    text = text_of(file)
    vocabulary = load(ontologies=settings.ontologies)
    check_room(file, text, with_refusals(text, ()), vocabulary)
    return text, vocabulary


def _labels(question: LabelQuestion, key: str, note: str) -> Iterator[NewLabel]:
    for row in question.rows:
        reply = row.reply(key)
        if reply:
            yield _label(reply, note)


def _label(reply: Reply, note: str) -> NewLabel:
    """What a reply writes, with who said it and why."""
    why = f": {grounds_of(reply.reasons)}" if reply.reasons else ""
    return NewLabel(*reply.label, f"{note}{why}")


def _answered_by(person: str, day: str) -> str:
    return f"answered by {person} on {day}"


def _in_list(question: LabelQuestion) -> str:
    """Who reads the label later sees that it was not looked at by itself."""
    return f" in a list of {len(question.rows)}" if question.about == LISTED else ""


def _without_closing(question: LabelQuestion, result: Result) -> LabelQuestion:
    """Return a question whose rows are alike only where all of them together close no finding.

    Fewer labels close no more, so that rows can be taken out. One run of the analysis for each likeness; where it loses
    a finding, one for each row.
    """
    apart: list[Row] = []
    for rows in by_likeness(question.rows):
        if rows[0].alike and len(rows) > 1 and _closes([row.saying(NOTHING) for row in rows], result):
            apart += _by_themselves(rows, result)
    if not apart:
        return question
    return question._replace(
        rows=tuple(row._replace(alike=frozenset()) if row in apart else row for row in question.rows)
    )


def _by_themselves(rows: Sequence[Row], result: Result) -> Sequence[Row]:
    """The channels of a list that would close a finding: those that do alone, or all if only several do."""
    alone = [row for row in rows if _closes([row.saying(NOTHING)], result)]
    left = [row.saying(NOTHING) for row in rows if row not in alone]
    return alone if alone and not _closes(left, result) else rows


def closing(rows: Sequence[Row], result: Result) -> Sequence[Row]:
    """Return the channels that a list of a person's cannot have: those that would close a finding with those before.

    More labels close no less, so that what is left closes none.

    Parameters
    ----------
    rows
        With the one reply that is said of each.
    """
    if not _closes(rows, result):
        return ()
    left: list[Row] = []
    for row in rows:
        if not _closes([*left, row], result):
            left.append(row)
    return [row for row in rows if row not in left]


def _closes(rows: Sequence[Row], result: Result) -> bool:
    """Whether a finding is lost by what is said of channels; where nobody can tell, it is."""
    try:
        after = with_more(result, (reply.label for row in rows for reply in row.replies), "a list of channels")
    except InputErrors:  # they go against what a label says
        return True
    if after is None:
        return True
    return not {one.id for one in result.analysis.findings} <= {one.id for one in after.analysis.findings}


def typed_label(line: str, elements: Iterable[Element], vocabulary: Vocabulary) -> WrittenLabel | str:
    """Return the label that a line says, or in words why it says none.

    Parameters
    ----------
    line
        Name, ``node``, role, kinds: of ``derives`` from which, and to which; of the others one or more.

    Examples
    --------
    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.ontology.vocabulary import load
    >>> nodes = [Element("node", "/lidar")]
    >>> typed_label("/lidar node source Location", nodes, load())
    WrittenLabel(section='nodes', name='/lidar', roles={'source': ['Location']})
    >>> typed_label("/lidar node source Biometrik", nodes, load())
    "unknown category 'Biometrik'; did you mean Biometric?"
    """
    said: dict[str, Any]
    match line.split():
        case [name, "node", "source" | "leak" as role, *kinds] if kinds:
            said = {role: list(dict.fromkeys(kinds))}
        case [name, "node", "derives", *kinds] if len(set(kinds)) == len(kinds) == FROM_AND_TO:
            said = {"derives": [dict(zip(("from", "to"), kinds, strict=True))]}
        case _:
            return TYPED_AS
    return _unknown(name, kinds, elements, vocabulary) or WrittenLabel("nodes", literal(name), said)


def contradiction(label: WrittenLabel, result: Result) -> str:
    """Return what a label goes against, in words; nothing if it can be said beside all that is said."""
    try:
        with_more(result, [label], "this label")
    except InputErrors as error:
        return str(error)
    return ""


def _unknown(name: str, kinds: Sequence[str], elements: Iterable[Element], vocabulary: Vocabulary) -> str:
    nodes = dict.fromkeys(one.name for one in elements if one.is_node)
    if name not in nodes:
        near = nearest(name, nodes)
        return f"no node is called {shown(name)!r}; {did_you_mean(near)}" if near else TYPED_AS
    other = next((one for one in kinds if one not in vocabulary.hierarchy.ancestors), "")
    return f"unknown category {shown(other)!r}; {vocabulary.hint(other)}" if other else ""


def with_more(result: Result, labels: Iterable[WrittenLabel], name: str) -> Result | None:
    """Return the answer with some labels more, as a file of that name; None if nobody can tell.

    Raises
    ------
    InputErrors
        If they contradict each other, or what is said.
    """
    if result.reanalyse is None:
        return None
    sections: dict[str, dict[str, dict[str, list[object]]]] = defaultdict(
        lambda: defaultdict(lambda: defaultdict(list))
    )
    for label in labels:
        for role, said in label.roles.items():
            sections[label.section][label.name][role] += said
    text = json.dumps({"labels": 1, **sections})
    return result.reanalyse((*result.labels, parse_labels(text, result.vocabulary, name=name)))
