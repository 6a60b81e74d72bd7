"""The answers that the graph can give to the questions of the CNIL's PIA tool, as HTML and as lists.

In: an inventory of the kinds of data, and what was stated of storages and recipients. Out: ``Html`` or plain texts.
What only a person can know is named as such. Words: a path to assess, never more.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import KINDS, MAY_REVEAL, NO_BASIS, NonRosFacts
from rosprivacy.analysis.non_ros import ADEQUATE, INSIDE, retention_of
from rosprivacy.report.catalogs.words import plain, reason_text
from rosprivacy.report.cnil.inventory import purposes_of
from rosprivacy.report.cnil.told import NAMES, Html, bullets, escaped, harmless, joined, paragraph, prose, strong
from rosprivacy.report.finding_facts import making
from rosprivacy.report.naming import count_elements

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis, CarriedData, Finding
    from rosprivacy.analysis.findings.processed import Processed
    from rosprivacy.analysis.findings.sanitizing import Cleaning
    from rosprivacy.analysis.findings.witness import Ways
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Element
    from rosprivacy.report.cnil.inventory import Kind
    from rosprivacy.report.cnil.told import Told


SHOWN = 50  # findings shown with their path, recipients
THREATS = 100
PROCESSOR = "processor"
STORED = "storage-limitation"  # the kind of findings whose end is a storage, told under 'Kept in'


@dataclass(frozen=True, slots=True)
class AnswerFacts:
    """What answers are made of.

    Attributes
    ----------
    analysis
        Of one robot of those that are alike.
    outside
        What people stated of storages and recipients.
    accepted
        Id of a finding -> why a person accepted it.
    ways
        Whose data of each kind get where, and are there at all.
    hierarchy
        Of the categories.
    words
        The words of the reader.
    processed
        What is stated of purposes and legal bases where data begin and end.
    """

    analysis: Analysis
    kinds: tuple[Kind, ...]
    outside: Mapping[Element, NonRosFacts]
    accepted: Mapping[str, str]
    ways: tuple[Ways, ...]
    hierarchy: Hierarchy
    words: Told
    processed: tuple[Processed, ...] = ()

    def of(self, element: Element) -> NonRosFacts:
        """Return what was stated of an element."""
        return self.outside.get(element, NonRosFacts())

    def storages_of(self, category: str) -> list[Element]:
        """Return the storages that data of the category itself get to."""
        here = (c for c in self.analysis.carried if category in (*c.categories, *c.pseudonymised))
        return _storages(carried.element for carried in here)

    def storages(self) -> list[Element]:
        """Return the storages that personal data get to."""
        return _storages(carried.element for carried in self.analysis.carried)

    def retention_of(self, element: Element, category: str) -> str:
        """Return how long an element keeps a category, with its backups; empty where nobody states it (rule S9)."""
        facts = self.analysis.outside.get(element)
        stated = retention_of(facts, category, self.hierarchy) if facts else []
        return self._retention(", ".join(self.words.words.duration(str(one)) for one in stated), element)

    def kept_in_all(self, element: Element) -> str:
        """Return how long an element keeps what, as stated; empty where nobody states it."""
        facts = self.analysis.outside.get(element)
        words, stated = self.words.words, facts.retention if facts else ()
        said = [(category, words.duration(str(one))) for category, one in stated]
        rows = [words.pair(self.words.data(category), one) if category else one for category, one in said]
        return self._retention(", ".join(rows), element)

    def _retention(self, duration: str, element: Element) -> str:
        facts, words = self.analysis.outside.get(element), self.words.words
        if not duration or not facts or not facts.backups:
            return plain(duration)
        if facts.backups is True:
            return plain(words("outside.kept.backups.unknown", duration=duration))
        return plain(words("outside.kept.backups", duration=duration, more=words.duration(str(facts.backups))))

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
    stored = [
        f"{told.name(element)} ({facts.retention_of(element, category.name) or told('cnil.kept.unstated')})"
        for element in facts.storages_of(category.name)
    ]
    of_kind = [way for way in facts.ways if way.element is None and way.category == category.name]
    persons = [group for way in of_kind for group in way.persons]
    unnamed = not of_kind or any(way.unnamed for way in of_kind)
    yield bullets(
        [
            *told.lines("cnil.brought", kind.sources),
            *(told.line("cnil.made", _derivations(element, of, told)) for element, of in kind.derivations),
            *_law(kind, told),
            told.line("cnil.recipients", _recipients(kind, told)),
            told.line("cnil.kept", told.names_shown(stored) or told("cnil.kept.none")),
            *([told.line("cnil.persons", told.names_shown(persons))] if persons else []),
            *purposes_of(facts.processed, category.name, told),
            told(_open_of(list(purposes_of(facts.processed, category.name, told)), unnamed=unnamed)),
        ]
    )


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
    stored = [carried for carried in facts.analysis.carried if carried.element.kind == "storage"]
    rows = [
        told.pair(
            escaped(told.name(carried.element)),
            joined(
                _storages_of(carried, told),
                Html("; "),
                _stated("cnil.retention", facts.kept_in_all(carried.element), told),
            ),
        )
        for carried in stored[:SHOWN]
    ]
    why = paragraph(told("cnil.why.duration"))
    return joined(told.rows(rows, len(stored)), why) if rows else paragraph(told("cnil.no.storage"))


def processors(facts: AnswerFacts) -> Html:
    """Return the answer to 226: who processes on behalf of the controller, as people stated it; empty if nobody did."""
    reached = [carried.element for carried in facts.analysis.carried]
    named = [element for element in reached if facts.of(element).recipient == PROCESSOR]
    told = facts.words
    rows = [told.pair(escaped(told.name(element)), _named_processor(element, facts)) for element in named[:SHOWN]]
    return told.rows(rows, len(named)) if rows else Html("")


def _named_processor(element: Element, facts: AnswerFacts) -> Html:
    told = facts.words
    who = facts.of(element).operator or told("cnil.processor.unnamed")
    country = facts.of(element).country
    where = f" ({country})" if country else ""
    contract = facts.of(element).contract
    on = told.line("cnil.contract.stated", escaped(contract)) if contract else told("cnil.contract")
    return joined(told("cnil.processor", who=escaped(f"{who}{where}")), Html("; "), on)


def transfers(facts: AnswerFacts) -> Html:
    """Return the answer to 227: where each recipient is, and on which basis data goes there."""
    told = facts.words
    leaks = [finding.leak for finding in facts.findings()]
    outside = [c.element for c in facts.analysis.carried if c.element.kind in ("external-system", "storage")]
    recipients = {element.identity: element for element in (*leaks, *outside)}
    rows = [
        told.pair(
            escaped(told.name(element)),
            joined(_stated("cnil.country", facts.of(element).country, told), _basis(element, facts)),
        )
        for element in list(recipients.values())[:SHOWN]
    ]
    return told.rows(rows, len(recipients)) if rows else paragraph(told("cnil.no.recipient"))


def _basis(element: Element, about: AnswerFacts) -> Html:
    """On what data leaves the EEA there; that it does not leave it is no transfer of chapter V."""
    facts, told = about.analysis.outside.get(element), about.words
    if facts and facts.area == INSIDE:
        return joined(Html(", "), told("cnil.inside"))
    if facts and facts.area == ADEQUATE and not facts.basis:
        return joined(Html(", "), told("cnil.adequate"))
    basis = facts.transfer if facts else ""
    in_words = (
        basis if told.words.language == "en" and basis != NO_BASIS else told.words.of_value(f"transfer.{basis}", basis)
    )
    return joined(Html("; "), _stated("cnil.basis", in_words, told))


def threats(about: AnswerFacts) -> list[str]:
    """Return the answer to 322: the paths to assess, and what nobody has reviewed. Neither text nor HTML can harm."""
    findings, told = about.findings(), about.words
    said = [_threat(finding, about) for finding in findings[:THREATS]]
    if len(findings) > THREATS:
        said.append(told.bare("cnil.threats.more", n=len(findings) - THREATS))
    if about.analysis.open:
        unreviewed = count_elements(question.element for question in about.analysis.open).elements
        said.append(told.bare("cnil.threat.open", elements=told.count(unreviewed, "element")))
    open_to_all = [element for element in about.storages() if about.of(element).encrypted is False]
    said += [told.bare("cnil.threat.unencrypted", element=told.name(element)) for element in open_to_all[:THREATS]]
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
    decided = f", {told.bare('cnil.accepted', why=accepted)}" if accepted else ""
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
            yield words.line("cnil.law", Html(f"{escaped(legal.text('name', language))} ({in_full}), {as_of}"))
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
    return words.line(key, escaped(value) if value else words("not.stated"))
