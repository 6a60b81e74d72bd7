"""The query pack: ``.cypher`` files with a header that says what is asked, with which parameters, and what comes back.

In: the files of this folder. Out: ``Query``, checked on reading. The header stands in comments, so that a file can be
pasted into the Neo4j Browser as it is.

    // name: the file's stem
    // kind: path, table or count
    // description: the question, in one sentence
    // param NAME: TYPE, meaning          (with ', default VALUE' at the end if it may be left out)
    // returns COLUMN: TYPE, meaning      (one for each, in the order of RETURN)
    // order: columns of the final ORDER BY
"""

from __future__ import annotations

import json
import re
from contextlib import suppress
from dataclasses import dataclass
from importlib.resources import files
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import QueryError, shown
from rosprivacy.analysis.written_names import FEW, did_you_mean, nearest
from rosprivacy.queries.graph_values import Path

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

KINDS = ("path", "table", "count")
KEYS = ("name", "kind", "description", "order")
VALUE_TYPES = {"string": str, "integer": int, "boolean": bool, "list of string": list}
COLUMN_TYPES = {**VALUE_TYPES, "graph path": Path}
# Of parameters: a name that must be in the database, with where it stands there (rule S11: never silence).
NAMES = {
    "category": ("(n:DataCategory)", "n.name"),
    "robot": ("(n:Robot)", "n.name"),
    "element": ("(n:Element)", "n.name"),
    "data type": ("(n:DataCategory) UNWIND n.data_types AS name WITH name", "name"),
    "identity factor": ("(n:DataCategory) UNWIND n.identity_factors AS name WITH name", "name"),
    "article": (  # of 'GDPR Art. 9(1) health': 9 and 9(1)
        (
            "(n:LegalProvision)<-[:FALLS_UNDER]-() WHERE n.name STARTS WITH 'GDPR Art. ' "
            "WITH split(n.name, ' ')[2] AS whole UNWIND [whole, split(whole, '(')[0]] AS name WITH name"
        ),
        "name",
    ),
}
TYPES = {**VALUE_TYPES, **dict.fromkeys(NAMES, str)}
LARGEST = 2**63 - 1  # integers of Cypher have 64 bits
_LINE = re.compile(r"// (?:(name|kind|description|order)|(param|returns) ([a-z][a-z_0-9]*)): (.+)")
PARAMETER = re.compile(r"\$([A-Za-z_][A-Za-z_0-9]*)")
_WRITES = re.compile(r"(?<!:)\b(CREATE|MERGE|DELETE|SET|REMOVE|DROP|FOREACH|LOAD)\b", re.IGNORECASE)
TEXT = re.compile(r"'(?:[^'\\]|\\.)*'|\"(?:[^\"\\]|\\.)*\"|//[^\n]*|/\*.*?\*/", re.DOTALL)


@dataclass(frozen=True, slots=True)
class QueryField:
    """A parameter or a column.

    Attributes
    ----------
    type
        One of ``TYPES``; of a column, one of ``COLUMN_TYPES``.
    default
        Of a parameter that may be left out; None for one that may not.
    """

    name: str
    type: str
    meaning: str
    default: str | int | bool | list[str] | None = None


@dataclass(frozen=True, slots=True)
class Query:
    """A question with its Cypher.

    Attributes
    ----------
    order
        Columns by which the rows are sorted.
    text
        The whole file.
    """

    name: str
    kind: str
    description: str
    parameters: tuple[QueryField, ...]
    columns: tuple[QueryField, ...]
    order: tuple[str, ...]
    text: str

    @property
    def drawable(self) -> bool:
        """Whether its rows hold paths of the graph, not only names."""
        return any(COLUMN_TYPES[column.type] is Path for column in self.columns)

    def values(self, texts: Mapping[str, str]) -> dict[str, Any]:
        """Return the values of all parameters from text of the command line; all faults are one error."""
        known = {field.name: field for field in self.parameters}
        problems = []
        for name in sorted(set(texts) - set(known)):
            hint = did_you_mean([*map(repr, nearest(name, known))], f"it takes {', '.join(known) or 'none'}")
            problems.append(f"{self.name}: unknown parameter {shown(name)!r}; {hint}")
        values: dict[str, Any] = {}
        for name, field in known.items():
            if name not in texts and field.default is None:
                problems.append(f"{self.name}: {name} is missing; write {name}=…, {field.meaning}")
                continue
            try:
                values[name] = _value(field, texts[name]) if name in texts else field.default
            except ValueError:
                what = f"{shown(texts[name])!r} is not of the type {field.type}"
                problems.append(f"{self.name}: {name}: {what}; {field.meaning}")
        if problems:
            raise QueryError("\n".join(problems))
        return values


def _value(field: QueryField, text: str) -> str | int | bool | list[str]:
    text.encode()  # what the command line could not decode is a ValueError
    if field.type == "integer":
        if abs(int(text)) > LARGEST:
            raise ValueError(text)
        return int(text)
    if field.type == "boolean":
        if text not in ("true", "false"):
            raise ValueError(text)
        return text == "true"
    if field.type == "list of string":
        return [part for part in text.split(",") if part]
    return text


