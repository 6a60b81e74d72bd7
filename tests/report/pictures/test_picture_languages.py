"""Pictures in German and French: titles, notes, legend, boxes and tips have no English; English stays as it was."""

from __future__ import annotations

import html
import re
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.pictures import narrow, views
from rosprivacy.report.pictures.dot import dot, hover, line_hover
from rosprivacy.report.pictures.exports import mermaid
from rosprivacy.report.pictures.graphviz import alt_text
from rosprivacy.report.pictures.narrow import legible, represented
from rosprivacy.report.pictures.phrases import Phrases
from tests.helpers.languages import OTHERS, SYSTEMS, english_in
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.report.pictures.picture import Picture
    from rosprivacy.result import Result
    from tests.helpers.command import Cli


def phrases(result: Result, language: str) -> Phrases:
    kinds = result.vocabulary.categories
    titles = {name: category.text("title", language) for name, category in kinds.items()}
    return Phrases.of_report(Words(language), titles)


def pictures(result: Result, language: str) -> Iterator[Picture]:
    say = phrases(result, language)
    ros, privacy = (
        views.ros_view(result.analysis, words=say.words),
        views.privacy_view(PathsToLeaks(result.analysis), say=say),
    )
    yield from (ros, privacy, narrow.folded(ros), narrow.without_loose_ends(ros))
    yield from (legible(picture, 5)[0] for picture in (ros, privacy))
    yield from (views.bounded(privacy, most) for most in (1, 8))
    yield from (narrow.grouped(ros, by, result.analysis.graph.profiles) for by in ("enclave", "namespace", "robot"))
    yield narrow.carrying(ros, result.analysis)
    yield narrow.around(ros, [ros.boxes[0].names[0]], 1)
    for finding in result.analysis.findings:
        yield views.finding_view(PathsToLeaks(result.analysis), finding, 5, say)
    if result.fleet:
        yield narrow.of_robot(privacy, next(box.robot for box in privacy.boxes if box.robot))
        yield represented(
            views.privacy_view(PathsToLeaks(result.analysis), result.fleet.likeness.second, say), result.fleet.likeness
        )


def told(picture: Picture) -> str:
    tips = [hover(picture, box) for box in picture.boxes]
    tips += [line_hover(picture, line) for line in picture.lines]
    labels = re.findall(r'(?:label|tooltip)="((?:[^"\\]|\\.)*)"', dot(picture))
    seen = re.findall(r'"([^"]*)"|acc\w+: (.*)', mermaid(picture))
    texts = [picture.title, alt_text(picture), *picture.notes, *picture.ways, *tips]
    texts += [html.unescape(label.replace("\\n", " ")) for label in labels]
    texts += [html.unescape(re.sub(r"#(\d+);", lambda n: chr(int(n[1])), "".join(some))) for some in seen]
    return "\n".join(texts)


@pytest.mark.parametrize("language", OTHERS)
@pytest.mark.parametrize("system", SYSTEMS)
def test_no_picture_has_english(language: str, system: str) -> None:
    result = SYSTEMS[system]()
    names = {element.name for element in result.analysis.graph.elements}
    roles = {flow.role for flow in result.analysis.graph.flows}  # the words of policies
    for picture in pictures(result, language):
        text = told(picture)
        assert english_in(text, language, [*names, *roles, *result.vocabulary.categories]) == []
        assert "\\xa0" not in text
        assert "\\u202f" not in text


def test_the_command_draws_in_a_language(cli: Cli) -> None:
    folder = ROOT / "examples" / "care-home"
    files = [str(folder / "care-home.policy.xml"), "-l", str(folder / "care-home.labels.yaml")]
    done = cli("graph", *files, "--show", "privacy", "-f", "dot", "--lang", "fr")
    assert "Où ces données peuvent aller" in done.stdout
    assert "gabarit de visage" in done.stdout
