"""The answers that the graph can give to the questions of the CNIL's PIA tool, as HTML and as lists.

In: an inventory of the kinds of data, and what was stated of storages and recipients. Out: ``Html`` or plain texts.
What only a person can know is named as such. Words: a path to assess, never more.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import KINDS, MAY_REVEAL
from rosprivacy.analysis.model.register_row import Cell
from rosprivacy.analysis.non_ros import INSIDE
from rosprivacy.report import row_texts
from rosprivacy.report.catalogs.words import plain, reason_text
from rosprivacy.report.cnil.inventory import purposes_of
from rosprivacy.report.cnil.person_answers import PersonAnswers
from rosprivacy.report.cnil.told import NAMES, Html, bullets, escaped, harmless, joined, paragraph, prose, strong
from rosprivacy.report.document.register import register_entry
from rosprivacy.report.finding_facts import making
from rosprivacy.report.naming import count_elements

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis, CarriedData, Finding
    from rosprivacy.analysis.findings.processed import Processed
    from rosprivacy.analysis.findings.sanitizing import Cleaning
    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.model.register_row import RegisterRow
    from rosprivacy.report.cnil.inventory import Kind
    from rosprivacy.report.cnil.person_answers import AssessedPath
    from rosprivacy.report.cnil.told import Told


SHOWN = 50  # findings shown with their path, recipients
THREATS = 100
PROCESSOR = "processor"
NO_ANSWERS = PersonAnswers()
STORED = "storage-limitation"  # the kind of findings whose end is a storage, told under 'Kept in'


@dataclass(frozen=True, slots=True)
class AnswerFacts:
    """What answers are made of.

    Attributes
    ----------
    analysis
        Of one robot of those that are alike.
    accepted
        Id of a finding -> why a person accepted it.
    register
        What is known of each kind of data at each place.
    words
        The words of the reader.
    processed
        What is stated of purposes and legal bases where data begin and end.
    people, paths
        What people answered in the fields of a report, and the paths that they may have answered about.
    """

    analysis: Analysis
    kinds: tuple[Kind, ...]
    accepted: Mapping[str, str]
    register: tuple[RegisterRow, ...]
    words: Told
    processed: tuple[Processed, ...] = ()
    people: PersonAnswers = NO_ANSWERS
    paths: tuple[AssessedPath, ...] = ()

    def leaving(self) -> list[RegisterRow]:
        """Return the rows whose data leave or rest somewhere."""
        return [row for row in self.register if row.places]

    def stored(self) -> list[RegisterRow]:
        """Return the rows whose data rest in a storage."""
        return [row for row in self.leaving() if row.places[0].kind == "storage"]

    def retention(self, row: RegisterRow) -> str:
        """Return how long a place keeps the kind, with its backups; empty where nobody states it (rule S9)."""
        return plain(row_texts.retention(register_entry(row), self.words.words))

    def findings(self) -> list[Finding]:
        """Return what is to be assessed, by kind of data."""
        return [finding for kind in self.kinds for finding in kind.findings]


def data(facts: AnswerFacts) -> Html:
    """Return the answer to 121: the data, where they come from, who can get them, how long they are kept."""
    return joined(*(part for kind in facts.kinds for part in _data_of(kind, facts))) or nothing(facts)


def nothing(facts: AnswerFacts) -> Html:
    """Return what is said where no data were followed."""
    return paragraph(facts.words("cnil.nothing"))


def _data_of(kind: Kind, facts: AnswerFacts) -> Iterator[Html]:
    category, told = kind.category, facts.words
    name = joined(_title(kind, told), Html(" ("), escaped(category.name), Html(")"))
    yield paragraph(told.pair(strong(name), told.prose(category.text("definition", told.words.language))))
    of_kind = [row for row in facts.register if row.category == category.name]
    stored = [
        joined(
            escaped(told.name(place)), Html(" ("), prose(facts.retention(row) or told("cnil.kept.unstated")), Html(")")
        )
        for row in facts.stored()
        for place in row.places
        if row in of_kind
    ]
    unnamed = not of_kind or any(Cell.SUBJECTS in row.to_complete for row in of_kind)
    yield bullets(
        [
            *told.lines("cnil.brought", kind.sources),
            *(told.line("cnil.made", _derivations(element, of, told)) for element, of in kind.derivations),
            *_law(kind, told),
            told.line("cnil.recipients", _recipients(kind, told)),
            told.line("cnil.kept", told.row(stored[:NAMES], len(stored)) or told("cnil.kept.none")),
            *_persons(of_kind, told),
            *purposes_of(facts.processed, category.name, told),
            told(_open_of(list(purposes_of(facts.processed, category.name, told)), unnamed=unnamed)),
        ]
    )


def _persons(rows: Iterable[RegisterRow], words: Told) -> Iterator[Html]:
    """Whose data: of places that get data of others, apart."""
    groups: dict[tuple[str, ...], list[Element]] = {}
    for row in rows:
        if row.subjects:
            groups.setdefault(row.subjects, []).extend(row.places)
    for persons, places in groups.items():
        names = words.names_shown(persons)
        at = words("cnil.persons.at", persons=names, places=words.names(places))
        yield words.line("cnil.persons", at if places and len(groups) > 1 else names)


def _open_of(purposes: list[Html], *, unnamed: bool) -> str:
    """The sentence that names what a person has to complete."""
    if purposes:
        return "cnil.persons.access.open" if unnamed else "cnil.access.open"
    return "cnil.persons.open" if unnamed else "cnil.purpose.open"


def life_cycle(facts: AnswerFacts) -> Html:
    """Return the answer to 122: from source to recipient, with the shortest path of each finding."""
    told = facts.words
    parts = [part for kind in facts.kinds for part in _life_of(kind, told)]
    findings = facts.findings()
    if findings:
        parts.append(paragraph(strong(told("cnil.shortest"))))
        parts.append(told.rows([_way(finding, facts) for finding in findings[:SHOWN]], len(findings)))
    parts.append(paragraph(told("cnil.beyond")))
    return joined(*parts) if facts.kinds else nothing(facts)


def _life_of(kind: Kind, words: Told) -> Iterator[Html]:
    yield paragraph(strong(_title(kind, words)))
    users = [element for element in kind.reached if not element.is_channel]
    channels = words.count(len(kind.reached) - len(users), "cnil.channel")
    elements = words.count(len(users), "element")
    yield bullets(
        [
            *words.lines("cnil.collection", kind.sources),
            *(words.line("cnil.made", _derivations(element, of, words)) for element, of in kind.derivations),
            words.line(
                "cnil.use", words("cnil.use.of", elements=elements, channels=channels, names=words.names(users))
            ),
            *(words.line("cnil.cleaning", _cleaning(cleaning, words)) for cleaning in kind.cleaned),
            *words.lines("cnil.storage", _storages(kind.reached)),
            words.line("cnil.to", _recipients(kind, words)),
            *words.lines("cnil.unreviewed", kind.open),
        ]
    )


def _title(kind: Kind, words: Told) -> Html:
    return escaped(kind.category.text("title", words.words.language))


def supports(facts: AnswerFacts) -> Html:
    """Return the answer to 123: what carries the data, by its kind."""
    told = facts.words
    carries: dict[str, dict[str, CarriedData]] = {}
    for carried in facts.analysis.carried:
        carries.setdefault(carried.element.kind, {})[told.name(carried.element)] = carried
    parts = []
    for kind in (kind for kind in KINDS if kind in carries):
        rows = [
            told.pair(escaped(name), _storages_of(carried, told))
            for name, carried in list(carries[kind].items())[:NAMES]
        ]
        parts.append(paragraph(strong(told.count(len(carries[kind]), f"cnil.kind.{kind}"))))
        parts.append(told.rows(rows, len(carries[kind])))
    parts.append(paragraph(told("cnil.paper")))
    return joined(*parts) if carries else nothing(facts)


def minimisation(facts: AnswerFacts) -> Html:
    """Return the answer to 213: who gets which kind; whether each needs it is a person's question."""
    told, parts = facts.words, []
    for kind in facts.kinds:
        users = [e for e in kind.reached if not e.is_channel and e not in kind.sources]
        rows = [
            *told.lines("cnil.they", users),
            *told.lines("cnil.unreviewed.for", kind.open),
            *told.lines("cnil.cleaned.by", [cleaning.element for cleaning in kind.cleaned]),
            told("cnil.need"),
        ]
        get = told("cnil.get", elements=told.count(len(users), "element"))
        parts += [paragraph(told.pair(strong(_title(kind, told)), get)), bullets(rows)]
    return joined(*parts) or nothing(facts)


