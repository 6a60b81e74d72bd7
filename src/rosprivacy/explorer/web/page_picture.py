"""The picture of the page: a session as it stands and the view go in, out come SVG, a legend, and what is not drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.witness import Witness
from rosprivacy.explorer.element_ids import element_id
from rosprivacy.explorer.web.titles import titles_of
from rosprivacy.report.explorer.live_svg import Links
from rosprivacy.report.explorer.pictures import Pictures
from rosprivacy.report.pictures.phrases import Phrases

if TYPE_CHECKING:
    from rosprivacy.explorer.web.page import Page
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.explorer.pictures import Shown

NO_KIND = "-"  # all are switched off; none named would mean all
ROOM = (540.0, 560.0)  # of the page's pane on a common screen, in pixels


def pictures_of(vocabulary: Vocabulary, words: Words) -> Pictures:
    """Return what draws the pictures of one session, in the words of a language."""
    return Pictures(Phrases.told(words, titles_of(vocabulary, words)))


def drawn(pictures: Pictures, standing: Standing, page: Page) -> Shown:
    """Return the picture of a page, seen from the element in hand; of a finding, with its own path."""
    at = standing.elements[page.pane.id].identity if page.pane else None
    kinds = [switch.name for switch in page.switches if switch.on] or [NO_KIND]
    view = page.view._replace(find="")

    def address(key: tuple[str, str, str]) -> str:
        return view.to(element_id(key)).address

    links = Links(element_id, address)
    finding = standing.findings.get(view.finding)
    way = Witness(finding.witness, finding.steps) if finding else None
    return pictures.of(standing.analysis, at, kinds, links, ROOM, everything=view.whole, why=standing.why, way=way)
