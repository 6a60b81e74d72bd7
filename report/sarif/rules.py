"""The kinds of findings for readers of SARIF: what each means and what a person can do, in words without a verdict.

In: the kind of a finding. Out: a ``reportingDescriptor``. A kind that is not known here gets a plain text of its own,
so that none is left out.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import ACCESS_GAP, BAG_GAP, OBSERVATION_GAP, UNREAD_FILE
from rosprivacy.report.catalogs.words import IN_ENGLISH

if TYPE_CHECKING:
    from collections.abc import Iterable

WARNING, NONE = "warning", "none"
NO_VERDICT = "The labels are a person's word, and a path can be lawful: this is no legal verdict."
DECIDE = "If the path is to stay, write down who decided so, why, and on which legal basis."
CLEAN = "Can the data be cleaned before: anonymised, aggregated, dropped? Label the node that does it as sanitizer."
ASSESS = (
    "Read the path step by step: is each label right, and is each step needed?",
    "If a step is not needed, take the grant out of the policy, or deny it.",
    CLEAN,
    DECIDE,
)


@dataclass(frozen=True, slots=True)
class SarifRule:
    """What a kind of finding means.

    Attributes
    ----------
    id
        Stable; the kind itself.
    name
        For programs, in Pascal case.
    short, full
        One sentence; some more.
    steps
        What a person can do about it.
    level
        Of its results by default.
    """

    id: str
    name: str
    short: str
    full: str
    steps: tuple[str, ...] = ASSESS
    level: str = WARNING


RULES = (
    SarifRule(
        "disclosure",
        "PersonalDataDisclosure",
        "Personal data can reach a place that lets it out: a path to assess.",
        "A node that brings personal data in and a place that lets it out of the system are connected by steps that "
        "the policies allow. The line is the last one that lets the data in there.",
    ),
    SarifRule(
        "storage-limitation",
        "PersonalDataStorage",
        "Personal data can reach a storage that keeps it without a stated limit, or longer than its kind may be kept.",
        "A storage that personal data can reach states no retention, or a longer one than the labels allow for that "
        "kind of data.",
        (
            "State how long the storage keeps each kind of data.",
            "If it is too long, shorten it, or let only other data go there.",
            CLEAN,
            DECIDE,
        ),
    ),
    SarifRule(
        "third-country-transfer",
        "PersonalDataTransfer",
        "Personal data can reach a recipient outside the European Economic Area with no stated basis for the transfer.",
        "An element in a country outside the European Economic Area can get personal data, and neither a decision that "
        "the country is adequate nor a safeguard is stated for it.",
        ("State the basis of the transfer, or the country if it is another.", *ASSESS),
    ),
    SarifRule(
        "unprotected-channel",
        "PersonalDataUnprotected",
        "Personal data flows on a channel that others on the network can read.",
        "The governance of DDS-Security does not have the channel encrypted, or lets a participant without a "
        "certificate join. Data that is signed only can be read, too.",
        (
            "Set data_protection_kind or metadata_protection_kind there to ENCRYPT, and sign the governance anew.",
            "Set allow_unauthenticated_participants to false.",
            CLEAN,
            DECIDE,
        ),
    ),
)
UNREVIEWED = SarifRule(
    "unreviewed-element",
    "PersonalDataNotReviewed",
    "Personal data reaches a node for which no label answers in full: a question to answer.",
    "The node is among those that data reaches before any other that nobody has reviewed. The analysis lets the data "
    "pass there. Until a person has looked, nobody knows what becomes of it.",
    (
        "Look up what the node does with the data, and say so in a label: conduit, sanitizer, leak, or what it makes.",
        "Then analyse again: further nodes may come into view.",
    ),
    NONE,
)
BEYOND_PROFILE = SarifRule(
    "beyond-profile",
    "PersonalDataBeyondProfile",
    "Personal data can reach a place only if a node does what another profile of its enclave allows.",
    "The middleware holds an enclave to what its profiles allow together, not each node to its own profile. If a node "
    "does not keep to its profile, by a fault or an attack, the path is open. It counts for no verdict: the answer of "
    "record is what profiles declare.",
    (
        "Split the enclave, or move one profile to an enclave of its own, as the result says.",
        "A DENY holds for the whole enclave: who rightly has the grant loses it, too.",
        DECIDE,
    ),
    "note",
)
NOTHING_FOLLOWED = SarifRule(
    "no-data-followed",
    "PersonalDataNotFollowed",
    "No data was followed: that nothing is found says nothing about the system.",
    "No label names a source of the kinds of data that were asked for, or what the sources bring in goes nowhere, "
    "or to standard channels only, so there was nothing to follow.",
    ("Name the nodes that bring personal data in, in a label file: rosprivacy labels --init writes a first one.",),
)
NO_LEAK = SarifRule(
    "no-leak-named",
    "PersonalDataLeakNotNamed",
    "No label says where data gets out: that nothing is found says nothing about the system.",
    "Everything that data gets to is reviewed. But no label says of any element that it is a leak, or that it is none.",
    ("Name what lets data out (leak: [Video]) in a label file; if nothing does, say so at a node that might (none).",),
)


EARLIER = {  # rules that had an id before there was one list of doubts: viewers know results by it
    UNREAD_FILE: "files-not-read",
    OBSERVATION_GAP: "observation-gaps",
    BAG_GAP: "bag-gaps",
    ACCESS_GAP: "access-gaps",
}


def rule_of_doubt(name: str, *, breaks: bool) -> SarifRule:
    """Return the rule of a sort of doubts: a warning where it breaks the verdict, a note where it rides on it.

    >>> rule_of_doubt("no-reader", breaks=False).name
    'DoubtNoReader'
    """
    short, remedy = (IN_ENGLISH(f"doubt.{name}.{part}") for part in ("title", "do"))
    camel = "Doubt" + "".join(part.capitalize() for part in name.split("-"))
    full = f"{short}: that nothing is found does not say that there is nothing."
    steps = (f"{remedy[:1].upper()}{remedy[1:]}.",)
    return SarifRule(EARLIER.get(name, f"doubt-{name}"), camel, f"{short}.", full, steps, WARNING if breaks else "note")


def rule_of(kind: str) -> SarifRule:
    """Return the rule of a kind of finding.

    >>> rule_of("disclosure").name
    'PersonalDataDisclosure'
    >>> rule_of("some new kind").id
    'some-new-kind'
    """
    identifier = re.sub(r"[^a-z0-9]+", "-", kind.casefold()).strip("-") or "finding"
    known = {rule.id: rule for rule in RULES}
    name = "PersonalData" + "".join(part.capitalize() for part in identifier.split("-"))
    short = f"Personal data can reach a place that it perhaps should not: {shown(kind)}."
    return known.get(identifier) or SarifRule(identifier, name, short, short)


def descriptors(rules: Iterable[SarifRule]) -> list[dict[str, Any]]:
    """Return rules as SARIF's ``reportingDescriptor``; at most 10 tags are shown, so there are few."""
    return [
        {
            "id": rule.id,
            "name": rule.name,
            "shortDescription": {"text": rule.short},
            "fullDescription": {"text": f"{rule.full} {NO_VERDICT}"},
            "help": {
                "text": "\n".join(
                    [rule.full, "", "What to do:", *(f"- {step}" for step in rule.steps), "", NO_VERDICT]
                ),
                "markdown": "\n".join(
                    [rule.full, "", "**What to do**", "", *(f"- {step}" for step in rule.steps), "", f"*{NO_VERDICT}*"]
                ),
            },
            "defaultConfiguration": {"level": rule.level},
            "properties": {"tags": ["privacy", "personal-data"]},
        }
        for rule in rules
    ]
