"""What a person has to confirm or to know beside what is to be decided: a question per row of the register, by weight.

In: an ``Index`` and the entries of a report. Out: ``RowQuestions``, in plain texts. A question stands once, with the
places that it is about and the kinds of data there, whether a finding speaks of them or not (rules S9, S12).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.legal import LegalQuestion, on_prohibited_practices, transfer_of
from rosprivacy.analysis.model import ARTICLE_10, GDPR_DENIED, GDPR_OPEN, SPECIAL
from rosprivacy.analysis.model.register_row import Cell, RowState
from rosprivacy.analysis.non_ros import ADEQUACY, ADEQUATE, DEROGATION, INSIDE, OCCASIONAL
from rosprivacy.report.catalogs.words import first_of, shown_of
from rosprivacy.report.finding_facts import REVEALS, in_order, scope_sentences
from rosprivacy.report.naming import text
from rosprivacy.report.page.index import kind_anchor

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.report.page.finding_entries import PathEntry
    from rosprivacy.report.page.index import Index

BOUND = 12  # places that page one has of each list; all of them stand in a section of their own
FEW = 4  # of what is said before the first decision
LINKS = 3  # entries that a place leads to
RESTS = "know.rests"
NO_SAFEGUARD = ("", "none", ADEQUACY, DEROGATION, OCCASIONAL)  # none of Articles 46 and 47
ON_A_CONTRACT = {"processor": LegalQuestion.PROCESSOR, "joint-controller": LegalQuestion.JOINT}  # Articles 28 and 26
# A ground answers these, and that it is missing is told.
OF_GROUNDS = (LegalQuestion.SPECIAL, LegalQuestion.SECRECY, LegalQuestion.CRIMINAL)

SCOPE = "scope"  # of a question about the whole system

Row = dict[str, Any]


class QuestionPlace(NamedTuple):
    """A place that a question is asked of.

    Attributes
    ----------
    place
        Its name; of data that leave nowhere, who brings them in or makes them.
    kinds
        (kind of data, its anchor), the heaviest first; none where it is asked about the recipient, whatever the data.
    remark
        What else is said of it.
    entries
        The paths of these kinds that end there.
    rows
        Ids of the rows of the register.
    """

    place: str
    kinds: tuple[tuple[str, str], ...]
    remark: str
    entries: tuple[PathEntry, ...]
    rows: tuple[str, ...]

    @property
    def links(self) -> tuple[tuple[PathEntry, ...], int]:
        """The paths that the place leads to, and how many there are beside them."""
        return first_of(self.entries, LINKS)


class RowQuestion(NamedTuple):
    """A question, or something to know, and of which places; of none where it is about the whole system."""

    key: str
    text: str
    places: tuple[QuestionPlace, ...] = ()


class RowQuestions(NamedTuple):
    """The lists, the heaviest row first.

    Attributes
    ----------
    foremost
        To be known before anything is decided: prohibited practices, data of Article 10.
    confirm, know
        To be confirmed, and to be known else.
    """

    foremost: tuple[RowQuestion, ...]
    confirm: tuple[RowQuestion, ...]
    know: tuple[RowQuestion, ...]

    @property
    def shown(self) -> RowQuestions:
        """What page one has of them."""
        return RowQuestions(_first(self.foremost, FEW), _first(self.confirm, BOUND), _first(self.know, BOUND))

    @property
    def remainder(self) -> tuple[int, ...]:
        """How many places it has not, of each."""
        return tuple(_places(every) - _places(some) for every, some in zip(self, self.shown, strict=True))


def row_questions(index: Index, entries: Iterable[PathEntry]) -> RowQuestions:
    """Return the lists.

    Complexity: O(rows of the register log rows + entries).
    """
    entries = list(entries)
    rows = _by_weight(index)
    by_id = {finding: entry for entry in entries for finding in (entry.id, *entry.alike)}
    to_confirm = ((question_key(asked), "", row) for row in rows for asked in questions_of(row))
    foremost = ((key, remark, row) for row in rows for key, remark in _foremost(row, index))
    resting = (
        (RESTS, index.words.row(map(index.words.duration, row["retention"])), row) for row in filter(_rests, rows)
    )
    return RowQuestions(
        foremost=tuple(_questions(foremost, by_id, index)),
        confirm=(*_scope(GDPR_OPEN, index), *_unfounded(entries, index), *_questions(to_confirm, by_id, index)),
        know=(*_questions(resting, by_id, index), *_scope(GDPR_DENIED, index)),
    )


def _by_weight(index: Index) -> list[Row]:
    """The rows, in the order in which findings stand."""
    weighed = [
        {
            **row,
            "leak": row["places"][0] if row["places"] else {"kind": ""},
            "law": index.categories.get(row["category"], {}).get("law", ()),
            "dismissed": row["state"] == RowState.DISMISSED,
            "accepted": row["state"] == RowState.ACCEPTED,
        }
        for row in index.register
    ]
    return [dict(row) for row in in_order(weighed, index.document)]


def question_key(code: str) -> str:
    """Return the key of the words of a question."""
    return f"confirm.{code}"


def questions_of(row: Mapping[str, Any]) -> Iterator[LegalQuestion]:
    """Yield the questions that a row of the register asks."""
    if row["area"] not in (INSIDE, ADEQUATE):
        stated = {row["transfer"], *map(transfer_of, row["safeguards"])}
        if stated.difference(NO_SAFEGUARD):
            yield LegalQuestion.ASSESSMENT
        elif DEROGATION in stated and OCCASIONAL not in stated:
            yield LegalQuestion.OCCASIONAL
    if Cell.CONTRACT in row["to_complete"]:
        yield ON_A_CONTRACT[row["recipient"]]
    if row["encrypted"] is False and row["article9"] in (*SPECIAL, *REVEALS):
        yield LegalQuestion.UNENCRYPTED
    if Cell.CRIMINAL_BASES in row["to_complete"]:
        yield LegalQuestion.CRIMINAL
    if Cell.SPECIAL_BASES in row["to_complete"]:
        yield LegalQuestion.SECRECY if row["special_bases"] else LegalQuestion.SPECIAL


def unanswered(row: Mapping[str, Any] | None, answers: Collection[str]) -> tuple[LegalQuestion, ...]:
    """Return the questions of a row that no code of an answer names, but for what a missing ground tells."""
    asked = questions_of(row) if row else ()
    return tuple(one for one in asked if one not in OF_GROUNDS and one not in answers)


def _foremost(row: Row, index: Index) -> Iterator[tuple[str, str]]:
    """What is to be known of a row before all else, and what is said of its place."""
    prohibited = [
        text(law, "provision", index.words.language)
        for law in index.looked_at
        if on_prohibited_practices(law["provision"]) and row["category"] in law["categories"]
    ]
    if prohibited:
        yield "know.prohibited", index.words.row(prohibited)
    if any(law["provision"] == ARTICLE_10 and law["verdict"] in SPECIAL for law in row["law"]):
        yield "know.criminal", ""


def _rests(row: Row) -> bool:
    """Whether the kind is kept for a stated time, and nothing waits for a decision about that."""
    return bool(row["retention"]) and row["state"] != RowState.OPEN


def _questions(
    rows: Iterable[tuple[str, str, Row]], entries: Mapping[str, PathEntry], index: Index
) -> Iterator[RowQuestion]:
    """Each question once, each place once in it, in the order of the first row of each."""
    by_key: dict[str, dict[tuple[str, str], list[Row]]] = {}
    for key, remark, row in rows:
        elements = row["places"] or [made["element"] for made in row["derivations"]] or row["sources"]
        place = index.words.row(index.names(elements))
        by_key.setdefault(key, {}).setdefault((place, remark), []).append(row)
    for key, places in by_key.items():
        yield RowQuestion(
            key,
            index.words(key),
            tuple(_place(key, name, remark, held, entries, index) for (name, remark), held in places.items()),
        )


def _place(
    key: str, name: str, remark: str, rows: Sequence[Row], entries: Mapping[str, PathEntry], index: Index
) -> QuestionPlace:
    ids = tuple(row["id"] for row in rows)
    if key in map(question_key, ON_A_CONTRACT.values()):  # it is the same for all kinds of data
        return QuestionPlace(name, (), remark, (), ids)
    kinds = {
        kind_anchor(row["category"]): index.data(row["category"], pseudonymised=row["pseudonymised"]) for row in rows
    }
    ends = [entries[finding] for row in rows for finding in row["findings"] if finding in entries]
    distinct = {entry.number: entry for entry in ends}
    return QuestionPlace(
        place=name,
        kinds=tuple((data, at) for at, data in kinds.items()),
        remark=remark,
        entries=tuple(distinct[number] for number in sorted(distinct)),
        rows=ids,
    )


def _unfounded(entries: Iterable[PathEntry], index: Index) -> Iterator[RowQuestion]:
    """Acceptances that lack a ground or an end, or that were made about something else: data go there all the same."""
    rows = {finding: row["id"] for row in index.register for finding in row["findings"]}
    places = [
        QuestionPlace(
            place=entry.leak,
            kinds=((entry.data, kind_anchor(entry.category)),),
            remark=" ".join(lacks),
            entries=(entry,),
            rows=tuple(rows[finding] for finding in (entry.id,) if finding in rows),
        )
        for entry in entries
        if entry.state == "accepted" and entry.decision and (lacks := entry.decision.flags)
    ]
    if places:
        yield RowQuestion("confirm.accepted", index.words("confirm.accepted"), tuple(places))


def _scope(scope: str, index: Index) -> Iterator[RowQuestion]:
    """Whether the GDPR applies outside the EEA: asked, or denied."""
    places = [place for place in index.document.get("surroundings", ()) if place.get("gdpr") == scope]
    yield from (RowQuestion(SCOPE, said) for said in scope_sentences({"surroundings": places}, index.words))


def _places(questions: Iterable[RowQuestion]) -> int:
    return sum(len(question.places) for question in questions)


def _first(questions: Iterable[RowQuestion], bound: int) -> tuple[RowQuestion, ...]:
    """The first of them, each with the places that there is room for."""
    questions = tuple(questions)
    bound = shown_of(_places(questions), bound)
    first: list[RowQuestion] = []
    for question in questions:
        places = question.places[: max(bound - _places(first), 0)]
        if places or not question.places:
            first.append(question._replace(places=places))
    return tuple(first)