def retention(facts: AnswerFacts) -> Html:
    """Return the answer to 215: how long each storage keeps what gets there."""
    told = facts.words
    alike: dict[tuple[Html, str], list[str]] = {}
    for row in facts.stored():
        data = told.data(row.category, pseudonymised=row.pseudonymised)
        alike.setdefault((told.names(row.places), facts.retention(row)), []).append(data)
    rows = [
        told.pair(place, joined(told.names_shown(some), Html("; "), _stated("cnil.retention", period, told)))
        for (place, period), some in alike.items()
    ]
    why = paragraph(told("cnil.why.duration"))
    return joined(told.rows(rows[:SHOWN], len(rows)), why) if rows else paragraph(told("cnil.no.storage"))


def processors(facts: AnswerFacts) -> Html:
    """Return the answer to 226: who processes on behalf of the controller, as people stated it; empty if nobody did."""
    told, named = facts.words, [row for row in facts.leaving() if row.recipient == PROCESSOR]
    rows = list(dict.fromkeys(told.pair(told.names(row.places), _named_processor(row, told)) for row in named))
    return told.rows(rows[:SHOWN], len(rows))


def _named_processor(row: RegisterRow, words: Told) -> Html:
    who = row.operator or words("cnil.processor.unnamed")
    where = f" ({row.country})" if row.country else ""
    on = words.line("cnil.contract.stated", prose(row.contract)) if row.contract else words("cnil.contract")
    return joined(words("cnil.processor", who=prose(f"{who}{where}")), Html("; "), on)


