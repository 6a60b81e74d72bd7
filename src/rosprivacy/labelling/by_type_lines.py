"""Lines ``only: by-type`` for all channels at which they close no way, together, into a label file with their pins.

In: policies, label files, types. Out: the new text of the label file. No line is written that, with the others, keeps
data of a source from where it gets out, be it stated or only suggested: what closes such a way, a person says by kinds.
"""

from __future__ import annotations

import os
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, LabelError
from rosprivacy.analysis.findings.closures import closed_by_lines
from rosprivacy.analysis.kernel.by_type import taken_today, under_lines
from rosprivacy.analysis.kernel.spreading import emitted, spread
from rosprivacy.analysis.model import BY_TYPE, NOWHERE, STANDARD, TYPE_LINE, Diagnostic, Place, Severity, Statement
from rosprivacy.analysis.suggesting.evidence import DERIVATION, LEAK, SOURCE
from rosprivacy.analysis.text import counted
from rosprivacy.analysis.written_names import listed
from rosprivacy.clock import today
from rosprivacy.ingest.labels.edited_entries import SaidOfElement, entries_of
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ingest.labels.label_writer import with_entries
from rosprivacy.ingest.labels.pins import PINS, SECTION_OF, TypePin, spot
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.labelling.label_lines import LabelLines, own_file
from rosprivacy.labelling.pinning import pins_of
from rosprivacy.labelling.suggested_lines import text_of, who_says
from rosprivacy.labelling.suggesting import suggested
from rosprivacy.labelling.trying import supposed
from rosprivacy.question import question_of
from rosprivacy.systems.robot_system import answer_robot

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.kernel.type_limits import TypeLimits
    from rosprivacy.analysis.model import Bound, Element
    from rosprivacy.analysis.suggesting.evidence import LabelProposal
    from rosprivacy.labelling.suggesting import Suggested
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings

WORD = "by-type"  # what a person accepts
LISTED = 5  # names in a notice
OPENING = (SOURCE, LEAK, DERIVATION)  # suggestions that open ways


def with_lines_by_type(
    policies: tuple[str, ...], labels: tuple[str, ...], by: str | None, settings: Settings
) -> LabelLines:
    """Return the label file that people edit, with such lines and their pins.

    Raises
    ------
    InputErrors
        With every problem of the input.
    LabelError
        If the file has no place for them.
    """
    if not policies:
        hint = "name the policies, and --types where types were seen"
        raise InputError("--accept", 0, f"{WORD} without policies", hint)
    file = own_file(labels)
    result = answer_robot(policies, labels, settings)
    channels = channels_by_type(result, settings, suggested(result, settings).proposals)
    if not channels:
        return LabelLines(file, text_of(file), 0)
    return _written(file, result, channels, f"accepted by {who_says(file, by)} on {today(os.environ)}", settings)


def with_offer(suggestions: Suggested, settings: Settings) -> Suggested:
    """Return suggestions with a notice of the channels of a robot, read from files, that can be taken by type."""
    result = suggestions.result
    if not result.bound.types or result.fleet is not None or result.reanalyse is None:
        return suggestions
    notices = _offer(result, channels_by_type(result, settings, suggestions.proposals))
    return replace(suggestions, notices=(*suggestions.notices, *notices))


def _offer(result: Result, channels: tuple[Element, ...]) -> Iterator[Diagnostic]:
    names, places = [one.name for one in channels], {one.identity for one in channels}
    elements = result.analysis.graph.elements
    place = next((some[0].place for v, some in result.bound.types.items() if elements[v].identity in places), NOWHERE)
    if names:
        what = f"{counted(len(names), 'channel')} could be taken by type: {listed(names, LISTED)}"
        hint = "see docs/labels.md, then run rosprivacy labels --accept by-type"
        yield Diagnostic(place, Severity.NOTICE, f"{what}; {hint}")


