"""What is asked of the database: a posted form, or the address of the page, in; out comes a question, not yet asked.

The text of a query comes in a form only, never in an address. A question of the pack is named from a closed list; its
address can name an element or a finding of the session, whose names then stand in the fields, and nothing is asked.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.explorer.web.forms import Form, FormError
from rosprivacy.queries.library import Query, pack
from rosprivacy.queries.saved import written_out

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element

LONGEST_TEXT = 20_000  # letters
FIELD = "p-"  # begins the names of the fields of parameters
ASK, EDIT = "ask", "edit"
OF_ELEMENT = ("element", "source", "leak", "from")  # parameters that are an element's name


class Asked(NamedTuple):
    """A question.

    Attributes
    ----------
    query
        Of the pack; None for Cypher of a person's own.
    given
        Values of its parameters, as they were typed.
    text
        What stands in the text area.
    at
        Id of the element that was in hand before; empty for none.
    """

    query: Query | None = None
    given: Mapping[str, str] = {}
    text: str = ""
    at: str = ""

    @property
    def cypher(self) -> str:
        """What is to be run."""
        return self.query.text if self.query else self.text

    def values(self) -> dict[str, Any]:
        """Return the values of its parameters; what was left empty has its default.

        Raises
        ------
        QueryError
            With every one that is missing, or not of its type.
        """
        return self.query.values({name: text for name, text in self.given.items() if text}) if self.query else {}

    def to_edit(self) -> Asked:
        """Return the same as Cypher in the text area, with the values that were typed and the defaults in it."""
        if not self.query:
            return self
        typed = {name: text for name, text in self.given.items() if text}
        needed = (field.name for field in self.query.parameters if field.default is None)
        missing = {name: "" for name in needed if name not in typed}
        values = self.query.values({**missing, **typed})
        known = {name: value for name, value in values.items() if name not in missing}
        return Asked(text=written_out(self.query, known), at=self.at)


def asked_in(form: Form) -> tuple[Asked, str]:
    """Return what a form asks, and whether it is to be asked or to be edited.

    Raises
    ------
    FormError
        If it asks nothing, or something that is not there.
    """
    do = form.choice("do", (ASK, EDIT)) if form.one("do") else ASK
    name, at = form.one("ask"), form.one("at")
    if name:
        if name not in pack():
            raise FormError("There is no such question; choose one of the list.")
        query = pack()[name]
        return Asked(query, {field.name: form.one(FIELD + field.name) for field in query.parameters}, at=at), do
    text = form.one("text").replace("\r\n", "\n")
    if len(text) > LONGEST_TEXT:
        raise FormError(f"The text has at most {LONGEST_TEXT:,} letters; use rosprivacy query --file for a longer one.")
    if not text.strip():
        raise FormError("There is nothing to ask: choose a question, or write one.")
    return Asked(text=text, at=at), do


def prefilled(query: Query, element: Element | None, finding: Finding | None) -> dict[str, str]:
    """Return values of parameters for what a person came from.

    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.queries.library import find
    >>> prefilled(find("sources-of-element"), Element("node", "/planner", "r1"), None)
    {'element': '/planner', 'robot': 'r1'}
    """
    known: dict[str, str] = {}
    if element:
        known |= {**dict.fromkeys(OF_ELEMENT, element.name), "robot": element.robot}
    if finding:
        known |= {"category": finding.category, "source": finding.source.name, "leak": finding.leak.name}
        known["robot"] = finding.source.robot
    return {field.name: known[field.name] for field in query.parameters if field.name in known}
