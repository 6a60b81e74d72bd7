"""The questions of the EDPB's template for an impact assessment, in our own words, and where each answer comes from.

The template is version 1.0, adopted on 10 March 2026 and published for consultation on 14 April 2026 (edpb.europa.eu,
news of that day). Not seen by us: the EDPB's own file and its explainer, their wording, and a version after the
consultation. The questions are those that public sources show, read on 2026-11-28: all of them a list of the template's
fields and of the columns of its tables (``edpb-2026-template.md`` of the public skill 'DPIA Sentinel', named at
skills.sh, lawve-ai/awesome-legal-skills); the headings 0.1 to 1.3 also dastra.eu, audit model 'EDPB DPIA Template';
what sections 0 to 6 ask for and the four decisions also reedsmith.com, 'One template to rule them all', and
digitalpolicyalert.org, event 39226.
"""

from __future__ import annotations

from typing import NamedTuple

from rosprivacy.analysis.python_311 import StrEnum

READ = "2026-11-28"  # when these sources were read


class Origin(StrEnum):
    """Where the answer to a question comes from."""

    REGISTER = "register"
    ANALYSIS = "analysis"
    PEOPLE = "people"
    NOT_APPLICABLE = "not-applicable"


class Fact(StrEnum):
    """What the analysis says that is no column of the register."""

    CREATION = "creation"
    FILES = "files"
    CRITERIA = "criteria"
    VERDICT = "verdict"
    EXTENT = "extent"
    ASSETS = "assets"
    RIGHTS = "rights"
    THREATS = "threats"
    PLAN = "plan"
    DECISIONS = "decisions"
    CONDITIONS = "conditions"


class Question(NamedTuple):
    """One question.

    Attributes
    ----------
    number
        Of the part of the template that it stands in; its first sign is the section.
    words
        Key of its text.
    columns
        Of the register: fields of ``RecordEntry``, or names in ``edpb_dpia.OWN_COLUMNS``.
    special
        Whether it is about rows only whose data can be of a special category.
    fact
        What else the analysis says.
    answer
        Field of the assessment that people answer.
    risks
        Fields of the assessment that people answer for each threat.
    """

    number: str
    words: str
    origin: Origin = Origin.PEOPLE
    columns: tuple[str, ...] = ()
    special: bool = False
    fact: Fact | None = None
    answer: str = ""
    risks: tuple[str, ...] = ()


def _of_register(number: str, words: str, *columns: str, special: bool = False, answer: str = "") -> Question:
    return Question(number, words, Origin.REGISTER, columns, special, answer=answer)


def _of_analysis(number: str, words: str, fact: Fact) -> Question:
    return Question(number, words, Origin.ANALYSIS, fact=fact)


def _of_people(number: str, words: str, answer: str = "", risks: tuple[str, ...] = ()) -> Question:
    return Question(number, words, answer=answer, risks=risks)


