"""A summary on one page for works councils: whose data, where they can get to, how long kept, which measures.

In: an ``Outline``. Out: HTML without a script. Which groups of persons are employees the program cannot know: it lists
all that labels name, and those of which nothing is stated.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from markupsafe import Markup

from rosprivacy.report.page.html import environment_of, hashed, in_html

if TYPE_CHECKING:
    from rosprivacy.report.page.outline import Outline

DECIDED = "measures"  # the field of the assessment that tells what was decided


def works_council(report: Outline) -> str:
    """Return the page.

    Notes
    -----
    It tells what the report tells and nothing else: its rows are those of the rights of the persons and of what is
    cleaned. Complexity: O(their size).
    """
    environment, css, _ = environment_of(report.words.language)
    there = {place.data for group in report.rights for place in group.places}
    kinds = [kind for kind in report.kinds if any(kind.title in data for data in there)]
    measures = [field.line for field in report.assessment.general if field.key == f"sign.{DECIDED}" and field.line]
    page = environment.get_template("works_council.html.j2").render(
        r=report,
        t=in_html(report.words),
        policy=f"default-src 'none'; style-src '{hashed(css)}'; img-src data:; base-uri 'none'; form-action 'none'",
        css=Markup(css),  # noqa: S704 - our own file
        kinds=kinds,
        measures=measures,
    )
    return page.strip() + "\n"
