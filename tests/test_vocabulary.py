"""Categories: the shipped ontology, names that find one, the hierarchy, and a cache that may vanish or rot."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from rdflib import RDF, SKOS, Graph

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.hierarchy import Hierarchy
from rosprivacy.analysis.model import Category
from rosprivacy.ontology import vocabulary
from rosprivacy.ontology.vocabulary import load, parse

PREFIXES = "@prefix rp: <urn:x-rosprivacy:> . @prefix skos: <http://www.w3.org/2004/02/skos/core#> .\n"
ONE = 'rp:A a skos:Concept ; rp:label "A" ; skos:prefLabel "a"@en ; skos:definition "An a."@en .\n'


def test_the_shipped_categories() -> None:
    found = load()
    assert set(found.categories) >= {
        "PersonalData", "Biometric", "FaceTemplate", "FaceImage", "Video", "Voice", "Location", "PersonTrack", "Health",
    }  # fmt: skip
    for category in found.categories.values():
        assert category.iri.startswith("urn:x-rosprivacy:")
        assert re.fullmatch(r"[A-Z][A-Za-z]+", category.label)
        assert category.definition.endswith(".")
        assert "PersonalData" in found.hierarchy.ancestors[category.name]
    assert len({c.label for c in found.categories.values()}) == len(found.categories)


def test_every_foreign_iri_is_one_of_dpv(corpus: Path) -> None:
    """DPV 2.3; the files stay where they are."""
    dpv = Graph()
    for file in ("pd.ttl", "dpv.ttl"):
        dpv.parse(corpus.parent / "dpv" / file)
    ours = Graph().parse(Path(vocabulary.__file__).with_name("categories.ttl"))
    named = {o for p in (SKOS.broader, SKOS.exactMatch) for o in ours.objects(None, p)}
    foreign = {iri for iri in named if "w3id.org" in str(iri)}
    assert foreign
    assert all((iri, RDF.type, None) in dpv for iri in foreign)


@pytest.mark.parametrize(
    "text",
    ["FaceTemplate", "facetemplate", "face template", "Face Embedding", "urn:x-rosprivacy:FaceTemplate"],
)
def test_a_category_is_found_by_name_title_synonym_and_iri(text: str) -> None:
    category = load().find(text)
    assert category is not None
    assert category.name == "FaceTemplate"


def test_one_that_is_not_there_is_not_found_but_its_neighbours_are() -> None:
    assert load().find("Vidoe") is None
    assert load().nearest("Vidoe")[0] == "Video"
    assert len(load().nearest("qqqqqq")) == len(load().categories)


def test_the_hierarchy_is_closed_with_the_least_distance() -> None:
    rows = {"A": (), "B": ("A",), "C": ("B",), "D": ("C", "A"), "E": ("elsewhere",)}
    closed = Hierarchy.of(Category(n, n, n, n, n, up) for n, up in rows.items())
    assert closed.ancestors["D"] == {"D": 0, "C": 1, "A": 1, "B": 2}
    assert closed.distance("C", "A") == 2
    assert closed.distance("A", "C") is None
    assert closed.broader("D") == ["A", "C", "B"]
    assert closed.narrowest({"A", "C", "E"}) == ("C", "E")


@pytest.mark.parametrize(
    ("turtle", "problem"),
    [
        ("rp:A a skos:Concept", "not Turtle"),
        (ONE.replace('rp:label "A" ; ', ""), "no label that is an identifier"),
        (ONE.replace('"A"', '"A b"'), "no label that is an identifier"),
        (ONE.replace('skos:prefLabel "a"@en ; ', ""), "has no title"),
        (ONE.replace("@en ; skos:def", "@de ; skos:def"), "has no title"),
        (ONE + ONE.replace("rp:A", "rp:B"), "names both"),
    ],
)
def test_an_ontology_that_breaks_a_rule_is_refused_by_name(turtle: str, problem: str) -> None:
    with pytest.raises(InputErrors, match=problem) as caught:
        parse(PREFIXES + turtle, "mine.ttl")
    assert re.match(r"mine\.ttl:\d+: .+; .+", str(caught.value))


class TestCache:
    def test_it_gives_what_was_read(self, tmp_path: Path) -> None:
        first, second = load(tmp_path), load(tmp_path)
        assert first == second
        assert len(list(tmp_path.iterdir())) == 1

    @pytest.mark.parametrize("damage", ["", "{", "[]", '{"key": 1}', "swap"])
    def test_a_damaged_one_is_not_trusted(self, tmp_path: Path, damage: str) -> None:
        whole = load(tmp_path)
        (file,) = tmp_path.iterdir()
        text = file.read_text().replace("FaceTemplate", "Facetemplate") if damage == "swap" else damage
        file.write_text(text)
        assert load(tmp_path) == whole
        assert json.loads(file.read_text())["digest"]  # and written anew

    def test_a_folder_that_cannot_be_written_is_no_error(self, tmp_path: Path) -> None:
        (tmp_path / "file").write_text("")
        assert load(tmp_path / "file" / "below").categories
