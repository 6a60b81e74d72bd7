"""The page as HTML: a ``Page`` goes in with words and a picture, out comes text. Jinja2 escapes every value."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, NamedTuple

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from rosprivacy.explorer.web.forms import METHODS
from rosprivacy.explorer.web.view import ALL
from rosprivacy.report.page.html import in_html

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.explorer.remembering import Unsaved
    from rosprivacy.explorer.web.beside import Beside
    from rosprivacy.explorer.web.page import Page
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.explorer.pictures import Shown


class Message(NamedTuple):
    """What a person is told above the page.

    Attributes
    ----------
    kind
        ``done`` or ``problem``.
    more
        Further lines in the reader's language.
    detail
        What readers of files and forms say, in English.
    diff
        What somebody else changed in the file.
    """

    kind: str
    text: str
    more: tuple[str, ...] = ()
    detail: tuple[str, ...] = ()
    diff: str = ""


def rendered(
    page: Page, words: Words, picture: Shown, beside: Beside, *, message: Message | None = None,
    left: Unsaved | None = None, remarks: Sequence[str] = (), inputs: str = "", by: str = "",
    read_only: bool = False, asks: bool = False,
) -> str:  # fmt: skip
    """Return the page.

    Parameters
    ----------
    left, remarks
        Of the session: what an earlier one left, and what a person has to know.
    inputs
        That files are not what was read; empty if all are.
    by
        Who gave the last answer.
    asks
        Whether there is a database that can be asked.
    """
    view = page.view
    after = view.to("")._replace(find="").address  # after an answer, the next question is looked at
    return _templates().get_template("page.html.j2").render(
        p=page,
        t=in_html(words),
        message=message,
        left=left,
        remarks=remarks,
        inputs=inputs,
        kept=[
            *(("hide", kind) for kind in view.hidden),
            *([("draw", ALL)] if view.whole else []),
            *([("trial", view.trial)] if view.trial else []),
        ],
        x=beside,
        other_picture=view._replace(whole=not view.whole).address,
        kept_query=after[1:],
        methods=METHODS,
        picture=picture,
        svg=Markup(picture.svg),  # noqa: S704 - made by the program, names in it are escaped
        by=by,
        read_only=read_only,
        asks=asks,
        fixed=read_only or bool(view.trial),
    )  # fmt: skip


@cache
def _templates() -> Environment:
    loader = PackageLoader("rosprivacy.explorer.web")
    return Environment(loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
