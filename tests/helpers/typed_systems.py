"""Random systems of which the message types of channels may be known: who writes and reads what, what labels say."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from hypothesis import strategies as st

from rosprivacy.ontology.iris import STORED
from rosprivacy.ontology.vocabulary import load
from rosprivacy.report.json_text import as_text
from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.result import Result

# A user's own kinds: their broader ones, and whether the file sets them apart by another form of data.
OWN = {"Silhouette": (("Video",), False), "Walking": (("Video",), True), "Clip": (("Video", "Voice"), False)}
HEAD = f"""@prefix rp: <{STORED}> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
@prefix e: <urn:example:> .
"""
OWN_KIND = """e:{name} a skos:Concept ; rp:label "{name}" ; skos:prefLabel "{name}"@en ;
    skos:definition "Made up for a test."@en ; skos:broader {broader}{apart} .
"""


def ontology() -> str:
    text = HEAD
    for name, (broader, apart) in OWN.items():
        names = " , ".join(f"rp:{one}" for one in broader)
        text += OWN_KIND.format(name=name, broader=names, apart=' ; rp:dataType "number"' if apart else "")
    return text


def vocabulary() -> Vocabulary:
    with TemporaryDirectory() as folder:
        file = Path(folder, "own.ttl")
        file.write_text(ontology(), "utf-8")
        return load(ontologies=(str(file),))


VOCABULARY = vocabulary()
KINDS = ("FaceImage", "FaceTemplate", "PersonImage", "Video", "Voice", *OWN)
UP = {kind: set(VOCABULARY.hierarchy.ancestors[kind]) for kind in KINDS}
TABLES = {
    "a/msg/A": {"PersonImage", "Voice"},
    "a/msg/B": {"Video", "FaceTemplate", "Walking"},
}  # a/msg/C is in no table
TYPES = (*TABLES, "a/msg/C")
CHANNELS, NODES = ("/t0", "/t1", "/t2", "/u3"), ("/n0", "/n1", "/n2", "/n3")
WILD = "/t*"
MORE: dict[str, Any] = {"ontologies": "own.ttl"}


def table() -> str:
    entry = "  - {{types: [{}], kinds: [{}], why: a test, source: this file}}\n"
    return "type_table: 1\ncannot:\n" + "".join(entry.format(k, ", ".join(sorted(v))) for k, v in TABLES.items())


@dataclass
class System:
    """Who writes and reads what, what labels say, and which types were seen or stated."""

    writes: dict[str, set[str]]
    reads: dict[str, set[str]]
    sources: dict[str, dict[str, list[str]]]
    leaks: dict[str, list[str]]
    derives: dict[str, list[tuple[str, str]]]
    said: dict[str, tuple[str, list[str]]]
    stated: dict[str, list[str]]
    seen: dict[str, list[tuple[str, list[str]]]] = field(default_factory=dict)

    def write(self) -> None:
        profiles = (f"{n}>{','.join(sorted(self.writes[n]))}<{','.join(sorted(self.reads[n]))}" for n in NODES)
        Path("p.xml").write_text(policy(*profiles), "utf-8")
        labels: dict[str, Any] = {"labels": 1, "nodes": {}, "channels": {}}
        for node in NODES:
            said: dict[str, Any] = {}
            if self.sources.get(node):
                through = self.sources[node]
                named = all(through.values())
                said["source"] = through if named else sorted(through)
            if self.leaks.get(node):
                said["leak"] = self.leaks[node]
            if self.derives.get(node):
                said["derives"] = [{"from": a, "to": b} for a, b in self.derives[node]]
            labels["nodes"][node] = said or None
        for channel in CHANNELS:
            entry: dict[str, Any] = {}
            if channel in self.said and self.said[channel][0] != "sensitive":
                entry[self.said[channel][0]] = self.said[channel][1]
            if self.stated.get(channel):
                entry["types"] = self.stated[channel]
            if entry and channel in self.there():
                labels["channels"][channel] = entry
        sensitive = {c: "sensitive" for c in self.there() if self.said.get(c, ("",))[0] == "sensitive"}
        labels["topics"] = sensitive  # two sections, since one entry cannot say both
        Path("l.yaml").write_text(as_text(labels), "utf-8")
        topics = {c: [{"type": name, "writers": by} for name, by in seen] for c, seen in self.seen.items()}
        Path("t.yaml").write_text(as_text({"types": 1, "topics": topics}), "utf-8")
        Path("table.yaml").write_text(table(), "utf-8")
        Path("own.ttl").write_text(ontology(), "utf-8")

    def there(self) -> set[str]:
        return {c for some in (*self.writes.values(), *self.reads.values()) for c in some} & set(CHANNELS)

    def writers(self, channel: str) -> dict[str, bool]:
        """Who writes a channel; whether by its name, or only through the wildcard."""
        by_wild = {n: False for n in NODES if WILD in self.writes[n] and channel.startswith("/t")}
        return by_wild | {n: True for n in NODES if channel in self.writes[n]}

    def limited(self, channel: str, kind: str) -> bool:
        """S15, word for word."""
        types = [*self.stated.get(channel, []), *(name for name, _ in self.seen.get(channel, []))]
        if not types or not all(cannot(name, kind) for name in types):
            return False
        for writer, by_name in self.writers(channel).items():
            known = bool(self.stated.get(channel)) or (
                by_name and any(writer in by for _, by in self.seen.get(channel, []))
            )
            through_wild = WILD in self.writes[writer] and channel.startswith("/t")
            if not known or (through_wild and not self.stated.get(channel)):
                return False
            if channel in self.sources.get(writer, {}).get(kind, []) or kind in {to for _, to in self.derives[writer]}:
                return False
        how, kinds = self.said.get(channel, ("", []))
        return not (how == "sensitive" or (how == "only" and any(overlap(one, kind) for one in kinds)))

    def shut(self, channel: str, kind: str) -> bool:
        """Whether a label closes it: ``never`` by must, ``only`` by may (S7)."""
        how, kinds = self.said.get(channel, ("", []))
        if how == "never":
            return bool(set(kinds) & UP[kind])
        return how == "only" and not any(overlap(one, kind) for one in kinds)

    def findings(self, *, limits: bool) -> set[tuple[str, str, str]]:
        found = set()
        for source, begun in self.sources.items():
            for kind, through in begun.items():
                states: set[tuple[str, str]] = self.spread(source, kind, through, limits=limits)
                for node, at in states:
                    if any(overlap(one, at) for one in self.leaks.get(node, [])):
                        found.add((at, source, node))
        return found

    def spread(self, source: str, kind: str, through: list[str], *, limits: bool) -> set[tuple[str, str]]:
        """(node, kind) that data of one source get to."""
        here = {(source, kind)}
        left: list[tuple[str, str, set[str] | None]] = [(source, kind, set(through) if through else None)]
        done = set()
        made = self.made(kind, source)
        here |= {(source, one) for one in made}
        left += [(source, one, None) for one in sorted(made)]
        while left:
            node, at, only = left.pop()
            for reader, channel in self.next(node, at, only, limits=limits):
                if (reader, channel, at) in done:
                    continue
                done.add((reader, channel, at))
                arrived = {at, *self.made(at, reader)}
                here |= {(reader, one) for one in arrived}
                left += [(reader, one, None) for one in sorted(arrived)]
        return here

    def made(self, kind: str, node: str) -> set[str]:
        found: set[str] = set()
        more = {kind}
        while more:
            more = {to for a, to in self.derives[node] for k in more if overlap(a, k)} - found - {kind}
            found |= more
        return found

    def next(self, node: str, kind: str, only: set[str] | None, *, limits: bool) -> set[tuple[str, str]]:
        """(reader, channel) that data of a node get to in one step."""
        steps = set()
        for written in self.writes[node]:
            if only is not None and written not in only:
                continue
            names = [c for c in self.there() if c == written or (written == WILD and c.startswith("/t"))]
            for channel in names:
                if not self.shut(channel, kind) and not (limits and self.limited(channel, kind)):
                    steps |= {(r, channel) for r in NODES if channel in self.reads[r] or self.wild(r, channel)}
            if written == WILD:
                steps |= {(r, WILD) for r in NODES if WILD in self.reads[r]}
        return steps

    def wild(self, reader: str, channel: str) -> bool:
        return WILD in self.reads[reader] and channel.startswith("/t")


def cannot(name: str, kind: str) -> bool:
    """S15: a user's own kind only if the table names it, or a broader kind that the file does not set apart."""
    named = TABLES.get(name, set())
    if kind not in OWN:
        return bool(named & UP[kind])
    broader, apart = OWN[kind]
    return kind in named or (not apart and all(cannot(name, up) for up in broader))