def transfers(facts: AnswerFacts) -> Html:
    """Return the answer to 227: where each place is, and on which basis data goes there."""
    told = facts.words
    rows = list(dict.fromkeys(told.pair(told.names(row.places), _transfer(row, told)) for row in facts.leaving()))
    return told.rows(rows[:SHOWN], len(rows)) if rows else paragraph(told("cnil.no.recipient"))


def _transfer(row: RegisterRow, words: Told) -> Html:
    """Where a place is, and on what data get there; inside the EEA none is stated: nobody knows who reads there."""
    country = _stated("cnil.country", row.country, words)
    if row.area == INSIDE:
        return joined(country, Html(", "), words("cnil.inside"))
    basis = _stated("cnil.basis", plain("; ".join(row_texts.transfer(register_entry(row), words.words))), words)
    said = [] if row.area else [country]  # with an area the basis names it
    said += [basis, *([words("record.open")] if Cell.SAFEGUARDS in row.to_complete else [])]
    return Html("; ".join(said))


def threats(about: AnswerFacts) -> list[str]:
    """Return the answer to 322: the paths to assess, and what nobody has reviewed. Neither text nor HTML can harm."""
    findings, told = about.findings(), about.words
    said = [_threat(finding, about) for finding in findings[:THREATS]]
    if len(findings) > THREATS:
        said.append(told.bare("cnil.threats.more", n=len(findings) - THREATS))
    if about.analysis.open:
        unreviewed = count_elements(question.element for question in about.analysis.open).elements
        said.append(told.bare("cnil.threat.open", elements=told.count(unreviewed, "element")))
    open_to_all = list(
        dict.fromkeys(told.name(e) for row in about.leaving() if row.encrypted is False for e in row.places)
    )
    said += [told.bare("cnil.threat.unencrypted", element=element) for element in open_to_all[:THREATS]]
    return said