def channels_by_type(result: Result, settings: Settings, proposals: Iterable[LabelProposal]) -> tuple[Element, ...]:
    """Return the open channels at which such lines close no way, together; of a service one of its legs.

    Of a way that some of them would close, each is left out. What is suggested counts where data begins, is made or
    gets out, and takes nothing from what a line would close.
    """
    _, after = supposed(result, [one for one in proposals if one.label.role in OPENING])
    graph, table = result.analysis.graph, question_of(settings).types
    kinds = emitted(after.bound.elements.values())
    chosen = _candidates(result)
    while chosen:
        bound, held = _with(result, after.bound, chosen, table() if table else None, kinds)
        carried = spread(graph, bound, result.vocabulary.hierarchy)
        rows = closed_by_lines(carried, carried.all_bits, unreviewed=False)
        closing = held & {row.channel.identity for row in rows}
        if not closing and held == chosen:
            break
        chosen = held - closing
    first = {graph.elements[v].identity: graph.elements[v] for v in range(len(graph.elements) - 1, -1, -1)}
    return tuple(first[identity] for identity in sorted(chosen))


def _candidates(result: Result) -> set[tuple[str, str, str]]:
    """Open channels of a known type of which no label says anything."""
    bound, elements = result.bound, result.analysis.graph.elements
    spoken = {elements[v].identity for v, said in bound.elements.items() if any(one.rank[0] > STANDARD for one in said)}
    typed = {elements[v].identity for v in bound.types if not elements[v].pattern}
    there = {question.element.identity for question in result.analysis.open if question.element.is_channel}
    return (there & typed) - spoken


def _with(
    result: Result, supposed_bound: Bound, chosen: set[tuple[str, str, str]], table: TypeLimits | None, kinds: set[str]
) -> tuple[Bound, set[tuple[str, str, str]]]:
    """What is bound under suggestions with what lines would close without them; the channels at which they hold."""
    graph, line = result.analysis.graph, Statement(TYPE_LINE, (), (STANDARD + 1, 0), NOWHERE)
    lined = [v for v, element in enumerate(graph.elements) if element.identity in chosen]
    elements = dict(result.bound.elements)
    elements |= {v: (*elements.get(v, ()), line) for v in lined}
    stated = replace(result.bound, elements=elements)
    hierarchy = result.vocabulary.hierarchy
    closing = under_lines(graph, stated, hierarchy, table, kinds).bound.elements
    held = {v: [one for one in closing[v] if one.role == BY_TYPE] for v in lined}
    off = {graph.elements[v].identity for v, said in held.items() if not said}
    both = dict(supposed_bound.elements)
    both |= {v: (*both.get(v, ()), *said) for v, said in held.items()}
    return replace(supposed_bound, elements=dict(sorted(both.items()))), chosen - off


def _written(file: str, result: Result, channels: Iterable[Element], note: str, settings: Settings) -> LabelLines:
    """The text with a line and a pin for each channel; what was pinned stays."""
    text = text_of(file)
    labels = parse_labels(text, result.vocabulary, name=file, category=settings.category, bounds=settings.bounds)
    there = entries_of(yaml_values.parse(text, partial(LabelError, file), settings.bounds))
    said, types = [], {pin.ends: pin for pin in labels.type_pins or ()}
    named = {channel.identity: channel for channel in channels}
    for channel in named.values():
        section = next((s for s in ("channels", SECTION_OF[channel.kind]) if (s, channel.name) in there), "")
        value = there.get((section, channel.name))
        entry = {**(value if isinstance(value, dict) else {}), "only": WORD, "note": note}
        said.append(SaidOfElement(section or SECTION_OF[channel.kind], channel.name, entry))
    for ends, texts in _texts(result, named).items():
        types[ends] = TypePin(ends, tuple(sorted(texts)), Place(file, 0))
    pins = pins_of(labels)._replace(of_types=tuple(types.values()))
    new = with_entries(file, text, [*said, SaidOfElement(PINS, PINS, pins.section)])
    return LabelLines(file, new.text, len(said), new.remarks)


def _texts(result: Result, channels: Iterable[tuple[str, str, str]]) -> dict[tuple[tuple[str, str], ...], set[str]]:
    """Channel -> with which types and writers it is taken today."""
    graph, chosen = result.analysis.graph, set(channels)
    line = Statement(TYPE_LINE, (), (STANDARD + 1, 0), NOWHERE)
    lined = {v: (line,) for v, element in enumerate(graph.elements) if element.identity in chosen}
    texts: dict[tuple[tuple[str, str], ...], set[str]] = {}
    for vertex, some in taken_today(graph, replace(result.bound, elements=lined)).items():
        texts.setdefault((spot(graph.elements[vertex]),), set()).update(some)
    return texts
