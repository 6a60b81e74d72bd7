"""The answers that the graph can give to the questions of the CNIL's PIA tool, as HTML and as lists.

In: an inventory of the kinds of data, and what was stated of storages and recipients. Out: ``Html`` or plain texts.
What only a person can know is named as such. Words: a path to assess, never more.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import KINDS, MAY_REVEAL
from rosprivacy.analysis.non_ros import ADEQUATE, INSIDE
from rosprivacy.report.cnil.markup import (
    Html,
    bullets,
    counted,
    escaped,
    harmless,
    joined,
    paragraph,
    prose,
    some,
    strong,
)
from rosprivacy.report.element_counts import count_elements

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis, Carried, Finding
    from rosprivacy.analysis.findings.sanitizing import Cleaning
    from rosprivacy.analysis.model import Element
    from rosprivacy.report.inventory import Kind

    Stated = Mapping[tuple[str, str, str], Mapping[str, str]]

NAMES = 30  # named in a row
SHOWN = 50  # findings shown with their path, recipients
THREATS = 100
PROCESSOR = "processor"
STORED = "storage-limitation"  # the kind of findings whose end is a storage, told under 'Kept in'
NOTHING_FOLLOWED = Html(
    "<p>No label names a source of personal data, so nothing was followed and nothing can be said here.</p>"
)
NO_RECIPIENT = Html("The analysis knows of no recipient that personal data can reach under the labels given.")
PERSONS_TO_COMPLETE = "Persons concerned, purpose, who has access: to be completed."
NO_STORAGE = Html("No storage that personal data reaches is stated. What nodes and recipients keep: to be completed.")


@dataclass(frozen=True, slots=True)
class Known:
    """What answers are made of.

    Attributes
    ----------
    analysis
        Of one robot of those that are alike.
    stated
        Identity of a storage or recipient -> what people stated of it (``Answer.stated``).
    accepted
        Id of a finding -> why a person accepted it (``Answer.accepted``).
    subjects
        Identity of a source -> groups of persons that its data are about.
    retention
        (element, category) -> how long it is kept there, empty where nobody states it (``Answer.retention``).
    """

    analysis: Analysis
    kinds: tuple[Kind, ...]
    stated: Stated
    accepted: Mapping[str, str]
    subjects: Mapping[tuple[str, str, str], tuple[str, ...]]
    retention: Callable[[Element, str], str]

    def of(self, element: Element, what: str) -> str:
        """Return what was stated of an element, empty if nothing."""
        return self.stated.get(element.identity, {}).get(what, "")

    def storages_of(self, category: str) -> list[Element]:
        """Return the storages that data of the category itself get to."""
        here = (c for c in self.analysis.carried if category in (*c.categories, *c.pseudonymised))
        return _storages(carried.element for carried in here)

    def storages(self) -> list[Element]:
        """Return the storages that personal data get to."""
        return _storages(carried.element for carried in self.analysis.carried)

    def findings(self) -> list[Finding]:
        """Return what is to be assessed, by kind of data."""
        return [finding for kind in self.kinds for finding in kind.findings]


def data(known: Known) -> Html:
    """Return the answer to 121: the data, where they come from, who can get them, how long they are kept."""
    return joined(*(part for kind in known.kinds for part in _data_of(kind, known))) or NOTHING_FOLLOWED


def _data_of(kind: Kind, known: Known) -> Iterator[Html]:
    category = kind.category
    name = joined(escaped(category.title), Html(" ("), escaped(category.name), Html(")"))
    yield paragraph(strong(name), Html(": "), prose(category.definition))
    stored = [
        f"{_name(element)} ({known.retention(element, category.name) or 'retention not stated'})"
        for element in known.storages_of(category.name)
    ]
    persons = sorted({group for source in kind.sources for group in known.subjects.get(source.identity, ())})
    yield bullets(
        [
            *_lines("Brought in by", kind.sources),
            *(_line("Made", _made(element, of)) for element, of in kind.made),
            *_law(kind),
            _line("Recipients that it can reach", _recipients(kind)),
            _line("Kept in", some(stored, NAMES) or Html("no storage is stated")),
            *([_line("Persons concerned, as labels name them", some(persons, NAMES))] if persons else []),
            Html("Purpose, who has access: to be completed." if persons else PERSONS_TO_COMPLETE),
        ]
    )


def life_cycle(known: Known) -> Html:
    """Return the answer to 122: from source to recipient, with the shortest path of each finding."""
    parts = [part for kind in known.kinds for part in _life_of(kind)]
    findings = known.findings()
    if findings:
        parts.append(paragraph(strong(Html("Shortest path to each recipient"))))
        parts.append(bullets(_bounded([_way(finding, known) for finding in findings[:SHOWN]], len(findings))))
    parts.append(paragraph(Html("What happens outside the analysed system, archiving and erasure: to be completed.")))
    return joined(*parts) if known.kinds else NOTHING_FOLLOWED


def _life_of(kind: Kind) -> Iterator[Html]:
    yield paragraph(strong(escaped(kind.category.title)))
    users = [element for element in kind.reached if not element.is_channel]
    channels = counted(len(kind.reached) - len(users), "channel")
    yield bullets(
        [
            *_lines("Collection", kind.sources),
            *(_line("Made", _made(element, of)) for element, of in kind.made),
            _line("Use", joined(counted(len(users), "element"), Html(" over "), channels, Html(": "), _names(users))),
            *(_line("Cleaning", _cleaning(cleaning)) for cleaning in kind.cleaned),
            *_lines("Storage", _storages(kind.reached)),
            _line("Recipients", _recipients(kind)),
            *_lines("Not reviewed yet", kind.open),
        ]
    )


def supports(known: Known) -> Html:
    """Return the answer to 123: what carries the data, by its kind."""
    carries: dict[str, dict[str, Carried]] = {}
    for carried in known.analysis.carried:
        carries.setdefault(carried.element.kind, {})[_name(carried.element)] = carried
    parts = []
    for kind in (kind for kind in KINDS if kind in carries):
        rows = [_line(escaped(name), _held(carried)) for name, carried in list(carries[kind].items())[:NAMES]]
        parts.append(paragraph(strong(counted(len(carries[kind]), "ROS node" if kind == "node" else kind))))
        parts.append(bullets(_bounded(rows, len(carries[kind]))))
    parts.append(paragraph(Html("Computers, networks, persons and paper: to be completed.")))
    return joined(*parts) if carries else NOTHING_FOLLOWED


def minimisation(known: Known) -> Html:
    """Return the answer to 213: who gets which kind; whether each needs it is a person's question."""
    parts = []
    for kind in known.kinds:
        users = [e for e in kind.reached if not e.is_channel and e not in kind.sources]
        number = joined(Html(": "), counted(len(users), "element"), Html(" that did not bring it in can get it."))
        rows = [
            *_lines("They are", users),
            *_lines("Not reviewed for it", kind.open),
            *_lines("Cleaned on the way by", [cleaning.element for cleaning in kind.cleaned]),
            Html("Does each of them need this kind of data for the purpose? To be completed."),
        ]
        parts += [paragraph(strong(escaped(kind.category.title)), number), bullets(rows)]
    return joined(*parts) or NOTHING_FOLLOWED


