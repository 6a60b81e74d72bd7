"""The style sheet of the Neo4j Browser has the colours of pictures, for all that the graph can have."""

from __future__ import annotations

import re

from rosprivacy.ingest.neo4j_graph.ids import schema_names
from rosprivacy.ingest.neo4j_graph.schema import KIND_LABELS, NODES, RELATIONSHIPS
from rosprivacy.ontology.vocabulary import load
from rosprivacy.private_neo4j.browser_files import STYLE, browser_files
from rosprivacy.report.pictures.looks import KIND_LOOKS, ROLE_LOOKS

RULE = re.compile(r"(\S+) \{\n((?:  [a-z-]+: [^;\n]+;\n)+)\}\n")


def rules(labels: list[str], tops: list[str]) -> dict[str, dict[str, str]]:
    """As the Browser parses it: a selector and its properties; of two that fit, the later one holds."""
    text = str(browser_files(labels, tops)[STYLE])
    assert RULE.sub("", text) == ""
    found = {m[1]: dict(line.strip(" ;").split(": ", 1) for line in m[2].splitlines()) for m in RULE.finditer(text)}
    assert len(found) == len(RULE.findall(text))  # none twice
    return found


def test_every_kind_every_role_and_every_type_has_a_rule() -> None:
    categories = load().categories.values()
    labels = [category.label for category in categories]
    tops = [category.label for category in categories if not category.broader]
    found = rules(labels, tops)
    for kind, label in KIND_LABELS.items():
        assert (found[f"node.{label}"]["color"], found[f"node.{label}"]["caption"]) == (
            KIND_LOOKS[kind].colour,
            "'{name}'",
        )
    for role in ("source", "leak", "sanitizer"):
        assert tops
        assert {found[f"node.{top}{role.capitalize()}"]["border-color"] for top in tops} == {ROLE_LOOKS[role].colour}
    types = {selector.removeprefix("relationship.") for selector in found if selector.startswith("relationship.")}
    assert types == schema_names(labels)["relationship type"]
    assert {node.label for node in NODES} - {"Element"} <= {selector.removeprefix("node.") for selector in found}
    assert len(types) > len(RELATIONSHIPS)


def test_of_several_roles_the_one_that_pictures_show_holds() -> None:
    """A leak first, then a source, then who cleans: later rules hold."""
    order = [selector for selector in rules(["Video"], ["Video"]) if selector.startswith("node.Video")]
    assert order == ["node.VideoSanitizer", "node.VideoSource", "node.VideoLeak"]


def test_the_same_categories_give_the_same_bytes() -> None:
    """Rule S14."""
    assert browser_files(["A", "B"], ["B", "A"]) == browser_files(["B", "A"], ["A", "B"])
