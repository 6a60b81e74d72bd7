"""SROS 2 policy XML -> ``Policy``: what each line grants to each profile.

In: a policy file. Out: grants with file, line, enclave and profile; warnings and notices. All problems of a file are
raised at once.

Source: sros2's ``policy.xsd`` and ``permissions.xsl`` (version 0.2.0) and ROS 2 design, article 181, as measured in
the project's notes. An absent attribute grants nothing; an empty profile is valid, an empty group is not; text is
not trimmed. The dialects that are found in public, which sros2 refuses, are read with a notice.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, InputErrors, PolicyError, shown
from rosprivacy.analysis.model import (
    DEAD_DENY,
    DIALECT,
    DUPLICATE_ENCLAVE,
    EMPTY_GROUP,
    MISTAKEN_TILDE,
    ODD_NAMESPACE,
    SEVERAL_PROFILES,
    Diagnostic,
    Grant,
    Place,
    Policy,
    Profile,
    Severity,
)
from rosprivacy.ingest.policies.names import resolve
from rosprivacy.ingest.policies.xinclude import Documents, Item, has_text

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from lxml import etree

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.model import Seen
    from rosprivacy.ingest.policies.observed_metadata import Key, ObservedMetadata
    from rosprivacy.ingest.policies.scanned_metadata import CodeLine, ScannedMetadata

    Read = tuple[Mapping[Key, Seen], Mapping[str, str]]  # when grants were seen; which profiles are of no node

VERSIONS = ("0.1.0", "0.2.0")
ROLES = {
    "topics": ("topic", ("publish", "subscribe")),
    "services": ("service", ("reply", "request")),
    "actions": ("action", ("call", "execute")),
}
PARENTS = {  # where each element belongs, for messages
    "enclaves": "policy", "enclave": "enclaves", "contexts": "policy", "context": "contexts",
    "profiles": "enclave", "profile": "profiles", "topics": "profile", "services": "profile",
    "actions": "profile", "topic": "topics", "service": "services", "action": "actions",
}  # fmt: skip
FRAGMENTS = frozenset(PARENTS)


class NotAPolicyError(PolicyError):
    """The root element is not ``<policy>``: a fragment that policies include, or another format.

    Attributes
    ----------
    grants
        (line, kind, role) of what it would grant or deny if a policy included it.
    includes
        Whether it is a fragment with includes, which can bring more.
    deployed
        Whether it is permissions or governance of DDS-Security.
    """

    grants: frozenset[tuple[int, str, str]] = frozenset()
    includes: bool = False
    deployed: bool = False


def read_policy(file: str, *, include_root: str | None = None, bounds: Bounds = BOUNDS) -> Policy:
    """Read one policy file with all that it includes.

    Parameters
    ----------
    file
        Path, kept as it is for messages and provenance.
    include_root
        Folder tree that includes may read from; the policy's own folder by default.
    max_bytes
        Bound on the bytes of the policy and its includes together.

    Returns
    -------
    Policy
        Grants in document order; linear in the size of the file and its includes.

    Raises
    ------
    InputErrors
        With every problem of the file, each a ``PolicyError`` of one line.
    """
    documents = Documents(Path(include_root) if include_root else Path(file).parent, bounds)
    root = documents.open(file)
    reader = _PolicyReader(documents, file, bounds)
    reader.policy(root)
    reader.observed()
    problems = [*documents.problems, *reader.problems]
    if problems:
        raise InputErrors(problems)
    return Policy(
        file,
        tuple(sorted(documents.sources.items())),
        tuple(reader.profiles),
        tuple(reader.grants),
        tuple(dict.fromkeys([*documents.diagnostics, *reader.diagnostics])),
    )


@dataclass(eq=False, repr=False)
class _PolicyReader:
    """Walks the document once, from the outside in."""

    documents: Documents
    file: str
    bounds: Bounds
    problems: list[InputError] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    profiles: list[Profile] = field(default_factory=list)
    grants: list[Grant] = field(default_factory=list)
    old: bool = False
    namespace: str = ""
    observations: list[tuple[Place, ObservedMetadata]] = field(default_factory=list)
    scans: list[tuple[Place, ScannedMetadata]] = field(default_factory=list)
    code_by_key: Mapping[Key, tuple[CodeLine, ...]] = field(default_factory=dict)  # of these profiles, too
    seen_by_key: Mapping[Key, Seen] = field(default_factory=dict)  # of the profiles that are being read (rule S16)
    participants: Mapping[str, str] = field(default_factory=dict)  # those of them that are of no node
    first: Place | None = None  # where sros2 has read its fill of this enclave: what follows is dead (rule S5)

    def policy(self, root: Item) -> None:
        if root.tag != "policy":
            raise InputErrors([_not_a_policy(root)])
        self.namespace = root.namespace
        if root.namespace:
            self._dialect(root.place, "default namespace on <policy>: sros2 refuses it; read as if it had none")
        self._version(root)
        self._attributes(root, {"version"})
        sections = list(self._elements(root, {"enclaves", "contexts", "profiles"}))
        if not sections:
            self._problem(root.place, "<policy> without <enclaves>", "add <enclaves> with an <enclave> in it")
        for extra in sections[1:]:
            self._problem(extra.place, f"second <{extra.tag}> under <policy>", "merge them into one")
        for section in sections[:1]:
            self._section(section, root.element.get("version"))

    def _version(self, root: Item) -> None:
        version = root.element.get("version")
        if version is None:
            self._problem(root.place, "<policy> without version", 'write version="0.2.0"')
        elif version not in VERSIONS:
            self._problem(root.place, f"policy version {shown(repr(version))}", 'this reads version="0.2.0"')

    def _section(self, section: Item, version: str | None) -> None:
        if section.tag == "profiles":
            self.old = version == VERSIONS[0]
            message = "policy format 0.1.0: no enclaves; each node is taken as an enclave of its own"
            if not self.old:
                message = (
                    "<profiles> without <enclaves>, as in format 0.1.0: each node is taken as an enclave of its own"
                )
            self._dialect(section.place, message)
            self._profiles(section, None)
            return
        if version == VERSIONS[0]:
            self._dialect(section.place, "version 0.1.0 has no enclaves: read as 0.2.0")
        inner = {"enclaves": "enclave", "contexts": "context"}[section.tag]
        if section.tag == "contexts":
            self._dialect(section.place, "<contexts> of a transitional format: read as <enclaves>")
        self._attributes(section, set())
        enclaves = list(self._elements(section, {inner}))
        if not enclaves:
            self._problem(section.place, f"<{section.tag}> is empty", f"add an <{inner}>")
        seen: dict[str, Place] = {}
        for enclave in enclaves:
            self._enclave(enclave, seen)

    def _enclave(self, enclave: Item, places: dict[str, Place]) -> None:
        self._attributes(enclave, {"path"})
        path = self._required(enclave, "path")
        if path in places:
            message = f"enclave {path} again (first at {places[path]}): sros2 uses the first only"
            self._warning(
                enclave.place, f"{message}; what this one allows is read too, what it denies is not", DUPLICATE_ENCLAVE
            )
        self.first = places.get(path)
        places.setdefault(path, enclave.place)
        groups = list(self._elements(enclave, {"profiles"}))
        if not groups:
            self._problem(enclave.place, f"<{enclave.tag}> without <profiles>", "add <profiles> with a <profile>")
        for extra in groups[1:]:
            message = f"several <profiles> in enclave {path}: DDS uses the first grant only"
            self._warning(
                extra.place, f"{message}; what these allow is read too, what they deny is not", SEVERAL_PROFILES
            )
        for group in groups:
            self._attributes(group, {"type"})
            self._profiles(group, path)
            self.first = self.first or group.place

    def observed(self) -> None:
        """What the observations say that the policy was made of, as one."""
        if self.observations:
            from rosprivacy.ingest.policies.observed_metadata import diagnostics_of, together  # noqa: PLC0415 - light start

            whole = together([observed for _, observed in self.observations])
            self.diagnostics.extend(diagnostics_of(whole, self.observations[0][0]))
        if self.scans:
            from rosprivacy.ingest.policies import scanned_metadata  # noqa: PLC0415 - light start

            place = self.scans[0][0]
            self.diagnostics.extend(scanned_metadata.diagnostics_of([scan for _, scan in self.scans], place))

    def _profiles(self, group: Item, enclave: str | None) -> None:
        self.seen_by_key, self.participants = self._observation(group)
        self.code_by_key = self._scan(group)
        profiles = list(self._elements(group, {"profile"}))
        if not profiles:
            self._problem(group.place, "<profiles> is empty", "add a <profile>")
        for profile in profiles:
            self._profile(profile, enclave)

    def _observation(self, group: Item) -> Read:
        """When the grants of some profiles were seen, if an observation says so, and which profiles are of no node."""
        for child in group.element:
            read = self._seen_in(child, group.file) if child.tag == "metadata" else None
            if read is not None:
                return read
        return {}, {}

    def _scan(self, group: Item) -> Mapping[Key, tuple[CodeLine, ...]]:
        """The lines of code that make the grants of some profiles, if a scan says so."""
        for child in group.element:
            if child.tag == "metadata":
                from rosprivacy.ingest.policies import scanned_metadata  # noqa: PLC0415 - light start

                scanned = scanned_metadata.scanned_in(child)
                if scanned is None:
                    continue
                place = Place(group.file, scanned.sourceline or 0)
                try:
                    self.scans.append((place, scanned_metadata.scan_of(scanned)))
                    return scanned_metadata.code_of(scanned)
                except ValueError as error:
                    self.diagnostics.append(scanned_metadata.unreadable(str(error), place))
        return {}

    def _seen_in(self, metadata: etree._Element, file: str) -> Read | None:
        """What some metadata says of an observation, if it can be read."""
        from rosprivacy.ingest.policies import observed_metadata  # noqa: PLC0415 - light start

        observed = observed_metadata.observed_in(metadata)
        if observed is None:
            return None
        place = Place(file, observed.sourceline or 0)
        try:
            read = observed_metadata.seen_of(observed), observed_metadata.participants_of(observed)
            said = observed_metadata.observed_of(observed)
        except ValueError as error:
            self.diagnostics.append(observed_metadata.unreadable(str(error), place))
            return None
        self.observations.append((place, said))
        return read

    def _profile(self, profile: Item, enclave: str | None) -> None:
        self._attributes(profile, {"ns", "node"})
        namespace, node = self._required(profile, "ns", empty=True), self._required(profile, "node")
        if not namespace.startswith("/") and profile.element.get("ns") is not None:
            message = f"namespace {namespace!r} does not begin with /: its names are taken as sros2 writes them"
            self._warning(profile.place, message, ODD_NAMESPACE)
        name = namespace + node if namespace.endswith("/") else f"{namespace}/{node}"
        owner = Profile(name if enclave is None else enclave, name, profile.place, self.participants.get(name, ""))
        self.profiles.append(owner)
        for group in self._elements(profile, ROLES):
            self._group(group, owner, namespace, node)

    def _group(self, group: Item, owner: Profile, namespace: str, node: str) -> None:
        kind, roles = ROLES[group.tag]
        self._attributes(group, roles)
        granted = [(role, self._rule(group, role)) for role in roles if group.element.get(role) is not None]
        names = list(self._elements(group, (kind,)))
        if not names:
            self._problem(group.place, f"<{group.tag}> is empty", f"add a <{kind}>, or remove it")
        if not granted:
            message = (
                f'<{group.tag}> without {" or ".join(roles)} grants nothing; write {roles[0]}="ALLOW", or remove it'
            )
            self._warning(group.place, message, EMPTY_GROUP)
        enclave, owned = owner.enclave, owner.node
        for item in names:
            name, place = self._name(item, namespace, node), Place(item.file, item.element.sourceline or 0)
            absolute = (item.element.text or "").startswith("/")
            for role, allow in granted:
                dead = self.first is not None
                seen = self.seen_by_key.get((owned, kind, role, name)) if allow and self.seen_by_key else None
                lines = self.code_by_key.get((owned, kind, role, name), ()) if allow and self.code_by_key else ()
                for at, basis in lines or ((place, ""),):
                    self.grants.append(
                        Grant(allow, role, kind, name, enclave, owned, at, self.file, dead, absolute, seen, basis=basis)
                    )
                if dead and not allow:
                    message = f"dead DENY: {role} {name} is not taken away, since sros2 uses the first <profiles> of"
                    message += f" enclave {enclave} only ({self.first}); move it there"
                    self._warning(place, message, DEAD_DENY)

    def _name(self, item: Item, namespace: str, node: str) -> str:
        element = item.element
        if element.keys():
            self._attributes(item, ())
        if len(element):
            for child in self.documents.children(item):
                self._problem(child.place, f"<{shown(child.tag)}> inside <{item.tag}>", "write the name as plain text")
        written = element.text or ""
        if len(written) > self.bounds.name:
            self._problem(item.place, *self.bounds.refusal("name", len(written)))
            written = ""
        if "[" in written and ("[:" in written or "[." in written or "[=" in written):
            self._problem(item.place, f"character class in {shown(repr(written))}", "write a range such as [a-z]")
        if self.old and written.startswith("~") and not written.startswith("~/"):
            written = f"~/{written[1:]}"  # 0.1.0 writes ~name for what 0.2.0 calls ~/name
        if written.startswith("~") and not written.startswith("~/"):
            message = f"{written}: sros2 puts what follows ~ behind the node's name at once; write ~/ before it"
            self._warning(item.place, message, MISTAKEN_TILDE)
        name = resolve(written, namespace, node)
        if not written or written.isspace():
            self._warning(item.place, f"<{item.tag}> without a name: read as sros2 does, as {name}")
        return name

    def _rule(self, group: Item, role: str) -> bool:
        rule = str(group.element.get(role))
        if rule not in ("ALLOW", "DENY"):
            what = f"{role}={shown(repr(rule))} on <{group.tag}>"
            self._problem(group.place, what, "write ALLOW or DENY, in capitals")
        return rule == "ALLOW"

    def _elements(self, parent: Item, allowed: Collection[str]) -> Iterator[Item]:
        """Children that belong here; what does not is a problem, and so is text between them."""
        children = self.documents.children(parent)
        if has_text(parent):
            self._problem(parent.place, f"text between the elements of <{parent.tag}>", "remove it")
        for child in children:
            tag = child.tag
            if child.namespace and child.namespace != self.namespace:
                self._dialect(child.place, f"<{tag}> in a namespace of its own: read as if it had none")
            if tag in allowed:
                yield child
            elif tag != "metadata":
                self._problem(child.place, *_misplaced(child.tag, parent.tag, allowed))

    def _attributes(self, item: Item, allowed: Collection[str]) -> None:
        for name in item.element.keys():  # noqa: SIM118 - an element iterates over its children
            if name not in allowed and not str(name).startswith("{"):  # xml:base, xsi:… say nothing of grants
                takes = " and ".join(sorted(allowed)) or "none"
                what = f"unknown attribute {shown(repr(str(name)))} on <{item.tag}>"
                self._problem(item.place, what, f"it takes {takes}")

    def _required(self, item: Item, attribute: str, *, empty: bool = False) -> str:
        value = item.element.get(attribute)
        if value is None or not (value or empty):
            self._problem(item.place, f"<{item.tag}> without {attribute}", f'add {attribute}="…"')
        return str(value or "")

    def _problem(self, place: Place, problem: str, hint: str) -> None:
        self.problems.append(PolicyError(place.file, place.line, problem, hint))

    def _warning(self, place: Place, message: str, code: str = "") -> None:
        self.diagnostics.append(Diagnostic(place, Severity.WARNING, shown(message), code))

    def _dialect(self, place: Place, message: str) -> None:
        """A form that sros2 refuses."""
        self.diagnostics.append(Diagnostic(place, Severity.NOTICE, shown(message), DIALECT))


def _misplaced(tag: str, parent: str, allowed: Collection[str]) -> tuple[str, str]:
    expected = " or ".join(f"<{name}>" for name in sorted(allowed))
    home = PARENTS.get(tag)
    where = f"it belongs in <{home}>; here comes" if home else "here comes"
    return f"<{shown(tag)}> under <{parent}>", f"{where} {expected}"


def _not_a_policy(root: Item) -> NotAPolicyError:
    what = f"the root element is <{shown(root.tag)}>, not <policy>"
    fragment = root.tag in FRAGMENTS
    hint = "name the policy that includes it" if fragment else "name an SROS 2 policy"
    error = NotAPolicyError(root.file, root.place.line, what, hint)
    error.deployed = root.tag == "dds"
    error.grants = frozenset(_granted(root))
    tags = {str(element.tag).rpartition("}")[2] for element in root.element.iter()} if fragment else set()
    error.includes = "include" in tags
    return error


def _granted(root: Item) -> Iterator[tuple[int, str, str]]:
    """(line, kind, role) of all that would be granted or denied by what stands somewhere in a document."""
    for element in root.element.iter():
        kind, roles = ROLES.get(str(element.tag).rpartition("}")[2], ("", ()))
        for role in roles:
            if element.get(role) is not None:
                yield from (
                    (child.sourceline or 0, kind, role)
                    for child in element
                    if str(child.tag).rpartition("}")[2] == kind
                )
