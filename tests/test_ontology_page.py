"""The page of the ontology: all terms, each with an anchor, all that the Turtle says of them, and always the same."""

from __future__ import annotations

import os
import re
import runpy
import subprocess
import sys
from html import unescape

import pytest
from rdflib import Graph, Literal

from tests.helpers.paths import ROOT

PROGRAM = ROOT / "docs" / "ontology_page.py"
MADE = runpy.run_path(str(PROGRAM))
RP = str(MADE["RP"])


@pytest.fixture(scope="module")
def page() -> str:
    return str(MADE["ontology_page"]())


@pytest.fixture(scope="module")
def graph() -> Graph:
    together = Graph()
    for file in MADE["FILES"]:
        together.parse(ROOT / "ontology" / file)
    return together


def test_every_term_has_an_anchor_and_no_two_the_same(page: str, graph: Graph) -> None:
    anchors = re.findall(r'id="([^"]+)"', page)
    assert len(anchors) == len(set(anchors))
    named = {str(term).removeprefix(RP) for triple in graph for term in triple if str(term).startswith(RP)}
    assert len(named) > 300
    assert sorted(named - set(anchors)) == []


def test_the_words_of_exported_files_have_anchors(page: str) -> None:
    told = (ROOT / "docs" / "linked-data.md").read_text("utf-8").split("## Our own words")[1]
    words = set(re.findall(r"`rp:(\w+)`", told))
    assert {"Finding", "Hop", "concerns"} <= words
    assert [word for word in sorted(words) if f'id="{word}"' not in page] == []


def test_every_link_within_the_page_leads_to_an_anchor(page: str) -> None:
    links = set(re.findall(r'href="#([^"]+)"', page))
    assert links <= set(re.findall(r'id="([^"]+)"', page))


def test_everything_that_the_files_say_is_there(page: str, graph: Graph) -> None:
    """Every text in every language, every number and date, every IRI of others."""
    shown = unescape(page)
    for value in set(graph.objects()):
        if isinstance(value, Literal):
            text = f'<span lang="{value.language}">{value}</span>' if value.language else str(value)
            assert text in shown, value


def test_a_kind_of_data_is_told_in_full(page: str) -> None:
    (video,) = re.findall(r'<section>\n<h3 id="Video">.*?</section>', page, re.DOTALL)
    for part in (
        "video of persons", "Video von Personen", "vidéo de personnes", "Moving pictures in which persons can be seen.",
        '<a href="#PersonImage">image of persons</a>', '<a href="https://w3id.org/dpv/pd#Picture">pd:Picture</a>',
        "physical", '<a href="#GDPR-9-1">GDPR Art. 9(1)</a>', "may-reveal", "when it is processed to deduce data",
        '<a href="#EDPB-3-2019-par-63">EDPB Guidelines 3/2019 par. 63</a>',
    ):  # fmt: skip
        assert part in video, part
    (image,) = re.findall(r'<section>\n<h3 id="PersonImage">.*?</section>', page, re.DOTALL)
    assert '<th scope="row">narrower</th>' in image
    assert '<a href="#Video">video of persons</a>' in image


def test_a_provision_has_its_address_and_what_it_is_said_of(page: str) -> None:
    (biometric,) = re.findall(r'<section>\n<h3 id="GDPR-9-1-biometric">.*?</section>', page, re.DOTALL)
    assert 'href="https://eur-lex.europa.eu/eli/reg/2016/679/art_9/par_1/oj"' in biometric
    assert '<a href="#FaceTemplate">' in biometric


@pytest.mark.slow
def test_the_same_files_give_the_same_page(page: str) -> None:
    for seed in ("1", "2"):
        program = f"import runpy; print(runpy.run_path({str(PROGRAM)!r})['ontology_page'](), end='')"
        environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONUTF8": "1"}
        done = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, check=True)
        assert done.stdout.decode("utf-8") == page


def test_another_file_gives_another_page() -> None:
    ours = f"@prefix rp: <{RP}> . @prefix skos: <http://www.w3.org/2004/02/skos/core#> .\n"
    badge = 'rp:Badge a skos:Concept ; skos:prefLabel "<badge>"@en ; skos:broader rp:Card .\nrp:Card a skos:Concept .'
    made = MADE["page"]([ours + badge], "## Our own words\n\n")
    assert '<h3 id="Badge">&lt;badge&gt; <code>Badge</code>' in made
    assert '<tr><th scope="row">narrower</th><td><a href="#Badge">&lt;badge&gt;</a>' in made
