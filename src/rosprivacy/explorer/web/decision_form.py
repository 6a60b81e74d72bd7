"""The form of a decision: what a person posted, and what an acceptance lacks before it is written.

In: a posted form, a document. Out: about which finding or row it decides, what, in which words; or the fields with what
is missing, to be asked again.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.legal import UNFOUNDED
from rosprivacy.explorer.deciding import How
from rosprivacy.explorer.web import forms
from rosprivacy.explorer.web.row_pane import ANSWER, FINDING, ROW, articles, row_of
from rosprivacy.ingest.decisions.decisions_file import REQUIRED
from rosprivacy.report.finding_facts import gaps_of
from rosprivacy.report.page.finding_entries import gap_in_words
from rosprivacy.report.page.index import Index
from rosprivacy.report.page.to_confirm import question_key, questions_of, unanswered

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from rosprivacy.explorer.web.forms import EditForm
    from rosprivacy.report.catalogs.words import Words

FIELDS = (*(how for how in How.__annotations__ if how != "answers"), "lacks", "whose", "about", "ground")
NO_FIELDS: Mapping[str, str] = MappingProxyType(dict.fromkeys(FIELDS, ""))


class PostedDecision(NamedTuple):
    """What a form decides.

    Attributes
    ----------
    finding
        Id of the finding in hand.
    choice
        A ``Choice``, or that a condition is met.
    row
        The row of the register in which it ends; None if there is none.
    whole
        Whether it is decided about the row.
    """

    finding: str
    choice: str
    how: How
    row: Mapping[str, Any] | None
    whole: bool

    @property
    def about(self) -> Sequence[str]:
        """Ids of the findings that it is about."""
        return self.row["findings"] if self.row and self.whole else [self.finding]


class AskedAgain(NamedTuple):
    """What an acceptance lacks, in sentences, and the form as a person filled it in."""

    notes: tuple[str, ...]
    fields: Mapping[str, str]


def posted_decision(form: EditForm, document: Mapping[str, Any], findings: Collection[str]) -> PostedDecision:
    """Return what a form decides about one of the findings, or about its row."""
    finding, choice, how = forms.decision_in(form, findings, articles())
    row = row_of(document, finding)
    whole = form.choice("about", ("", FINDING, *([ROW] if row else []))) == ROW
    how["answers"] = {
        str(code): text for code in (questions_of(row) if row else ()) if (text := form.words(ANSWER + code))
    }
    return PostedDecision(finding, choice, how, row, whole)


def asked_again(form: EditForm, posted: PostedDecision, document: Mapping[str, Any], words: Words) -> AskedAgain | None:
    """Return what an acceptance lacks: a ground, an end, an answer; None where a person has been told the same."""
    signed = REQUIRED.get(posted.choice)  # of an acceptance; without all of it, it is refused
    if not signed or not all(form.value(key) for key in signed):
        return None
    findings = [finding for finding in document["findings"] if finding["id"] in posted.about]
    gaps = [gap for gap in gaps_of(posted.how, findings) if gap.lack in UNFOUNDED]
    questions = unanswered(posted.row, posted.how["answers"])
    names = " ".join([*(gap.lack.name for gap in gaps), *questions])
    if names == form.value("lacks"):
        return None
    index = Index({**document, "findings": findings}, words)
    fields = {key: ",".join(form.several(key)) for key in FIELDS}
    fields |= {ANSWER + code: text for code, text in posted.how["answers"].items()} | {"lacks": names}
    return AskedAgain(
        (*(gap_in_words(gap, index) for gap in gaps), *(words(question_key(code)) for code in questions)), fields
    )