def retention(known: Known) -> Html:
    """Return the answer to 215: how long each storage keeps what gets there."""
    stored = [carried for carried in known.analysis.carried if carried.element.kind == "storage"]
    rows = [
        _line(
            escaped(_name(carried.element)),
            joined(_held(carried), Html("; "), _stated("retention", known.of(carried.element, "retention"))),
        )
        for carried in stored[:SHOWN]
    ]
    why = paragraph(Html("Why each duration is needed: to be completed."))
    return joined(bullets(_bounded(rows, len(stored))), why) if rows else paragraph(NO_STORAGE)


def processors(known: Known) -> Html:
    """Return the answer to 226: who processes on behalf of the controller, as people stated it; empty if nobody did."""
    reached = [carried.element for carried in known.analysis.carried]
    named = [element for element in reached if known.of(element, "role") == PROCESSOR]
    rows = [_line(escaped(_name(element)), _named_processor(element, known)) for element in named[:SHOWN]]
    return bullets(_bounded(rows, len(named))) if rows else Html("")


def _named_processor(element: Element, known: Known) -> Html:
    who = known.of(element, "operator") or "to be named"
    where = f" ({known.of(element, 'country')})" if known.of(element, "country") else ""
    return joined(escaped(f"processor: {who}{where}"), Html("; contract under Article 28 GDPR: to be completed"))


def transfers(known: Known) -> Html:
    """Return the answer to 227: where each recipient is, and on which basis data goes there."""
    leaks = [finding.leak for finding in known.findings()]
    outside = [c.element for c in known.analysis.carried if c.element.kind in ("external-system", "storage")]
    recipients = {element.identity: element for element in (*leaks, *outside)}
    rows = [
        _line(escaped(_name(element)), joined(_stated("country", known.of(element, "country")), _basis(element, known)))
        for element in list(recipients.values())[:SHOWN]
    ]
    return bullets(_bounded(rows, len(recipients))) if rows else paragraph(NO_RECIPIENT)


def _basis(element: Element, known: Known) -> Html:
    """On what data leaves the EEA there; that it does not leave it is no transfer of chapter V."""
    facts = known.analysis.outside.get(element)
    if facts and facts.area == INSIDE:
        return Html(", in the EEA: no transfer to a third country")
    if facts and facts.area == ADEQUATE and not facts.transfer:
        return Html(", adequacy decision (Article 45 GDPR)")
    return joined(Html("; "), _stated("basis of a transfer", known.of(element, "basis")))


