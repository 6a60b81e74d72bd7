"""What only a person can say, as fields to fill in: Article 35(7)(a) to (d), 35(2), 35(9), 36, and the nine criteria.

In: the flows of a report and the answers that were saved before. Out: ``Assessment``. A field is known by a key that
stays the same as long as the finding does; answers whose field is gone are kept and told.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

from rosprivacy.analysis.text import fit

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.page.assessment_file import Answers
    from rosprivacy.report.page.opening import ToDecide

GENERAL = (  # what Article 35(7) asks for of the whole, 35(2), 35(9), 36, and who answers for it
    "purpose", "controller", "basis", "necessity", "risks", "measures", "residual", "advice", "views", "consultation",
    "name", "date", "signature",
)  # fmt: skip
RISK = ("likelihood", "severity", "whom", "measures", "residual", "decision")  # of one flow, 35(7)(c) and (d)
CRITERIA = 9
NOTHING: Mapping[str, str] = MappingProxyType({})


@dataclass(frozen=True, slots=True)
class AssessmentField:
    """A field: its key in the file, what it asks, what was answered, and what label files state beside it."""

    key: str
    label: str
    text: str
    stated: str = ""

    @property
    def line(self) -> str:
        """What is stated, and the answer, on one line."""
        return "; ".join([*([self.stated] if self.stated else []), *self.text.splitlines()])


@dataclass(frozen=True, slots=True)
class Risk:
    """The risks of one flow to the persons (Article 35(7)(c))."""

    flow: ToDecide
    fields: tuple[AssessmentField, ...]


@dataclass(frozen=True, slots=True)
class Assessment:
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
