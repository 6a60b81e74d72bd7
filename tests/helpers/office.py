"""A robot in an office, with what people decided of it and answered."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import yaml

import rosprivacy
from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.result import Result


POLICY = policy(
    "camera>/image<", "mic>/audio<", "emotion>/mood</image", "blur>/blurred</image",
    "recorder></image,/mood", "trainer></blurred", "teleop></image,/audio",
)  # fmt: skip
LABELS = """labels: 1
country: DE
context: workplace
controller: Example House
dpo: officer-1
nodes:
  /camera: {source: [Video], subjects: [employees, visitors], purpose: protection, legal_basis: ["6(1)(f)"]}
  /mic: {source: [Voice], subjects: [callers]}
  /emotion: {derives: [{from: Video, to: EmotionEstimate}], sanitizer: {Video: drop}}
  /blur: {sanitizer: {Video: pseudonymise}}
  /recorder: conduit
  /trainer: conduit
  /teleop: conduit
channels: {/image: sensitive, /audio: sensitive, /mood: sensitive, /blurred: sensitive}
elements:
  archive: {kind: storage, country: US, retention: {Video: P90D, PersonalData: P1Y}, encrypted: false,
            operator: Cloud A, recipient: processor, contract: contract-1, transfer: standard-clauses}
  disk: {kind: storage, country: IN, retention: P30D, backups: P7D, operator: Data B, recipient: processor,
         transfer: none}
  training set: {kind: storage, country: DE, encrypted: true, recipient: third-party}
  cabin: {kind: person, country: TN, operator: Teleop C, recipient: processor, transfer: derogation}
flows:
  - {from: /recorder, to: archive}
  - {from: /recorder, to: disk}
  - {from: /trainer, to: training set}
  - {from: /teleop, to: cabin}
"""
LANGUAGES = ("en", "de", "fr")
LONG = " ".join(f"word{n}" for n in range(80))  # longer than a name that is shown
DECISIONS: list[dict[str, Any]] = [
    {"leak": "cabin", "category": "Video", "decision": "mitigate", "reason": f"Blur it first: {LONG}",
     "owner": "Bob Fixer", "expires": "2099-05-06", "ticket": "ROB-17"},
    {"leak": "disk", "category": "Video", "decision": "accept-on-condition", "reason": "needed",
     "condition": "clauses are signed", "owner": "Cleo Clerk", "expires": "2099-07-08"},
    {"leak": "cabin", "category": "Voice", "decision": "accept", "reason": f"They asked for it: {LONG}",
     "owner": "Ada Judge", "legal_basis": ["6(1)(a)", "49(1)(a)"], "expires": "2099-01-02"},
]  # fmt: skip
OF_ALL = {
    "sign.purpose": "remote help <now>", "sign.controller": "House & Co", "sign.basis": "agreed by the council",
    "sign.necessity": "no other\nway", "sign.risks": "faces abroad", "sign.residual": "small after blurring",
    "sign.consultation": "not needed", "sign.measures": "staff is trained", "sign.advice": "stop\nuntil blurred",
    "sign.views": "the works council agrees",
}  # fmt: skip
OF_PATHS = {
    "likelihood": "limited: a contract", "severity": "Important", "whom": "visitors", "measures": "a cover",
    "residual": "a little", "decision": "Dora, go on",
}  # fmt: skip
NO_PLACE = {"sign.name": "Dora", "criterion.5": "no", "risk.0123456789abcdef.severity": "of a path that is gone"}


def decided_office(folder: Path) -> Result:
    """A robot in an office, with a decision of each sort."""
    (folder / "p.xml").write_text(POLICY, "utf-8")
    (folder / "l.yaml").write_text(LABELS, "utf-8")
    (folder / "d.yaml").write_text(yaml.safe_dump({"decisions": 1, "findings": DECISIONS}), "utf-8")
    return rosprivacy.analyze(folder / "p.xml", folder / "l.yaml", decisions=folder / "d.yaml")


def answers_of(result: Result, of_paths: dict[str, str]) -> dict[str, str]:
    """The answers to each field of a report."""
    ids = [finding.id for finding in result.analysis.findings if not finding.dismissed]
    return OF_ALL | {f"risk.{one}.{name}": text for one in ids for name, text in of_paths.items()} | NO_PLACE
