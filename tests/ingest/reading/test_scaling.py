"""What a reader costs grows with what it reads, not with its square: n, 2n, 4n of what a stranger can write many of.

Processor time without garbage collection, the least of some tries: a busy machine makes a try longer, and never a
reader's square into a line. Four times as much may take six times as long; where the time grew with the square it
would be sixteen, which is what C++ comments took that each copied all that stood before them.
"""

from __future__ import annotations

import gc
import json
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.bags import answer_bags
from rosprivacy.ingest.code.cpp_code import read_cpp
from rosprivacy.ingest.code.python_code import read_python
from rosprivacy.ingest.decisions.decisions_file import read_decisions
from rosprivacy.ingest.deployed.governance import read_governance
from rosprivacy.ingest.deployed.permissions import policy_of, read_permissions
from rosprivacy.ingest.deployed.zenoh_grants import read_zenoh
from rosprivacy.ingest.fleet.fleet_file import read_fleet
from rosprivacy.ingest.labels.label_file import read_labels
from rosprivacy.ingest.policies.policy_xml import read_policy
from rosprivacy.ingest.policies.saved_graph import read_saved
from rosprivacy.ingest.running.node_info import TextFiles
from rosprivacy.ingest.types.types_file import read_types
from rosprivacy.ontology.vocabulary import load
from rosprivacy.queries.library import parse
from rosprivacy.queries.run import refuse_too_much
from rosprivacy.settings import Settings
from tests.helpers.keystores import governance, grant, permissions, rule, topic_rule
from tests.helpers.observed import node_info

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

pytestmark = pytest.mark.slow
SLACK = 6.0  # of four times as much; 4 is a line, 16 a square
TRIES = 5
AT = "2026-06-01T00:00:00Z"
PROFILE = '<profile ns="/" node="n{}"><topics publish="ALLOW"><topic>t{}</topic></topics></profile>\n'
FLEET = "fleet: 1\nmodels: {m: {policies: [p.xml]}}\nrobots:\n"
HEADER = "// name: q\n// kind: table\n// description: What?\n// returns a: integer, it\n// order: a\n"
QUERY = HEADER + "RETURN 1{} AS a ORDER BY a"


@dataclass(frozen=True)
class Reader:
    """A reader, and what it is given many of.

    Attributes
    ----------
    many
        How many take some hundredths of a second.
    text
        A file with so many of it.
    read
        Reads the file of a name, or its bytes.
    """

    name: str
    many: int
    text: Callable[[int], str]
    read: Callable[[str], object]


def _bytes(read: Callable[[bytes], object]) -> Callable[[str], object]:
    def of(file: str) -> object:
        with open(file, "rb") as opened:  # noqa: PTH123 - as short as the others
            return read(opened.read())

    return of


def _policy(inside: str) -> str:
    enclave = f'<enclave path="/e"><profiles>\n{inside}</profiles></enclave>'
    return f'<policy version="0.2.0"><enclaves>{enclave}</enclaves></policy>'


def _access(many: int) -> str:
    rules = [
        {"id": f"r{n}", "permission": "allow", "messages": ["put"], "flows": ["egress"], "key_exprs": [f"0/t{n}/*/*"]}
        for n in range(many)
    ]
    subjects = [{"id": "s"}]
    policies = [{"rules": [one["id"] for one in rules], "subjects": ["s"]}]
    access = {"enabled": True, "default_permission": "deny", "rules": rules, "subjects": subjects, "policies": policies}
    return json.dumps({"mode": "peer", "access_control": access}, indent=1)


def _graph(many: int) -> str:
    of = {"enclave": "/e", "node": "/n", "file": "p.xml", "line": 1}
    grants = [{"rule": "ALLOW", "role": "publish", "name": f"/t{n}", "absolute": True, **of} for n in range(many)]
    policy = {"file": "p.xml", "sources": {"p.xml": "0" * 64}, "profiles": [of], "grants": grants, "diagnostics": []}
    return json.dumps({"format": "rosprivacy.graph/1", "policies": [policy]})


def _types(many: int) -> str:
    head = f"types: 1\nobserved: {{from: {AT}, to: {AT}, by: [dds]}}\ntopics:\n"
    seen = "- {type: std_msgs/msg/Bool, writers: [/n], readers: [], first: " + AT + "}"
    return head + "".join(f"  /t{n}:\n    {seen}\n" for n in range(many))


def _decisions(many: int) -> str:
    said = "decision: mitigate, reason: r, owner: o, date: 2026-01-02}"
    return "decisions: 1\nfindings:\n" + "".join(f"  - {{id: {n:016x}, {said}\n" for n in range(many))


def _bag(many: int) -> str:
    topic: dict[str, Any] = {"message_count": 1}
    topics = [{**topic, "topic_metadata": {"name": f"/t{n}", "type": "std_msgs/msg/Bool"}} for n in range(many)]
    said: dict[str, Any] = {"version": 9, "storage_identifier": "mcap", "duration": {"nanoseconds": 1}}
    said |= {"starting_time": {"nanoseconds_since_epoch": 1}, "message_count": many, "relative_file_paths": []}
    said |= {"topics_with_message_count": topics, "compression_format": "", "compression_mode": "", "files": []}
    return json.dumps({"rosbag2_bagfile_information": said})


def _asked(file: str) -> None:
    answer_bags([file.rpartition("/")[0]], (), (), Settings(today=AT[:10])).document()


def _cpp(name: str, many: int, text: Callable[[int], str]) -> Reader:
    return Reader(f"C++: {name}", many, text, _bytes(lambda data: read_cpp("a.cpp", data)))