def pack() -> dict[str, Query]:
    """Return the queries that come with the program, by name, sorted.

    >>> "leak-paths-of-category" in pack()
    True
    """
    folder = files("rosprivacy.queries")
    texts = {item.name: item.read_text("utf-8") for item in folder.iterdir() if item.name.endswith(".cypher")}
    queries = [parse(name.removesuffix(".cypher"), text) for name, text in texts.items()]
    return {query.name: query for query in sorted(queries, key=lambda query: query.name)}


def find(name: str) -> Query:
    """Return the query of that name."""
    queries = pack()
    if name not in queries:
        hint = did_you_mean(nearest(name, queries, FEW, like=0.4), "see them with rosprivacy query")
        raise QueryError(f"{shown(name)}: there is no such query; {hint}")
    return queries[name]


def parse(stem: str, text: str) -> Query:
    """Read a query with its header, and check one against the other.

    Raises
    ------
    QueryError
        With every fault: a key unknown, missing or twice, a parameter that is declared or used only, a column that is
        not returned, no order, something that writes.
    """
    header = [line for line in text.splitlines() if line.startswith("//")]
    head: dict[str, str] = {}
    fields: dict[str, list[QueryField]] = {"param": [], "returns": []}
    problems: list[str] = []

    def problem(fault: str) -> None:
        problems.append(f"{stem}.cypher: {fault}")

    for line in header:
        match = _LINE.fullmatch(line)
        if not match:
            problem(f"{shown(line)!r} is not a line of a header; see queries/library.py")
            continue
        key, kind, name, rest = match.groups()
        if key:
            if key in head:
                problem(f"{key} stands twice; keep one")
            head[key] = rest
        else:
            try:
                fields[kind].append(_field(name, rest, TYPES if kind == "param" else COLUMN_TYPES))
            except ValueError as error:
                problem(f"{shown(line)!r}: {error}")
    for key in KEYS:
        if key not in head:
            problem(f"{key} is missing; add // {key}: …")
    if problems:
        raise QueryError("\n".join(problems))
    order = tuple(part.strip() for part in head["order"].split(","))
    query = Query(
        head["name"], head["kind"], head["description"], tuple(fields["param"]), tuple(fields["returns"]), order, text
    )
    problems = [f"{stem}.cypher: {what}" for what in _faults(query, stem)]
    if problems:
        raise QueryError("\n".join(problems))
    return query


def _field(name: str, rest: str, types: Mapping[str, type]) -> QueryField:
    type_, comma, meaning = rest.partition(", ")
    if type_ not in types or not comma:
        raise ValueError(f"the type is one of {', '.join(types)}; write 'TYPE, meaning'")
    meaning, _, text = meaning.partition(", default ")
    if not text:
        return QueryField(name, type_, meaning)
    default: Any = None
    with suppress(ValueError):
        default = json.loads(text)
    of_its_type = type(default) is types[type_]
    if not of_its_type:
        raise ValueError(f"the default is no {type_}; write it as JSON")
    return QueryField(name, type_, meaning, default)


def _faults(query: Query, stem: str) -> Iterator[str]:
    body = TEXT.sub("", query.text)
    if query.name != stem:
        yield f"name is {shown(query.name)!r}; write the file's own"
    if query.kind not in KINDS:
        yield f"kind is {shown(query.kind)!r}; one of {', '.join(KINDS)}"
    for fields in (query.parameters, query.columns):
        names = [field.name for field in fields]
        yield from (f"{name} stands twice; keep one" for name in sorted({n for n in names if names.count(n) > 1}))
    declared = [field.name for field in query.parameters]
    for name in sorted({*declared} ^ {*PARAMETER.findall(body)}):
        yield f"${name} is {'not used' if name in declared else 'not declared'}; header and query must agree"
    columns = [field.name for field in query.columns]
    if _returned(body) != columns:
        yield f"RETURN gives {shown(', '.join(_returned(body)))}, the header says {', '.join(columns)}; make them agree"
    if body.rstrip().removesuffix(";").rstrip().rpartition("ORDER BY ")[2] != ", ".join(query.order):
        yield f"the last line is not ORDER BY {shown(', '.join(query.order))}; rows need a stable order"
    if not set(query.order) <= {*columns, *(f"{column} DESC" for column in columns)}:
        yield "order names what is not a column; use columns"
    if _WRITES.search(body):
        yield f"{_WRITES.search(body).group()} writes; a query only reads"  # type: ignore[union-attr]  # just found


def _returned(body: str) -> list[str]:
    """The names of the columns of the last RETURN that stands in no subquery."""
    outside, depth = [], 0
    for piece in re.split("([{}])", body):
        depth = max(0, depth + (piece == "{") - (piece == "}"))
        outside += [] if depth or piece == "}" else [piece]
    last = re.split(r"\bRETURN\b(?:\s+DISTINCT\b)?", "".join(outside))[-1]
    last = re.split(r"\bORDER BY\b|\bLIMIT\b|;", last)[0]
    ends, depth = [-1], 0
    for at, character in enumerate(last):
        depth += (character in "([{") - (character in ")]}")
        if character == "," and not depth:
            ends.append(at)
    parts = [last[begin + 1 : end] for begin, end in pairwise([*ends, len(last)])]
    return [re.split(r"\bAS\b", part)[-1].strip() for part in parts]
