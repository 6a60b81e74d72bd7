"""A finding -> a small picture for an HTML page: SVG with ids of its own, nothing external, fit for dark mode.

In: an ``Analysis`` and its findings. Out: one ``<svg>`` element each. The legend is the page's, once for all pictures.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import DrawingError
from rosprivacy.report.dot import dot
from rosprivacy.report.graphviz import Graphviz, Job, TooLongError
from rosprivacy.report.narrow import folded
from rosprivacy.report.svg import inline
from rosprivacy.report.views import PER_BOX, FindingViews, bounded

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import Analysis, Finding
    from rosprivacy.report.picture import Picture

MOST = 16  # boxes, unless the shortest way itself is longer
SECONDS = 5.0  # a picture; it takes a hundredth of one


def picture_of(analysis: Analysis, finding: Finding, *, most: int = MOST) -> str:
    """Return the picture of a finding, see ``pictures_of``."""
    return next(pictures_of(analysis, [finding], most=most))


def pictures_of(analysis: Analysis, findings: Iterable[Finding], *, most: int = MOST) -> Iterator[str]:
    """Return a picture of each finding, as an ``<svg>`` element for one HTML page.

    All ids begin with ``f``, the finding's id and ``-``; lines and text on the page have the colour of the page's text.
    What goes beyond ``most`` boxes is left out, and its description says so.

    Parameters
    ----------
    most
        Elements in a picture; the shortest way is there whatever its length.

    Raises
    ------
    DrawingError
        If Graphviz is not installed, or cannot draw even the shortest way.

    Notes
    -----
    All are drawn by one process, one after the other: linear in the findings.
    """
    views = FindingViews(analysis)
    with Graphviz() as graphviz:
        for finding in findings:
            picture = bounded(folded(views.of(finding, PER_BOX * most)), most)
            yield _drawn(graphviz, picture, f"f{finding.id}-")


def _drawn(graphviz: Graphviz, picture: Picture, prefix: str) -> str:
    for smaller in (picture, bounded(picture, 1)):
        try:
            return inline(graphviz.draw(Job(dot(smaller, legend=False)), SECONDS), smaller, prefix)
        except TooLongError:
            continue
    raise DrawingError(f"graph:0: the layout of {picture.title!r} takes too long; leave pictures out")