def _python(name: str, many: int, text: Callable[[int], str]) -> Reader:
    return Reader(f"Python: {name}", many, text, _bytes(lambda data: read_python("a.py", data)))


def _query(name: str, many: int, text: Callable[[int], str]) -> Reader:
    return Reader(f"query: {name}", many, text, _bytes(lambda data: parse("q", data.decode())))


def _labels(name: str, text: Callable[[int], str]) -> Reader:
    return Reader(f"labels: {name}", 1000, text, lambda file: read_labels(file, load()))


READERS = [
    Reader("policy", 1000, lambda n: _policy("".join(PROFILE.format(i, i) for i in range(n))), read_policy),
    Reader(
        "policy: topics", 2000,
        lambda n: _policy(PROFILE.format(0, "</topic><topic>t".join(map(str, range(n))))), read_policy,
    ),
    Reader("policy: comments", 8000, lambda n: _policy("<!-- a -->\n" * n + PROFILE.format(0, 0)), read_policy),
    _labels("entries", lambda n: "labels: 1\nnodes:\n" + "".join(f"  /n{i}: {{leak: [Video]}}\n" for i in range(n))),
    _labels("globs", lambda n: "labels: 1\nnodes:\n" + "".join(f"  /n{i}/*: {{leak: [Video]}}\n" for i in range(n))),
    _labels("comments", lambda n: "labels: 1\n" + "# a\n" * (40 * n) + "nodes: {/n: conduit}\n"),
    Reader(
        "fleet", 1000,
        lambda n: FLEET + "".join(f"  r{i}: {{model: m}}\n" for i in range(n)),
        lambda file: read_fleet(file, load()),
    ),
    Reader(
        "permissions", 1000,
        lambda n: permissions(grant("/a", *(rule("allow", publish=(f"rt/t{i}",)) for i in range(n)))),
        _bytes(lambda data: policy_of(read_permissions(data, "p.xml"), 0, ())),
    ),
    Reader(
        "permissions: topics", 2000,
        lambda n: permissions(grant("/a", rule("allow", publish=tuple(f"rt/t{i}" for i in range(n))))),
        _bytes(lambda data: policy_of(read_permissions(data, "p.xml"), 0, ())),
    ),
    Reader(
        "governance", 500, lambda n: governance(*(topic_rule(f"rt/t{i}") for i in range(n))),
        _bytes(lambda data: read_governance(data, "g.xml")),
    ),
    Reader("Zenoh's access list", 200, _access, lambda file: read_zenoh([file], None)),
    Reader("saved graph", 1000, _graph, read_saved),
    Reader("types", 500, _types, read_types),
    Reader("decisions", 500, _decisions, lambda file: read_decisions(file, load(), AT[:10])),
    _cpp("comments", 5000, lambda n: "// just a comment, say a licence\n" * n),
    _cpp("comments behind code", 2000, lambda n: "int a; // just a comment\n" * n),
    _cpp("annotations", 4000, lambda n: "// privacy: source Video\n" * n),
    _cpp("publishers", 1000, lambda n: 'auto p = create_publisher<Image>("/a");\n' * n),
    _cpp("calls in a row", 1500, lambda n: "int x = a" + '.create_publisher("b")' * n + ";"),
    _cpp("code within code", 2000, lambda n: "auto x = " + "[]{ return " * n + "1" + ";}" * n + ";"),
    _python("comments", 20000, lambda n: "# just a comment, say a licence\n" * n),
    _python("comments behind code", 2000, lambda n: "a = 1  # just a comment\n" * n),
    _python("publishers", 500, lambda n: "p = self.create_publisher(Image, '/a')\n" * n),
    _python("classes", 500, lambda n: "".join(f"class A{i}(Node):\n    x = B{i}()\n" for i in range(n))),
    Reader("bag: topics", 2000, _bag, _asked),
    Reader(
        "node info", 500,
        lambda n: "".join(node_info(f"/n{i}", publishers=f"/t{i}: std_msgs/msg/Bool") for i in range(n)),
        lambda file: list(TextFiles((file,), lambda: AT, AT).looks()),
    ),
    _query("operators", 20000, lambda n: QUERY.format(" + 1" * n)),
    _query("comments", 20000, lambda n: QUERY.format(" // a comment\n" * n)),
    Reader(
        "query: values", 20000, lambda n: "RETURN [" + ", ".join(["1 + 1"] * n) + "] AS a",
        _bytes(lambda data: refuse_too_much(data.decode())),
    ),
]  # fmt: skip


def seconds(reader: Reader, file: str) -> float:
    begun = time.process_time()
    reader.read(file)
    return time.process_time() - begun


@pytest.mark.parametrize("reader", READERS, ids=lambda reader: reader.name)
def test_four_times_as_much_takes_about_four_times_as_long(reader: Reader, tmp_path: Path) -> None:
    files = []
    for times in (1, 2, 4):
        file = tmp_path / str(times) / ("metadata.yaml" if reader.read is _asked else "a.json5")
        file.parent.mkdir()
        file.write_text(reader.text(reader.many * times), "utf-8")
        (file.parent / "p.xml").write_text(_policy(""), "utf-8")
        files.append(str(file))
    reader.read(files[0])  # what is made once: schemas, vocabulary
    least = [float("inf")] * 3
    gc.disable()
    try:
        for _ in range(TRIES):
            least = [min(before, seconds(reader, file)) for before, file in zip(least, files, strict=True)]
            if least[2] <= SLACK * least[0]:
                break
    finally:
        gc.enable()
    assert least[2] <= SLACK * least[0], least
