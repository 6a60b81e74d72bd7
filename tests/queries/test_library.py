"""Headers of the query pack: each fault is found, and parameters are read by the types that a header declares."""

from __future__ import annotations

import pytest

from rosprivacy.analysis.errors import QueryError
from rosprivacy.queries.library import Query, find, pack, parse

GOOD = """\
// name: x
// kind: table
// description: What is there?
// param robot: string, a name
// param least: integer, a number, default 2
// param all: boolean, whether, default false
// param kinds: list of string, some, default ["A"]
// returns name: string, its name
// order: name
MATCH (n:Element {robot: $robot})
WHERE n.rank >= $least AND ($all OR n.kind IN $kinds)
RETURN n.name AS name
ORDER BY name
"""


@pytest.fixture
def query() -> Query:
    return parse("x", GOOD)


def test_the_pack_is_sorted_by_name() -> None:
    assert list(pack()) == sorted(pack())


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("name: x", "name: y", "name is 'y'"),
        ("kind: table", "kind: chart", "kind is 'chart'"),
        ("// order: name\n", "", "order is missing"),
        ("// kind: table\n", "// kind: table\n// kind: table\n", "kind stands twice"),
        ("// param robot: string, a name\n", "", r"\$robot is not declared"),
        ("{robot: $robot}", "{robot: 'r'}", r"\$robot is not used"),
        ("// param robot: string, a name\n", "// param robot: string, a name\n" * 2, "robot stands twice"),
        ("n.name AS name", "n.name AS other", "RETURN gives other, the header says name"),
        ("ORDER BY name", "LIMIT 3", "stable order"),
        ("order: name", "order: other", "order names what is not a column"),
        ("RETURN n.name", "SET n.x = 1 RETURN n.name", "SET writes"),
        ("RETURN n.name", "detach delete n RETURN n.name", "delete writes"),
        ("returns name: string,", "returns name: text,", "the type is one of"),
        ("default 2", "default two", "the default is no integer"),
        ("default false", 'default "false"', "the default is no boolean"),
        ("// order", "// odd", "not a line of a header"),
    ],
)
def test_each_fault_is_found(old: str, new: str, message: str) -> None:
    assert old in GOOD
    with pytest.raises(QueryError, match=message):
        parse("x", GOOD.replace(old, new))


def test_what_only_looks_like_a_write_is_none() -> None:
    text = GOOD.replace("RETURN n.name", "WITH n WHERE n.name <> 'SET' // CREATE nothing\nRETURN n.name")
    assert parse("x", text).name == "x"


class TestParameters:
    def test_defaults_and_values(self, query: Query) -> None:
        assert query.values({"robot": "r"}) == {"robot": "r", "least": 2, "all": False, "kinds": ["A"]}
        given = {"robot": "", "least": "-3", "all": "true", "kinds": "A,B"}
        assert query.values(given) == {"robot": "", "least": -3, "all": True, "kinds": ["A", "B"]}

    @pytest.mark.parametrize(
        ("given", "message"),
        [
            ({}, "robot is missing; write robot=…, a name"),
            ({"robot": "r", "robt": "r"}, "unknown parameter 'robt'; did you mean 'robot'"),
            ({"robot": "r", "least": "few"}, "'few' is not of the type integer"),
            ({"robot": "r", "least": str(2**63)}, "is not of the type integer"),
            ({"robot": "r", "all": "True"}, "'True' is not of the type boolean"),
            ({"robot": "\udcff"}, "is not of the type string"),
        ],
    )
    def test_each_fault_is_said(self, query: Query, given: dict[str, str], message: str) -> None:
        with pytest.raises(QueryError, match=message):
            query.values(given)

    def test_all_faults_are_said_at_once(self, query: Query) -> None:
        with pytest.raises(QueryError) as caught:
            query.values({"least": "few", "all": "maybe"})
        assert len(str(caught.value).splitlines()) == 3


def test_an_unknown_query_names_the_nearest() -> None:
    with pytest.raises(QueryError, match="did you mean leak-paths"):
        find("leak-path")
