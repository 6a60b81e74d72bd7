"""Posted forms: bytes from a browser go in, out comes what is asked, from closed lists, or one plain sentence.

Nothing of a form is ever a name of a file. An element is named by its id (``edits.py``), a kind of data by a name
that the vocabulary has. Forms are read with the standard library: they have text fields only, no files.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple
from urllib.parse import parse_qsl

from rosprivacy.analysis.decisions import Choice
from rosprivacy.analysis.model import Method
from rosprivacy.analysis.text import printable
from rosprivacy.ingest.decisions.decision_log import CONFIRM

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from rosprivacy.analysis.model import Element
    from rosprivacy.explorer.deciding import How

MOST_FIELDS = 1_000
LONGEST = {
    "note": 500,
    "reason": 500,
    "condition": 500,
    "by": 100,
    "owner": 100,
    "ticket": 200,
    "legal_basis": 200,
    "expires": 10,
    "name": 60,
    "answer": 300,  # to a question of a row
}
EVERY = "*"  # in the place of kinds of data
SOURCE, LEAK, SANITIZER, CONDUIT = "source", "leak", "sanitizer", "conduit"
DERIVES, ABSENT, MUNDANE, SENSITIVE, NOTHING = "derives", "absent", "mundane", "sensitive", "nothing"
OF_NODES = (SOURCE, LEAK, SANITIZER, CONDUIT, DERIVES, ABSENT, NOTHING)
OF_CHANNELS = (MUNDANE, SENSITIVE, NOTHING)
OF_OTHERS = (SOURCE, LEAK, SANITIZER, CONDUIT, DERIVES, NOTHING)  # outside ROS
METHODS = tuple(method.value for method in (Method.ANONYMISE, Method.PSEUDONYMISE, Method.AGGREGATE, Method.DROP))


class FormError(Exception):
    """What is wrong with a form: a sentence for a person, and of what it speaks."""


class FormAnswer(NamedTuple):
    """What a person says of one element.

    Attributes
    ----------
    role
        One of ``roles_of`` the element; ``NOTHING`` takes the label away.
    kinds
        Kinds of data that it is about; empty for every kind.
    method
        Of a sanitizer.
    to
        Of a derivation: the kind that is made.
    note, by
        Why, and who says so; empty where nothing is said.
    """

    element: Element
    role: str
    kinds: tuple[str, ...] = ()
    method: str = ""
    to: str = ""
    note: str = ""
    by: str = ""


def roles_of(element: Element) -> tuple[str, ...]:
    """Return what can be said of an element."""
    return OF_NODES if element.is_node else OF_CHANNELS if element.is_channel else OF_OTHERS


class EditForm:
    """The fields of a form."""

    def __init__(self, body: bytes) -> None:
        try:
            fields = parse_qsl(
                body.decode("ascii"), keep_blank_values=True, strict_parsing=bool(body), errors="strict",
                max_num_fields=MOST_FIELDS,
            )  # fmt: skip
        except ValueError:
            raise FormError("The form cannot be read.") from None
        self._fields: dict[str, list[str]] = {}
        for name, value in fields:
            self._fields.setdefault(name, []).append(value)

    def value(self, name: str) -> str:
        """Return the value of a field; empty if it is not there."""
        values = self._fields.get(name, [""])
        if len(values) != 1:
            raise FormError(f"The form says {name} several times.")
        return values[0]

    def several(self, name: str) -> tuple[str, ...]:
        """Return all values of a field, each once."""
        return tuple(dict.fromkeys(self._fields.get(name, ())))

    def choice(self, name: str, allowed: Collection[str]) -> str:
        """Return a value that is one of some."""
        value = self.value(name)
        if value not in allowed:
            raise FormError(f"The form has no {name} that can be chosen here.")
        return value

    def number(self, name: str) -> int:
        """Return a number, of at most nine digits."""
        value = self.value(name)
        if not (value.isascii() and value.isdigit() and len(value) < 10):  # noqa: PLR2004 - digits
            raise FormError(f"The form has no {name}.")
        return int(value)

    def words(self, name: str) -> str:
        """Return a text of one line; fields are as long as the first word of their name says."""
        value, most = " ".join(self.value(name).split()), LONGEST[name.partition("-")[0]]
        if len(value) > most:
            raise FormError(f"The field {name} has at most {most} letters.")
        if printable(value) != value:
            raise FormError(f"The field {name} has signs that cannot be printed.")
        return value


def answer_in(form: EditForm, elements: Mapping[str, Element], kinds: Collection[str]) -> FormAnswer:
    """Return what a form says of an element.

    Parameters
    ----------
    elements
        Those of the current version, by id.
    kinds
        Names of all kinds of data.
    """
    element = element_in(form, elements)
    role = form.choice("role", roles_of(element))
    answer = FormAnswer(element, role, note=form.words("note"), by=form.words("by"))
    if role == NOTHING:
        return answer
    if role == ABSENT:
        reason = form.words("reason")
        if not reason:
            raise FormError("Say why it is not on the robot.")
        return answer._replace(note=reason)
    about = () if role == SOURCE else _about(form, kinds, may_be_every=role in (CONDUIT, SENSITIVE, MUNDANE))
    return with_details(answer, form, kinds, about)


def element_in(form: EditForm, elements: Mapping[str, Element]) -> Element:
    """Return the element that a form names."""
    at = form.value("element")
    if at not in elements:
        raise FormError("There is no such element any more; choose another one.")
    return elements[at]


def with_details(answer: FormAnswer, form: EditForm, kinds: Collection[str], about: tuple[str, ...]) -> FormAnswer:
    """Return an answer with what its role asks for: the kind that comes in, the method, the kind that is made."""
    if answer.role == SOURCE:
        return answer._replace(kinds=(form.choice("brings", kinds),))
    answer = answer._replace(kinds=about)
    if answer.role == SANITIZER:
        return answer._replace(method=form.choice("method", METHODS))
    return answer._replace(to=form.choice("makes", kinds)) if answer.role == DERIVES else answer


def _about(form: EditForm, kinds: Collection[str], *, may_be_every: bool) -> tuple[str, ...]:
    """The kinds of data that an answer is about; empty for every kind."""
    about = form.several("about")
    if EVERY in about and may_be_every:
        return ()
    about = tuple(kind for kind in about if kind not in ("", EVERY))
    if not about:
        raise FormError("Choose the kinds of data that the answer is about.")
    if not set(about).issubset(kinds):
        raise FormError("The form names a kind of data that is not known.")
    return about


def decision_in(form: EditForm, findings: Collection[str], grounds: Collection[str] = ()) -> tuple[str, str, How]:
    """Return about which of the findings a form decides, what, and its words.

    Where it is written is no matter of the form: that is the file which the command named.

    Parameters
    ----------
    grounds
        Legal bases that can be ticked, as ``6(1)(f)``.

    Examples
    --------
    >>> form = EditForm(b"finding=00112233445566ff&choice=accept&owner=A.+Lee&ground=6(1)(f)&legal_basis=9(2)(h),+9(3)")
    >>> decision_in(form, ["00112233445566ff"], ["6(1)(f)"])[2]["legal_basis"]
    ('6(1)(f)', '9(2)(h)', '9(3)')
    """
    ticked = form.several("ground")
    if not set(ticked) <= set(grounds):
        raise FormError("The form has no ground that can be chosen here.")
    further = (base.strip() for base in re.split("[,;]", form.words("legal_basis")))
    bases = tuple(dict.fromkeys([*ticked, *filter(None, further)]))
    how: How = {
        "reason": form.words("reason"),
        "condition": form.words("condition"),
        "owner": form.words("owner"),
        "expires": form.words("expires"),
        "ticket": form.words("ticket"),
        "legal_basis": bases,
    }
    return form.choice("finding", findings), form.choice("choice", [*Choice, CONFIRM]), how