SECTIONS = (
    "edpb.section.overview", "edpb.section.description", "edpb.section.compliance", "edpb.section.necessity",
    "edpb.section.risks", "edpb.section.parties", "edpb.section.decision",
)  # fmt: skip
QUESTIONS = (
    Question("0", "edpb.adoption", Origin.NOT_APPLICABLE),
    _of_register("0.1", "edpb.controller", "controller", answer="sign.controller"),
    _of_people("0.1", "edpb.units"),
    _of_people("0.1", "edpb.contact"),
    _of_people("0.1", "edpb.joint"),
    _of_register("0.2", "edpb.processors", "exit", "recipient", "category", "purpose"),
    _of_register("0.3", "edpb.name", "activity"),
    _of_people("0.3", "edpb.versions"),
    _of_people("0.4", "edpb.launch"),
    _of_people("0.4", "edpb.end"),
    _of_analysis("0.5", "edpb.assessment.version", Fact.CREATION),
    _of_people("0.5", "edpb.team", "sign.name"),
    _of_analysis("0.5", "edpb.materials", Fact.FILES),
    _of_people("0.5", "edpb.reasons.gdpr"),
    _of_people("0.5", "edpb.reasons.national"),
    _of_analysis("0.5", "edpb.reasons.criteria", Fact.CRITERIA),
    _of_people("0.5", "edpb.reasons.benefit"),
    _of_people("0.5", "edpb.reasons.changed"),
    _of_analysis("0.5", "edpb.scope", Fact.VERDICT),
    _of_people("0.5", "edpb.completed", "sign.date"),
    _of_people("0.5", "edpb.validated", "sign.signature"),
    _of_people("0.5", "edpb.published"),
    _of_register("1.1.a", "edpb.data", "category", "subjects", "sources", "derivations", "article9", "provisions"),
    _of_register("1.1.b", "edpb.purposes", "purpose", "category", "subjects", answer="sign.purpose"),
    _of_people("1.1.b", "edpb.relevance"),
    _of_people("1.1.c", "edpb.secondary"),
    _of_register("1.1.d", "edpb.nature", "sources", "derivations", "exit", "form"),
    _of_analysis("1.1.d", "edpb.extent", Fact.EXTENT),
    _of_register("1.1.d", "edpb.context", "contexts", "subjects"),
    _of_register("1.1.d", "edpb.border", "countries", "exit", "country"),
    _of_register("1.1.d", "edpb.transfers", "category", "exit", "country", "transfer"),
    _of_register("1.2", "edpb.phases", "sources", "derivations", "measures", "exit", "retention"),
    _of_analysis("1.3", "edpb.assets", Fact.ASSETS),
    _of_people("1.3", "edpb.assets.other"),
    _of_people("1.4", "edpb.codes"),
    _of_register("2.1.a", "edpb.bases", "purpose", "category", "basis", answer="sign.basis"),
    _of_people("2.1.a", "edpb.balancing"),
    _of_register("2.1.b", "edpb.special", "category", "article9", "special_bases", special=True),
    _of_people("2.1.b", "edpb.special.why"),
    _of_people("2.2.a", "edpb.need"),
    _of_register("2.2.a", "edpb.recipients", "category", "exit", "recipient"),
    _of_people("2.2.a", "edpb.recipients.why"),
    _of_register("2.2.a", "edpb.retention", "category", "exit", "retention"),
    _of_people("2.2.a", "edpb.retention.why"),
    _of_people("2.2.b", "edpb.quality"),
    _of_people("2.3.a", "edpb.fairness"),
    _of_people("2.3.a", "edpb.transparency"),
    _of_people("2.3.a", "edpb.limitation"),
    _of_register("2.3.a", "edpb.minimisation", "category", "exit", "form", "measures"),
    _of_people("2.3.a", "edpb.accuracy"),
    _of_register("2.3.a", "edpb.storage", "exit", "retention"),
    _of_register("2.3.a", "edpb.integrity", "exit", "measures", "note"),
    _of_people("2.3.a", "edpb.accountability"),
    _of_people("2.3.b", "edpb.information"),
    _of_analysis("2.3.b", "edpb.access", Fact.RIGHTS),
    _of_people("2.3.b", "edpb.erasure"),
    _of_people("2.3.b", "edpb.objection"),
    _of_people("2.3.b", "edpb.automated"),
    _of_people("2.3.c", "edpb.consent"),
    _of_register("2.3.c", "edpb.contracts", "exit", "recipient", "note"),
    _of_register("2.3.c", "edpb.safeguards", "exit", "country", "transfer"),
    _of_register("2.3.d", "edpb.design", "measures", "form"),
    _of_register("2.3.e", "edpb.security", "measures"),
    _of_people("2.3", "edpb.status"),
    _of_analysis("3.1", "edpb.threats", Fact.THREATS),
    _of_people("3.1", "edpb.impacts"),
    _of_people("3.2", "edpb.necessity", "sign.necessity"),
    _of_people("3.3", "edpb.proportionality"),
    _of_people("4.1.a", "edpb.illegitimate"),
    _of_people("4.1.a", "edpb.modification"),
    _of_people("4.1.a", "edpb.disappearance"),
    _of_people("4.1.b", "edpb.method"),
    _of_people("4.1.c", "edpb.inherent", "sign.risks", risks=("likelihood", "severity", "whom")),
    _of_people("4.1.c", "edpb.factors"),
    _of_people("4.2.a", "edpb.additional", "sign.measures", risks=("measures",)),
    _of_people("4.2.b", "edpb.residual", "sign.residual", risks=("residual",)),
    _of_analysis("4.2.c", "edpb.plan", Fact.PLAN),
    _of_people("4.2.c", "edpb.monitoring"),
    _of_people("5.1", "edpb.advice", "sign.advice"),
    _of_people("5.1", "edpb.advice.followed"),
    _of_people("5.2", "edpb.views", "sign.views"),
    _of_people("5.2", "edpb.participation"),
    _of_analysis("6", "edpb.decisions", Fact.DECISIONS),
    _of_people("6", "edpb.outcome", risks=("decision",)),
    _of_analysis("6", "edpb.conditions", Fact.CONDITIONS),
    _of_people("6", "edpb.consultation", "sign.consultation"),
    _of_people("6", "edpb.justification"),
)