def _threat(finding: Finding, facts: AnswerFacts) -> str:
    told = facts.words
    data = told.data(finding.category, pseudonymised=finding.pseudonymised)
    ends = {"source": told.name(finding.source), "leak": told.name(finding.leak)}
    of, by = making(finding)
    if by:
        made = {"of": told.data(of), "makers": ", ".join(map(told.name, by))}
        what = told.bare("cnil.threat.made", data=data, **made, **ends)
    else:
        what = told.bare("cnil.threat", data=data, **ends)
    why = f"; {harmless(plain(reason_text(finding.why, told.words, told.data)))}" if finding.why else ""
    accepted = facts.accepted.get(finding.id)
    decided = f", {harmless(plain(told.words('cnil.accepted', why=accepted)))}" if accepted else ""
    return f"{what}{why} ({told.bare('cnil.threat.id', id=finding.id)}{decided})"


def _storages(elements: Iterable[Element]) -> list[Element]:
    return [element for element in elements if element.kind == "storage"]


def _derivations(element: Element, of: str, words: Told) -> Html:
    return words("cnil.makes", element=escaped(words.name(element)), of=escaped(words.data(of)))


def _storages_of(carried: CarriedData, words: Told) -> Html:
    hidden = (words.data(name, pseudonymised=True) for name in carried.pseudonymised)
    return words.names_shown([*map(words.data, carried.categories), *hidden])


def _cleaning(cleaning: Cleaning, words: Told) -> Html:
    still = f" ({words('cnil.still')})" if cleaning.method == "pseudonymise" else ""
    taken = "" if cleaning.stated else f", {words('cnil.taken')}"
    return words.pair(
        escaped(words.name(cleaning.element)), Html(f"{words(f'cnil.method.{cleaning.method}')}{still}{taken}")
    )


def _law(kind: Kind, words: Told) -> Iterator[Html]:
    """What a person has to look up; of what such data may only reveal, the names."""
    language = words.words.language
    for legal in kind.law:
        if legal.verdict != MAY_REVEAL:
            verdict = words(f"cnil.verdict.{legal.verdict}")
            condition = legal.text("condition", language)
            in_full = words.pair(verdict, words.prose(condition)) if condition else verdict
            as_of = words("cnil.law.as.of", date=escaped(words.words.date(legal.as_of)))
            yield words.line("cnil.law", Html(f"{prose(legal.text('name', language))} ({in_full}), {as_of}"))
    revealed = list(dict.fromkeys(legal.text("name", language) for legal in kind.law if legal.verdict == MAY_REVEAL))
    if revealed:
        yield words.line("cnil.reveals", words.names_shown(revealed))
    if kind.category.article9 == "no":
        yield words.line("cnil.no.article9", words.prose(kind.category.text("reason", language)))
    if kind.category.article9 == "unknown":
        yield words("cnil.unknown.article9")


def _recipients(kind: Kind, words: Told) -> Html:
    outside = [finding for finding in kind.findings if finding.kind != STORED]
    hidden = f" ({words('cell.hidden')})"
    names = [words.name(f.leak) + (hidden if f.pseudonymised else "") for f in outside]
    found = words.names_shown(list(dict.fromkeys(names))) or words("cnil.none.found")
    if not kind.open:
        return found
    return joined(found, Html("; "), words("cnil.not.reviewed", elements=words.count(len(kind.open), "element")))


def _way(finding: Finding, facts: AnswerFacts) -> Html:
    told = facts.words
    names = [escaped(told.name(element)) for element in finding.witness]
    left_out = len(names) - NAMES
    if left_out > 0:
        names = [*names[: NAMES // 2], told("cnil.way.more", n=left_out), *names[-(NAMES // 2) :]]
    accepted = facts.accepted.get(finding.id)
    decided = Html(f" ({told('cnil.accepted', why=prose(accepted))})") if accepted else Html("")
    data = escaped(told.data(finding.category, pseudonymised=finding.pseudonymised))
    return joined(told.pair(data, Html(" → ".join(names))), decided)


def _stated(key: str, value: str, words: Told) -> Html:
    return words.line(key, prose(value) if value else words("not.stated"))
