"""Random systems as people write them: a policy, labels, decisions; and an answer as something to compare."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from hypothesis import strategies as st

import rosprivacy
from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.result import Result

NODES = tuple(f"/n{i}" for i in range(5))
TOPICS = ("/a", "/b", "/c", "/a*", "/parameter_events")
ROLES = (
    "{source: [Video]}", "{source: [Voice], leak: [Video]}", "{leak: [Biometric]}", "{leak: [Video, Voice]}",
    "{sanitizer: {Video: pseudonymise}, note: a filter, author: Ada Judge}", "{sanitizer: {Voice: drop}}", "conduit",
    "{derives: [{from: Video, to: FaceTemplate}]}",
)  # fmt: skip
WHY = (  # of the system, of nodes, of the storage
    ((), "", ""),
    (
        ("controller: Haven Home", "dpo: Ada Officer"),
        "",
        ", operator: Us, recipient: processor, contract: Art. 28",
    ),
    (("purpose: [care, safety]", "legal_basis: {Video: 6(1)(f)}"), "subjects: [residents]", ", purpose: proof"),
    (("legal_basis: 6(1)(e)",), "purpose: {Video: [counting], PersonalData: guiding}", ", legal_basis: 6(1)(c)"),
    ((), "legal_basis: [6(1)(a), 9(2)(a)]", ", legal_basis: [6(1)(b), 46(2)(c)]"),
    (("purpose: safety",), "purpose: lighting, legal_basis: {FaceTemplate: 9(2)(h)}", ""),
)
CHANNEL = ("mundane", "sensitive", "{only: [Video], note: checked}", "{never: [Voice]}")


SURROUNDINGS: tuple[tuple[list[str], str], ...] = (  # of the system, of one source
    ([], ""), (["context: [care]"], ""), (["context: [union, care]", "country: FR"], "context: school, "),
    (["country: DE"], "context: [worship, workplace], "), ([], "context: public-space, "),
    (["country: US", "gdpr: {established: no}"], ""),
    (["country: JP", "gdpr: {established: false, targeted: false}"], "context: care, "),
)  # fmt: skip


@dataclass(frozen=True)
class Written:
    """The texts of a policy and of a label file, and which leaks somebody accepts."""

    policy: str
    labels: str
    accepted: tuple[str, ...]

    def write(self, folder: Path, name: str) -> tuple[str, str]:
        """Return the names of the two files."""
        (folder / f"{name}.xml").write_text(self.policy, "utf-8")
        (folder / f"{name}.yaml").write_text(self.labels, "utf-8")
        return f"{name}.xml", f"{name}.yaml"

    def decisions(self, found: Sequence[Finding]) -> str:
        """The text of a decisions file: accepted leaks, and a finding of which everything has changed since."""
        said = {"decision": "accept", "reason": "agreed", "owner": "Ada Judge"}
        then = {"view": "enforced", "path": ["/gone", "/away"], "disjoint_paths": 99}
        of_old = [{"id": finding.id, "decision": "mitigate", "made_about": then} for finding in found[1:2]]
        return json.dumps({"decisions": 1, "findings": [*of_old, *({"leak": leak, **said} for leak in self.accepted)]})


@st.composite
def written(draw: st.DrawFn) -> Written:
    """A storage behind a node, DENYs, a wildcard, a standard channel."""
    names = st.sets(st.sampled_from((*TOPICS, "!/b")), max_size=3).map(lambda some: ",".join(sorted(some)))
    profiles = {node: f"{node}>{draw(names)}<{draw(names)}" for node in NODES}
    roles = {node: draw(st.sampled_from(ROLES)) for node in draw(st.sets(st.sampled_from(NODES), min_size=3))}
    roles["/n0"] = ROLES[0]
    used = sorted({name for text in profiles.values() for name in TOPICS[:3] if name in text.replace("/a*", "")})
    channels = {name: draw(st.sampled_from(CHANNEL)) for name in used if draw(st.booleans())}
    behind = draw(st.sampled_from(NODES))
    country = draw(st.sampled_from(("DE", "US")))
    accepted = draw(st.sets(st.sampled_from((*NODES, "disk")), min_size=2, max_size=4))
    top, of_node, of_disk = draw(st.sampled_from(WHY))
    for name in [name for name in sorted(roles) if of_node and roles[name].endswith("}")][:2]:
        roles[name] = f"{roles[name][:-1]}, {of_node}}}"
    where, own = SURROUNDINGS[(len(roles) + len(accepted)) % len(SURROUNDINGS)]  # no draw more
    lines = ["labels: 1", *top, *where, "nodes:", *(f"  {name}: {said}" for name, said in sorted(roles.items()))]
    lines += ["channels:", *(f"  {name}: {said}" for name, said in channels.items())] if channels else []
    lines += ["elements:", f"  disk: {{kind: storage, country: {country}, retention: P3D{of_disk}}}"]
    lines += ["flows:", f"  - {{from: {behind}, to: disk}}"]
    lines = [line.replace("  /n0: {", f"  /n0: {{{own}") for line in lines]
    return Written(policy(*profiles.values()), "\n".join([*lines, ""]), tuple(sorted(accepted)))


def told(result: Result) -> dict[str, Any]:
    """The document, without which robot it is about and how it was read."""
    document = json.loads(json.dumps(result.document()).replace("robot:", ""))  # in sentences
    for doubt in document["doubts"]:
        doubt.pop("id")  # which holds the robot's name
    patterns = {row["finding"]: row["id"] for row in (document.pop("fleet", None) or {}).get("patterns", ())}
    assumptions = document["assumptions"]
    for way in ("fleet", "database"):
        assumptions.pop(way, None)
    document["diagnostics"] = sorted(document["diagnostics"], key=json.dumps)
    plain: dict[str, Any] = _plain(document, patterns)
    for row in plain.get("register", ()):
        row.pop("id")  # the same
        row.pop("fleet", None)  # on which robots
    for decision in plain.get("decisions", ()):  # sorted by ids, which hold the robot's name
        decision["findings"] = sorted(decision["findings"])
    return plain


def every_answer(formats: Sequence[str], **options: Any) -> list[str]:
    """All that is told of p.xml and l.yaml, or why nothing is."""
    try:
        result = rosprivacy.analyze("p.xml", labels="l.yaml", paths="disjoint", **options)
    except rosprivacy.RosPrivacyError as error:
        return [str(error)]
    try:
        proposals = json.dumps(result.proposals())
    except rosprivacy.RosPrivacyError as error:
        proposals = str(error)
    why = [repr(result.why_not("/n0", node)) for node in NODES[1:3]]
    return [*(str(result.to(name)) for name in formats), proposals, *why]


def _plain(value: Any, ids: dict[str, str]) -> Any:
    if isinstance(value, dict):
        return {key: "" if key == "robot" else _plain(inner, ids) for key, inner in value.items()}
    if isinstance(value, list):
        return [_plain(inner, ids) for inner in value]
    return ids.get(value, value) if isinstance(value, str) else value
