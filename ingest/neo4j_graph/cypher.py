"""The Cypher that writes rows, made from the schema: ``UNWIND … MERGE`` for nodes, ``UNWIND … CREATE`` for the rest.

In: kinds of ``schema.py``. Out: statements with the parameter ``$rows``; identifiers are quoted, values are parameters.
What was written before is deleted first, so relationships are created, not merged: two grants of one line are two.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.ingest.neo4j_graph.schema import (
    ACROSS,
    ADDED_FINDING,
    BAG,
    CAME_WITH,
    CARRIES,
    CATEGORY,
    CHANGE,
    COULD_FLOW_TO,
    ELEMENT,
    ENCLAVE,
    FALLS_UNDER,
    FINDING,
    HAS_TOPIC,
    INTAKE,
    LOAD,
    LOOK_AT,
    NODES,
    PROVISION,
    RECORDED_TOPIC,
    RECORDS,
    ROBOT,
    quoted,
)

if TYPE_CHECKING:
    from rosprivacy.ingest.neo4j_graph.schema import NodeKind, RelationshipKind

_IS_CARRIES = f"type(c) STARTS WITH '{CARRIES}'"
_BY_LABEL = {kind.label: kind for kind in NODES}


def merge_nodes(kind: NodeKind) -> str:
    """Return the statement for rows of ``id`` and ``properties``; others' properties stay as they are.

    >>> from rosprivacy.ingest.neo4j_graph.schema import ENCLAVE
    >>> merge_nodes(ENCLAVE)
    'UNWIND $rows AS row MERGE (n:`Enclave` {`id`: row.id}) SET n += row.properties'
    """
    return f"UNWIND $rows AS row MERGE {_node('n', kind, 'row.id')} SET n += row.properties"


def create_relationships(kind: RelationshipKind) -> str:
    """Return the statement for rows of ``source``, ``target`` (keys) and ``properties``."""
    source, target = _BY_LABEL[kind.source], _BY_LABEL[kind.target]
    return (
        f"UNWIND $rows AS row MATCH {_node('a', source, 'row.source')} MATCH {_node('b', target, 'row.target')} "
        f"CREATE (a)-[r:{quoted(kind.type)}]->(b) SET r = row.properties"
    )


def merge_relationships(kind: RelationshipKind) -> str:
    """Return the same for what may be there already."""
    return create_relationships(kind).replace(" CREATE ", " MERGE ")


def _node(variable: str, kind: NodeKind, value: str) -> str:
    return f"({variable}:{quoted(kind.label)} {{{quoted(kind.key)}: {value}}})"


# Elements of a robot that was not there: no label can be stale.
CREATE_ELEMENTS = (
    f"UNWIND $rows AS row MATCH {_node('r', ROBOT, 'row.properties.robot')} "
    f"MERGE {_node('n', ELEMENT, 'row.id')} SET n += row.properties SET n:$(row.labels) "
    "CREATE (n)-[:`OF_ROBOT` {`robot`: row.properties.robot}]->(r)"
)
# Elements that may be there: labels of ours that no longer hold go, others stay.
REPLACE_ELEMENTS = (
    f"UNWIND $rows AS row MATCH {_node('r', ROBOT, 'row.properties.robot')} "
    f"MERGE {_node('n', ELEMENT, 'row.id')} SET n += row.properties "
    "WITH n, r, row, [label IN labels(n) WHERE label IN $labels AND NOT label IN row.labels] AS stale "
    "REMOVE n:$(stale) SET n:$(row.labels) "
    "MERGE (n)-[of:`OF_ROBOT`]->(r) SET of.`robot` = r.`name`"
)
# Elements of other robots at which flows end: they may be loaded later, then with all that is said of them.
MERGE_FOREIGN = (
    f"UNWIND $rows AS row OPTIONAL MATCH {_node('n', ELEMENT, 'row.id')} WITH row WHERE n IS NULL "
    f"CREATE {_node('n', ELEMENT, 'row.id')} SET n += row.properties SET n:$(row.labels)"
)
_CREATE_FINDINGS = (
    f"UNWIND $rows AS row MATCH {_node('a', ELEMENT, 'row.source')} MATCH {_node('b', ELEMENT, 'row.target')} "
    f"MATCH {_node('c', CATEGORY, 'row.category')} "
    f"MERGE {{finding}} SET f += row.properties "
    "CREATE (f)-[:`FROM`]->(a) CREATE (f)-[:`TO`]->(b) CREATE (f)-[:`OF_CATEGORY`]->(c)"
)
CREATE_FINDINGS, CREATE_ADDED = (
    _CREATE_FINDINGS.replace("{finding}", _node("f", kind, "row.id")) for kind in (FINDING, ADDED_FINDING)
)
# Both ends are looked up once for all kinds that go from one to the other.
CREATE_CARRIES = (
    f"UNWIND $rows AS row MATCH {_node('a', ELEMENT, 'row.source')} MATCH {_node('b', ELEMENT, 'row.target')} "
    "UNWIND row.types AS type CREATE (a)-[:$(type)]->(b)"
)
READ_CARRIES = (
    f"MATCH (n:`Element`)-[c]->(m:`Element`) WHERE coalesce(n.`robot`, '') IN $names AND {_IS_CARRIES} "
    "RETURN n.`id`, m.`id`, collect(type(c))"
)
DELETE_CARRIES = (
    f"UNWIND $rows AS row MATCH {_node('a', ELEMENT, 'row.source')}-[c]->{_node('b', ELEMENT, 'row.target')} "
    "WHERE type(c) IN row.types DELETE c"
)
MERGE_INTAKES = (
    f"UNWIND $rows AS row MERGE {_node('n', ELEMENT, 'row.id')} SET n += row.properties "
    "WITH n, row, [label IN labels(n) WHERE label IN $labels AND NOT label IN row.labels] AS stale "
    f"REMOVE n:$(stale) SET n:$(row.labels) WITH n MATCH {_node('r', ROBOT, 'n.`robot`')} "
    "MERGE (n)-[of:`OF_ROBOT`]->(r) SET of.`robot` = r.`name`"
)
DELETE_INTAKES = (
    f"MATCH (n:{quoted(INTAKE)}) WHERE coalesce(n.`robot`, '') IN $names AND NOT n.`id` IN $ids DETACH DELETE n"
)
CREATE_ACROSS = create_relationships(ACROSS)
MERGE_CATEGORIES = merge_nodes(CATEGORY)
MERGE_PROVISIONS = merge_nodes(PROVISION)
MERGE_ENCLAVES = merge_nodes(ENCLAVE)
# The ontology says it anew: what it no longer says goes.
_LAW = f"{quoted(FALLS_UNDER.type)}|{quoted(LOOK_AT.type)}"
DROP_CATEGORY_LINKS = f"MATCH (c:{quoted(CATEGORY.label)})-[r:`BROADER`|{_LAW}]->() WHERE c.`iri` IN $iris DELETE r"

# The first write of a robot's transaction: whoever else writes it waits here.
LOCK_ROBOTS = (
    f"UNWIND $names AS name MERGE {_node('r', ROBOT, 'name')} ON CREATE SET r.`version` = 0 "
    "SET r.`lock` = true REMOVE r.`lock`"
)
LOCK_KNOWN_ROBOTS = f"UNWIND $names AS name MATCH {_node('r', ROBOT, 'name')} SET r.`lock` = true REMOVE r.`lock`"
READ_ROBOTS = (
    f"UNWIND $names AS name MATCH {_node('r', ROBOT, 'name')} RETURN name, r.`version` AS version, "
    f"r.`version` > 0 OR EXISTS {{ MATCH (:{quoted(ELEMENT.label)} {{`robot`: name}}) }} AS known"
)
READ_DIGESTS = (
    f"UNWIND $names AS name MATCH {_node('r', ROBOT, 'name')} RETURN name, r.`digest` AS digest, "
    "r.`assumptions` AS assumptions, "
    f"r.`elements` = COUNT {{ (r)<-[:`OF_ROBOT` {{`robot`: name}}]-(n) WHERE NOT n:{quoted(INTAKE)} }} AND "
    f"r.`carried` = COUNT {{ (r)<-[:`OF_ROBOT` {{`robot`: name}}]-()-[c]->() WHERE {_IS_CARRIES} }} AND "
    "r.`flows` = COUNT { (r)<-[:`OF_ROBOT`]-()-[f:`FLOWS_TO` {`robot`: name}]->() } AND "
    "r.`roles` = COUNT { (r)<-[:`OF_ROBOT`]-()-[o {`robot`: name}]->(:`DataCategory`) } AS whole"
)
WRITE_ROBOTS = (
    f"UNWIND $rows AS row MATCH {_node('r', ROBOT, 'row.robot')} SET r += row.properties, r.`version` = r.`version` + 1"
)
# What happened: no question about what is there follows these.
MERGE_LOADS, MERGE_CHANGES, LINK_CHANGES = merge_nodes(LOAD), merge_nodes(CHANGE), create_relationships(CAME_WITH)
WROTE_ROBOTS = (
    f"MATCH {_node('l', LOAD, '$id')} UNWIND $names AS name MATCH {_node('r', ROBOT, 'name')} "
    "CREATE (l)-[:`WROTE` {`version`: r.`version`}]->(r)"
)
READ_PATTERNS = (
    f"MATCH (f:{quoted(FINDING.label)}) WHERE f.`robot` IN $names "
    "RETURN f.`robot` AS robot, f.`pattern` AS pattern, properties(f) AS properties"
)
READ_ELEMENTS = (
    "MATCH (r:`Robot`)<-[:`OF_ROBOT` {`robot`: r.`name`}]-(n:`Element`) WHERE r.`name` IN $names RETURN n.`id` AS id"
)
DELETE_ELEMENTS = f"UNWIND $rows AS id MATCH {_node('n', ELEMENT, 'id')} DETACH DELETE n"
DELETE_OURS = (
    "MATCH (n:`Element`)-[o]->() WHERE n.`robot` IN $names AND type(o) <> 'OF_ROBOT' "
    f"AND (o.`robot` = n.`robot` OR {_IS_CARRIES.replace('(c)', '(o)')}) DELETE o"
)
DELETE_FINDINGS = "MATCH (f:`Finding`) WHERE f.`robot` IN $names DETACH DELETE f"
# What the enforced view adds, and that somebody asked for it: it is true of what was loaded only.
DELETE_BEYOND = (
    f"MATCH (f:{quoted(ADDED_FINDING.label)}) WHERE f.`robot` IN $names DETACH DELETE f",
    f"MATCH (:`Element`)-[c:{quoted(COULD_FLOW_TO.type)}]->() WHERE c.`robot` IN $names DELETE c",
    "MATCH (r:`Robot`) WHERE r.`name` IN $names REMOVE r.`beyond`",
)
DELETE_EMPTY_ENCLAVES = (
    "MATCH (e:`Enclave`) WHERE e.`robot` IN $names AND NOT EXISTS { (e)<-[:`IN_ENCLAVE`]-() } DETACH DELETE e"
)
DELETE_ROBOTS = "MATCH (r:`Robot`) WHERE r.`name` IN $names DETACH DELETE r"

MERGE_BAGS, MERGE_TOPICS = merge_nodes(BAG), merge_nodes(RECORDED_TOPIC)
MERGE_HAS_TOPIC, MERGE_RECORDS = merge_relationships(HAS_TOPIC), merge_relationships(RECORDS)
_TOPIC = f"-[:{quoted(HAS_TOPIC.type)}]->(t:{quoted(RECORDED_TOPIC.label)})"
DELETE_OLD_TOPICS = (
    f"UNWIND $rows AS row MATCH {_node('b', BAG, 'row.id')}{_TOPIC} WHERE NOT t.`id` IN row.topics DETACH DELETE t"
)
DELETE_OLD_RECORDS = (
    f"UNWIND $rows AS row MATCH {_node('t', RECORDED_TOPIC, 'row.id')}-[r:{quoted(RECORDS.type)}]->(e) "
    "WHERE NOT e.`id` IN row.channels DELETE r"
)
COUNT_RECORDS = (
    f"UNWIND $ids AS id MATCH {_node('b', BAG, 'id')}{_TOPIC} WHERE EXISTS {{ (t)-[:{quoted(RECORDS.type)}]->() }} "
    "RETURN count(t) AS linked"
)
_BAGS_THERE = f"MATCH (b:{quoted(BAG.label)}) WHERE b.`id` = $path OR b.`id` STARTS WITH $path + '/'"
DELETE_BAGS = (
    f"{_BAGS_THERE} OPTIONAL MATCH (b){_TOPIC} WITH b, b.`id` AS id, collect(t) AS topics "
    "FOREACH (t IN topics | DETACH DELETE t) DETACH DELETE b RETURN id ORDER BY id"
)