def overlap(one: str, other: str) -> bool:
    """Whether a kind of data can be of both (S7's *may*)."""
    return any({one, other} <= set(up) for up in VOCABULARY.hierarchy.ancestors.values())


def some(values: tuple[str, ...], most: int = 2, least: int = 0) -> st.SearchStrategy[list[str]]:
    return st.lists(st.sampled_from(values), min_size=least, max_size=most, unique=True)


@st.composite
def systems(draw: st.DrawFn) -> System:
    names = st.sets(st.sampled_from((*CHANNELS, *CHANNELS, WILD)), min_size=1, max_size=2)
    writes = {node: draw(names) for node in NODES}
    reads = {node: draw(names) for node in NODES}
    sources: dict[str, dict[str, list[str]]] = {}
    for node in draw(some(NODES, 2, 1)):
        named = sorted(writes[node] - {WILD})
        through = draw(some(tuple(named), 1)) if named else []
        sources[node] = dict.fromkeys(draw(st.lists(st.sampled_from(KINDS), min_size=1, max_size=2)), through)
    restricted = st.tuples(st.sampled_from(("only", "never")), st.lists(st.sampled_from(KINDS), min_size=1, max_size=1))
    label: st.SearchStrategy[tuple[str, list[str]]] = st.one_of(st.just(("sensitive", list[str]())), restricted)
    seen = {}
    for channel in draw(some(CHANNELS, 3, 1)):
        writers = [node for node in NODES if channel in writes[node]]
        types = draw(st.lists(st.sampled_from((TYPES[0], *TYPES)), min_size=1, max_size=2, unique=True))
        seen[channel] = [(name, draw(some(tuple(writers), 3)) if writers else []) for name in types]
        if draw(st.integers(0, 3)):
            seen[channel][0] = (types[0], writers)
    pairs = st.tuples(st.sampled_from(KINDS), st.sampled_from(KINDS)).filter(lambda pair: pair[0] != pair[1])
    return System(
        writes, reads, sources,
        {node: draw(some(KINDS, 2, 1)) for node in draw(some(NODES, 2, 1))},
        {node: draw(st.lists(pairs, max_size=1)) if draw(st.integers(0, 1)) else [] for node in NODES},
        {channel: draw(label) for channel in draw(some(CHANNELS, 1))},
        {channel: draw(some((TYPES[0], *TYPES), 2, 1)) for channel in draw(some(CHANNELS, 2))},
        seen,
    )  # fmt: skip


def found(result: Result) -> set[tuple[str, str, str]]:
    return {(f.category, f.source.name, f.leak.name) for f in result.analysis.findings}