def threats(known: Known) -> list[str]:
    """Return the answer to 322: the paths to assess, and what nobody has reviewed. Neither text nor HTML can harm."""
    findings = known.findings()
    said = [_threat(finding, known) for finding in findings[:THREATS]]
    if len(findings) > THREATS:
        said.append(f"{len(findings) - THREATS:,} more paths to assess")
    if known.analysis.open:
        unreviewed = count_elements(question.element for question in known.analysis.open).elements
        said.append(f"{counted(unreviewed, 'element')} reached by personal data and not reviewed")
    open_to_all = [element for element in known.storages() if known.of(element, "encrypted") == "no"]
    said += [harmless(f"data at rest not encrypted: {_name(element)}") for element in open_to_all[:THREATS]]
    return said


def _threat(finding: Finding, known: Known) -> str:
    what = f"{_form(finding)}{finding.category} can get from {_name(finding.source)} to {_name(finding.leak)}"
    why = harmless(f"; {finding.reason}") if finding.reason else ""
    decided = f", accepted: {known.accepted[finding.id]}" if finding.id in known.accepted else ""
    return f"{harmless(what)}{why} (path to assess {finding.id}{harmless(decided)})"


def _line(what: str, said: Html) -> Html:
    """One line of a list; ``what`` is ours or escaped."""
    return Html(f"{what}: {said}")


def _lines(what: str, elements: Collection[Element]) -> list[Html]:
    """One line of names, none without them."""
    return [_line(what, _names(elements))] if elements else []


def _bounded(rows: list[Html], number: int) -> list[Html]:
    """Rows, and how many more there are."""
    return [*rows, Html(f"and {number - len(rows):,} more")] if number > len(rows) else rows


def _name(element: Element) -> str:
    kind = "" if element.is_node else f"{element.kind} "
    return f"{kind}{element.full_name}"


def _names(elements: Collection[Element]) -> Html:
    return some([_name(element) for element in elements], NAMES) if elements else Html("none")


def _storages(elements: Iterable[Element]) -> list[Element]:
    return [element for element in elements if element.kind == "storage"]


def _form(finding: Finding) -> str:
    return "pseudonymised " if finding.pseudonymised else ""


def _made(element: Element, of: str) -> Html:
    return joined(escaped(_name(element)), Html(" makes it of "), escaped(of))


def _held(carried: Carried) -> Html:
    return some([*carried.categories, *(f"pseudonymised {name}" for name in carried.pseudonymised)], NAMES)


def _cleaning(cleaning: Cleaning) -> Html:
    still = " (the data is still personal)" if cleaning.method == "pseudonymise" else ""
    taken = "" if cleaning.stated else ", taken because the label states no method"
    return joined(escaped(_name(cleaning.element)), Html(": "), escaped(f"{cleaning.method}{still}{taken}"))


def _law(kind: Kind) -> Iterator[Html]:
    """What a person has to look up; of what such data may only reveal, the names."""
    for legal in kind.law:
        if legal.verdict != MAY_REVEAL:
            condition = f": {prose(legal.condition)}" if legal.condition else ""
            said = f"{escaped(legal.name)} ({escaped(legal.verdict)}{condition}), law as of {escaped(legal.as_of)}"
            yield _line("Law to check", Html(said))
    revealed = list(dict.fromkeys(legal.name for legal in kind.law if legal.verdict == MAY_REVEAL))
    if revealed:
        yield _line("May reveal what these speak of", some(revealed, NAMES))
    if kind.category.article9 == "no":
        yield _line("Not Article 9 GDPR by itself", prose(kind.category.reason))
    if kind.category.article9 == "unknown":
        yield Html("Whether Article 9 GDPR applies to such data is not stated: to be completed.")


def _recipients(kind: Kind) -> Html:
    outside = [finding for finding in kind.findings if finding.kind != STORED]
    names = [_name(f.leak) + (" (pseudonymised)" if f.pseudonymised else "") for f in outside]
    found = some(list(dict.fromkeys(names)), NAMES) or Html("none found under the labels given")
    unknown = joined(Html("; not reviewed: "), counted(len(kind.open), "element")) if kind.open else Html("")
    return joined(found, unknown)


def _way(finding: Finding, known: Known) -> Html:
    names = [_name(element) for element in finding.witness]
    left_out = len(names) - NAMES
    if left_out > 0:
        names = [*names[: NAMES // 2], f"{left_out} more", *names[-(NAMES // 2) :]]
    decided = Html(f" (accepted: {prose(known.accepted[finding.id])})") if finding.id in known.accepted else Html("")
    path = Html(" → ".join(escaped(name) for name in names))
    return joined(escaped(f"{_form(finding)}{finding.category}"), Html(": "), path, decided)


def _stated(what: str, value: str) -> Html:
    return _line(what, escaped(value) if value else Html("not stated"))
