"""The impact assessment: what only a person can say, as fields to fill in, and the answers that were saved before.

In: the flows of a report and the answers. Out: ``Assessment``: Article 35(7)(a) to (d), 35(2), 35(9), 36, and the nine
criteria of WP 248 rev.01 with what is seen of each, never that no assessment is needed. A field is known by a key that
stays the same as long as the finding does; answers whose field is gone are kept and told. The page writes the file of
answers (``report.js``); people may change it by hand.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.analysis.json_values import misfits, parsed, validator
from rosprivacy.analysis.model import SENSED, SPECIAL
from rosprivacy.analysis.text import fit, printable
from rosprivacy.report.compare.earlier import bytes_of
from rosprivacy.report.finding_facts import REVEALS, strength
from rosprivacy.report.page.index import weight

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.page.flows import ToDecide
    from rosprivacy.report.page.index import Index

FORMAT = "rosprivacy.assessment/1"
HINT = "give what the button 'Save the answers' of a report wrote"
SCHEMA = {
    "type": "object",
    "required": ["format", "answers"],
    "properties": {
        "format": {"const": FORMAT},
        "answers": {"type": "object", "additionalProperties": {"type": "string"}},
    },
    "additionalProperties": False,
}


@dataclass(frozen=True, slots=True)
class Answers:
    """What a person answered.

    Attributes
    ----------
    texts
        Key of a field -> its text, lines kept; no empty ones.
    """

    texts: Mapping[str, str] = field(default_factory=dict)
    file: str = ""
    sha256: str = ""


def read_answers(file: str) -> Answers:
    """Read the answers of an earlier report.

    Raises
    ------
    InputError
        If the file cannot be read, or is no JSON.
    InputErrors
        With a line for each place that is not as the format says.
    """
    data = bytes_of(file, HINT)
    value = parsed(data, lambda *said: InputError(file, *said), HINT)
    wrong = misfits(validator(SCHEMA), value)
    if wrong:
        raise InputErrors(InputError(file, 0, text, HINT) for text in wrong)
    texts = {key: clean for key, text in sorted(value["answers"].items()) if (clean := _clean(text))}
    return Answers(texts, file, hashlib.sha256(data).hexdigest())


def _clean(text: str) -> str:
    """The lines, each fit to be shown."""
    return "\n".join(printable(line) for line in text.strip().splitlines())


PERSONAL = {"CommunicationContent", "CommunicationMetadata", "Household", "Location", "Voice"}  # WP 248, criterion 4
TRACKED = {"Location", "WirelessDeviceId"}  # where persons are, and who passes by
SHOWN_AT_MOST = 6


class AssessmentCriterion(NamedTuple):
    """One criterion: its name, and what the analysis shows of it, empty if only a person can say."""

    name: str
    shows: str


def criteria(index: Index) -> tuple[AssessmentCriterion, ...]:
    """Return all nine, in their order."""
    words = index.words
    makes = _makes(index)
    new = _innovative(makes, index)
    shows = [makes, "", _observes(index), _special(index), _scale(index), _combines(index), _subjects(index), new, ""]
    return tuple(AssessmentCriterion(words(f"criterion.{number}"), said) for number, said in enumerate(shows, 1))


def _row(texts: list[str], index: Index) -> str:
    return index.words.row(index.words.first(texts, SHOWN_AT_MOST))


def _makes(index: Index) -> str:
    rows = [row for row in index.document["derivations"] if row["reached"]]
    texts = [
        index.words("criterion.make", element=element, data=index.data(made), of=index.data(of))
        for of, made in dict.fromkeys((row["from"], row["to"]) for row in rows)
        for element in index.names([r["element"] for r in rows if (r["from"], r["to"]) == (of, made)])
    ]
    return index.words("criterion.makes", names=_row(texts, index)) if texts else ""


def _observes(index: Index) -> str:
    sources = [
        index.elements[element]
        for element, categories in index.of_role.get("source", {}).items()
        if any(_of_persons_there(category, index) for category in categories)
    ]
    return index.words("criterion.observes", names=_row(list(index.names(sources)), index)) if sources else ""


def _of_persons_there(category: str, index: Index) -> bool:
    """Whether data are of who is there: seen or heard, where somebody is, or whose device is near."""
    seen = not set(index.categories[category]["data_types"]).isdisjoint(SENSED)
    return seen or not TRACKED.isdisjoint(index.upwards(category))


def _special(index: Index) -> str:
    """Special categories, data of Article 10, and what is highly personal all the same, as WP 248 lists them."""
    kinds = index.categories.items()
    groups = {
        "criterion.special": [name for name, category in kinds if strength(category) == SPECIAL],
        "criterion.reveals": [name for name, category in kinds if strength(category) == REVEALS],
        "criterion.personal": [name for name in index.categories if PERSONAL.intersection(index.upwards(name))],
    }
    said = [index.words(key, names=index.all_data(names)) for key, names in groups.items() if names]
    return "; ".join(said) or (index.words("criterion.none") if index.categories else "")


def _innovative(makes: str, index: Index) -> str:
    if not index.of_role.get("source"):
        return makes
    return index.words("criterion.innovative.makes" if makes else "criterion.innovative")


def _scale(index: Index) -> str:
    return index.words("criterion.scale", robots=index.words.count(max(1, len(index.robots())), "robot"))


def _combines(index: Index) -> str:
    """Elements that get kinds of data of which none is the broader one of another."""
    several = [row for row in index.document["carries"] if len({*row["categories"], *row["pseudonymised"]}) > 1]
    at = [row["element"] for row in several if row["element"]["kind"] not in ("topic", "service", "action")]
    if not at:
        return ""
    robots = {(element["kind"], element["name"], element["robot"]) for element in at}
    number = weight((robot for *_, robot in robots), index.alike)
    names = _row(list(index.names(at)), index)
    return index.words("criterion.combines", elements=index.words.count(number, "element"), names=names)


def _subjects(index: Index) -> str:
    """Whom labels name: those of the closed list that the guidelines call vulnerable, then all others."""
    known = index.document.get("persons", ())
    vulnerable = {fit(word) for group in known if group["vulnerable"] for word in group["subjects"]}
    groups = {group for said in index.subjects.values() for group in said}
    said = {"criterion.vulnerable": groups & vulnerable, "criterion.subjects": groups - vulnerable}
    return "; ".join(index.words(key, names=_row(sorted(names), index)) for key, names in said.items() if names)


GENERAL = (  # what Article 35(7) asks for of the whole, 35(2), 35(9), 36, and who answers for it
    "purpose", "controller", "basis", "necessity", "risks", "measures", "residual", "advice", "views", "consultation",
    "name", "date", "signature",
)  # fmt: skip
RISK = ("likelihood", "severity", "whom", "measures", "residual", "decision")  # of one flow, 35(7)(c) and (d)
CRITERIA = 9
NOTHING: Mapping[str, str] = MappingProxyType({})


class AssessmentField(NamedTuple):
    """A field: its key in the file, what it asks, what was answered, and what label files state beside it."""

    key: str
    label: str
    text: str
    stated: str = ""

    @property
    def line(self) -> str:
        """What is stated, and the answer, on one line."""
        return "; ".join([*([self.stated] if self.stated else []), *self.text.splitlines()])


class Risk(NamedTuple):
    """The risks of one flow to the persons (Article 35(7)(c))."""

    flow: ToDecide
    fields: tuple[AssessmentField, ...]


class Assessment(NamedTuple):
    """All fields.

    Attributes
    ----------
    unlisted
        How many more flows there are, without fields: their paths are not told one by one.
    unmatched
        Answers to fields that this report does not have.
    file, sha256
        Where the answers come from; empty if none were given.
    """

    general: tuple[AssessmentField, ...]
    criteria: tuple[AssessmentField, ...]
    risks: tuple[Risk, ...]
    unlisted: int
    unmatched: tuple[AssessmentField, ...]
    file: str
    sha256: str


def assessment(
    words: Words, flows: Sequence[ToDecide], answers: Answers, stated: Mapping[str, str] = NOTHING
) -> Assessment:
    """Return the fields of a report, filled in as far as there are answers.

    Parameters
    ----------
    stated
        What label files say of a general field; it stands beside the answer and is not saved with it.

    Complexity: O(flows + answers).
    """
    used: set[str] = set()

    def field(key: str, label: str, additional: Iterable[str] = ()) -> AssessmentField:
        known = [name for name in (key, *additional) if name in answers.texts]
        used.update(known)
        text = "\n".join(dict.fromkeys(answers.texts[name] for name in known))
        return AssessmentField(key, words(label), text, stated.get(key.removeprefix("sign."), ""))

    def risk(flow: ToDecide) -> Risk:
        ids = dict.fromkeys(one for e in flow.entries for one in (e.pattern or e.id, e.id, *e.alike))
        first, *others = ids
        fields = (
            field(f"risk.{first}.{what}", f"risk.{what}", [f"risk.{other}.{what}" for other in others]) for what in RISK
        )
        return Risk(flow, tuple(fields))

    general = tuple(field(f"sign.{what}", f"sign.{what}") for what in GENERAL)
    criteria = tuple(field(f"criterion.{number}", f"criterion.{number}") for number in range(1, CRITERIA + 1))
    asked = flows if answers.texts else [flow for flow in flows if flow.entries[0].detailed]
    made = (risk(flow) for flow in asked)
    risks = tuple(one for one in made if one.flow.entries[0].detailed or any(field.text for field in one.fields))
    left = tuple(AssessmentField(key, fit(key), text) for key, text in answers.texts.items() if key not in used)
    return Assessment(general, criteria, risks, len(flows) - len(risks), left, fit(answers.file), answers.sha256)
