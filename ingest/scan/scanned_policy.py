"""A scanned system -> policies and types: facts for an answer at once, or the files that ``rosprivacy scan`` writes.

In: ``ScannedSystem``, and the folder that its files lie in as the user calls it. Out: ``Policy`` whose grants stand at
lines of the code; an SROS 2 policy that says the same in its ``<metadata>``; the types of channels. No time stands in
them: same code, same bytes.
"""

from __future__ import annotations

import hashlib
from collections import defaultdict
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from lxml import etree
from ruamel.yaml.comments import CommentedMap, CommentedSeq

from rosprivacy.analysis.errors import InputError
from rosprivacy.analysis.model import Grant, Place, Policy, Profile
from rosprivacy.ingest.code.source_files import MAX_BYTES
from rosprivacy.ingest.policies import scanned_metadata
from rosprivacy.ingest.policies.policy_xml import ROLES
from rosprivacy.ingest.policies.scanned_metadata import ScanGap, scan_diagnostics
from rosprivacy.ingest.reading.bounded_file import read_regular
from rosprivacy.ingest.running.observed_files import USERS, yaml_text
from rosprivacy.ingest.types.types_file import (
    ENDS,
    KINDS,
    ObservedTypes,
    SeenChannel,
    SeenType,
    TypesFile,
    written_definition,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.ingest.scan.interface_definitions import TypeDefinition
    from rosprivacy.ingest.scan.scan_facts import CodePlace
    from rosprivacy.ingest.scan.systems import ChannelEnd, ScannedSystem

    Definitions = Mapping[str, TypeDefinition]

NO_DEFINITIONS: Definitions = MappingProxyType({})
SECTIONS = {kind: section for section, kind in KINDS.items()}
UNPRINTABLE = dict.fromkeys((*range(9), 11, 12, *range(14, 32), 65534, 65535, *range(55296, 57344)))


def scanned_policy(system: ScannedSystem, folder: str) -> Policy:
    """Return a system as a policy whose grants stand at lines of the code."""
    file = placed(system.launch, folder) if system.launch else folder
    first = Place(file, int(bool(system.launch)))
    profiles = tuple(Profile(node.name, node.name, line_of_code(node.place, folder), "") for node in system.nodes)
    grants = tuple(
        Grant(
            allow=True, role=end.role, kind=end.kind, name=end.name, enclave=end.node, node=end.node,
            place=line_of_code(end.place, folder), policy=file, absolute=True, basis=end.basis,
        )
        for end in system.ends
    )  # fmt: skip
    files = {place.file for place in (*(p.place for p in profiles), *(g.place for g in grants))}
    sources = tuple((name, _sha256(name)) for name in sorted(files | ({file} if system.launch else set())))
    said = tuple(scan_diagnostics(placed(system.launch, folder), _gaps(system, folder), first))
    return Policy(file, sources, profiles, grants, said, checkout=((folder,), ""))


def scanned_types(system: ScannedSystem, folder: str, definitions: Definitions = NO_DEFINITIONS) -> TypesFile:
    """Return the types of a system's channels, as a file of types has them, with what defines them."""
    channels = [
        SeenChannel(kind, name, tuple(_type_with_ends(type_, kind, ends, folder, definitions) for type_, ends in types))
        for (kind, name), types in _by_channel(system)
    ]
    text = types_yaml(system, folder, definitions).encode()
    return TypesFile(f"types of {folder}", hashlib.sha256(text).hexdigest(), ObservedTypes(), tuple(channels))


def _type_with_ends(
    type_: str, kind: str, ends: Iterable[ChannelEnd], folder: str, definitions: Definitions
) -> SeenType:
    defined = definitions.get(type_)
    file, fields = (placed(defined.file, folder), defined.fields) if defined and any(defined.fields) else ("", ())
    return SeenType(type_, ends=_sides(kind, ends), definition=file, fields=fields)


def placed(file: str, folder: str) -> str:
    """Return a file of a checkout as the user would open it.

    >>> placed("src/cam.py", "."), placed("src/cam.py", "robot/"), placed("", "robot")
    ('src/cam.py', 'robot/src/cam.py', '')
    """
    return Path(folder, file).as_posix() if file else ""


def policy_xml(system: ScannedSystem, folder: str) -> bytes:
    """Return a system as an SROS 2 policy; ``ValueError`` if it has no node: a policy cannot be empty."""
    if not system.nodes:
        raise ValueError("no node")
    ends: dict[str, list[ChannelEnd]] = defaultdict(list)
    for end in system.ends:
        ends[end.node].append(end)
    root = etree.Element("policy", version="0.2.0")
    enclaves = etree.SubElement(root, "enclaves")
    gaps = _gaps(system, folder)
    for number, node in enumerate(system.nodes):
        profiles = etree.SubElement(etree.SubElement(enclaves, "enclave", path=node.name), "profiles")
        _profile(profiles, node.name, ends[node.name])
        facts = {"version": scanned_metadata.VERSION, "gaps": str(len(gaps))}
        if system.launch:
            facts["launch"] = _printable(placed(system.launch, folder))
        scanned = etree.SubElement(etree.SubElement(profiles, "metadata"), scanned_metadata.TAG, facts)
        for gap in gaps if number == 0 else ():
            etree.SubElement(
                scanned, scanned_metadata.GAP, sort=gap.sort, at=_printable(_line(gap.place)), text=_printable(gap.text)
            )
        for end in ends[node.name]:
            etree.SubElement(
                scanned, scanned_metadata.GRANT, node=end.node, kind=end.kind, role=end.role, name=end.name,
                at=_printable(_line(line_of_code(end.place, folder))), basis=end.basis,
            )  # fmt: skip
    return etree.tostring(root, pretty_print=True, xml_declaration=True, encoding="UTF-8")


def _profile(profiles: etree._Element, node: str, ends: Iterable[ChannelEnd]) -> None:
    namespace, _, base = node.rpartition("/")
    profile = etree.SubElement(profiles, "profile", ns=namespace or "/", node=base)
    for group, (kind, roles) in ROLES.items():
        for role in roles:
            names = sorted({end.name for end in ends if (end.kind, end.role) == (kind, role)})
            if names:
                element = etree.SubElement(profile, group, {role: "ALLOW"})
                for name in names:
                    etree.SubElement(element, kind).text = name


def types_yaml(system: ScannedSystem, folder: str, definitions: Definitions = NO_DEFINITIONS) -> str:
    """Return the types of channels, as ``--types`` reads them; empty if none is known."""
    document = CommentedMap(types=1)
    for (kind, name), types in _by_channel(system):
        entries = []
        for type_, ends in types:
            seen = _type_with_ends(type_, kind, ends, folder, definitions)
            entry = CommentedMap(type=type_)
            sides = zip(ENDS[SECTIONS[kind]], seen.ends, strict=True)
            for key, value in (*sides, *written_definition(seen, SECTIONS[kind]).items()):
                if value:
                    entry[key] = value if isinstance(value, str) else CommentedSeq(value)
                if value and not isinstance(value, str):
                    entry[key].fa.set_flow_style()
            entry.fa.set_flow_style()
            entries.append(entry)
        document.setdefault(SECTIONS[kind], CommentedMap())[name] = CommentedSeq(entries)
    return yaml_text(document, offset=2) if len(document) > 1 else ""


def _by_channel(system: ScannedSystem) -> Iterator[tuple[tuple[str, str], list[tuple[str, list[ChannelEnd]]]]]:
    """Channels in the order of a file of types, each with its types; an end of a type that is not known has none."""
    unknown = {(end.role, end.name, end.node) for end in system.ends if not end.type}
    channels: dict[tuple[str, str], dict[str, list[ChannelEnd]]] = defaultdict(lambda: defaultdict(list))
    for end in system.ends:
        if end.type and (end.role, end.name, end.node) not in unknown:
            channels[end.kind, end.name][end.type].append(end)
    order = list(SECTIONS)
    for key in sorted(channels, key=lambda key: (order.index(key[0]), key[1])):
        yield key, sorted(channels[key].items())


def _sides(kind: str, ends: Iterable[ChannelEnd]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    first, second = (
        tuple(sorted({end.node for end in ends if USERS[end.role][1] == side})) for side in ENDS[SECTIONS[kind]]
    )
    return first, second


def _gaps(system: ScannedSystem, folder: str) -> tuple[ScanGap, ...]:
    return tuple(ScanGap(line_of_code(gap.place, folder), gap.sort, gap.text) for gap in system.gaps)


def line_of_code(place: CodePlace, folder: str) -> Place:
    """Return a line of a checkout's file as the user would open it."""
    return Place(placed(place.file, folder), place.line)


def _line(place: Place) -> str:
    return f"{place.file}:{place.line}"


def _printable(text: str) -> str:
    """Without what no XML can hold."""
    return text.translate(UNPRINTABLE)


def _sha256(file: str) -> str:
    try:
        return hashlib.sha256(read_regular(file, MAX_BYTES, partial(InputError, file))).hexdigest()
    except InputError:
        return hashlib.sha256(b"").hexdigest()
