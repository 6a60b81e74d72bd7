"""Keystores that real middlewares judge: how far data come with Fast DDS and with Cyclone DDS, and what we say.

What one of them lets pass, we call a flow, or we tell the line of governance by which it passes. Where we say more than
both let pass, the row says why: in doubt a flow is taken to be allowed.
"""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from tests.helpers.keystores import governance, grant, joined, permissions, rule, topic_rule
from tests.helpers.secured_dds import ANY_DOMAIN, CONTROL, CONTROL_RULE, Trial

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

LABELS = "labels: 1\nnodes: {/writer: {source: [Video]}, /reader: {leak: [Video]}}\n"
CHATTER = "rt/chatter"
ELSEWHERE = "<id>99</id>"  # a domain in which no trial is
FROM_ZERO = "<id_range><min>0</min></id_range>"  # in the standard all domains, to both middlewares one
EXPIRED, NOT_YET = ("2020-01-01", "2021-01-01"), ("2059-01-01", "2060-01-01")
ARRIVES, NOTHING, APART = "arrives", "nothing arrives", "the participants do not meet"
NO_WRITER, NO_READER = "the writer is refused", "the reader is refused"
NOT_THERE, NOT_THERE_TO_READ = "the writer's participant is refused", "the reader's participant is refused"
FLOW, NONE, REFUSED = "a flow", "no flow", "refused"
TOLD = "no flow, but told"  # of a line of governance by which it passes


class Row(NamedTuple):
    """A trial, how far data come, what we say, and why we say something else, if we do.

    Attributes
    ----------
    other
        How far data come with Cyclone DDS, if not as far as with Fast DDS.
    """

    trial: Trial
    fast_dds: str
    ours: str
    why: str = ""
    other: str = ""

    @property
    def cyclone(self) -> str:
        """How far data come with Cyclone DDS."""
        return self.other or self.fast_dds


def allows(*topics: str, domains: str = ANY_DOMAIN, partition: str = "") -> str:
    return rule("allow", publish=topics, domains=domains, partition=partition)


def denies(*topics: str, domains: str = ANY_DOMAIN) -> str:
    return rule("deny", publish=topics, domains=domains)


def reads(*topics: str, kind: str = "allow", partition: str = "") -> str:
    return rule(kind, subscribe=topics, domains=ANY_DOMAIN, partition=partition)


def writer(*rules: str, **more: Any) -> str:
    return permissions(grant("/writer", *rules, **more))


def reader(*rules: str, **more: Any) -> str:
    return permissions(grant("/reader", *rules, **more))


WRITER, READER = writer(allows(CHATTER)), reader(reads(CHATTER))
OTHER_WRITER, OTHER_READER = writer(allows("rt/written")), reader(reads("rt/read"))  # who has no rule may not be there
ELSEWHERE_ONLY = allows(CHATTER, domains=ELSEWHERE)


def writes(*rules: str, **more: Any) -> Trial:
    """A writer with these rules, beside a reader that may read."""
    return Trial(writer(*rules, **more), READER)


def governed(*rules: str) -> Trial:
    """A writer and a reader that are granted other topics only, where governance says this."""
    return Trial(OTHER_WRITER, OTHER_READER, governance(CONTROL_RULE, *rules, domains=ANY_DOMAIN))


def within(partition: str, *rules: str) -> Trial:
    """A writer and a reader in a partition."""
    return replace(writes(*rules), reader=reader(reads(CHATTER, partition="*")), partition=partition)


OFF = ("false", "false")
GOVERNED = governance(CONTROL_RULE, topic_rule(), domains=ANY_DOMAIN)
PROTECTED = governance(CONTROL_RULE, topic_rule(), domains=FROM_ZERO)
UNPROTECTED, OFF_FROM_ZERO = (
    governance(CONTROL_RULE, topic_rule("*", *OFF), domains=domains) for domains in (ANY_DOMAIN, FROM_ZERO)
)
OPEN = Trial(
    writer(allows("*")),
    reader(reads("*")),
    governance(
        *[topic_rule(name, *OFF, metadata="NONE", data="NONE", discovery="false") for name in (CONTROL, "*")],
        rtps="NONE", unauthenticated="true", joining="false", discovery="NONE", domains=ANY_DOMAIN,
    ),
)  # fmt: skip
ROWS = {
    # Names, and the default.
    "allow": Row(writes(allows(CHATTER)), ARRIVES, FLOW),
    "allow by *": Row(writes(allows("rt/ch*")), ARRIVES, FLOW),
    "allow by ?": Row(writes(allows("rt/chatte?")), ARRIVES, FLOW),
    "allow by [a-s]": Row(writes(allows("rt/chatte[a-s]")), ARRIVES, FLOW),
    "not by [!a-s]": Row(writes(allows("rt/chatte[!a-s]")), NO_WRITER, NONE),
    "not by a part of the name": Row(writes(allows("rt/chat")), NO_WRITER, NONE),
    "wrong topic": Row(writes(allows("rt/other")), NO_WRITER, NONE),
    "granted to read, not to write": Row(writes(reads(CHATTER)), NO_WRITER, NONE),
    "reader: wrong topic": Row(Trial(WRITER, OTHER_READER), NO_READER, NONE),
    "default allow": Row(
        writes(allows("rt/other"), default="ALLOW"), NO_WRITER, FLOW, "the standard allows it", ARRIVES
    ),
    "default allow, no rule": Row(writes(default="ALLOW"), NOT_THERE, FLOW, "the standard allows it", ARRIVES),
    "default allow, deny": Row(writes(allows("rt/a"), denies(CHATTER), default="ALLOW"), NO_WRITER, NONE),
    # The first rule that matches wins.
    "deny, then allow": Row(writes(denies(CHATTER), allows(CHATTER)), NO_WRITER, NONE),
    "allow, then deny": Row(writes(allows(CHATTER), denies(CHATTER)), ARRIVES, FLOW),
    "deny *, then allow": Row(writes(denies("*"), allows(CHATTER)), NO_WRITER, NONE),
    "deny another, then allow *": Row(writes(denies("rt/chatte"), allows("*")), ARRIVES, FLOW),
    "reader: deny, then allow": Row(
        Trial(WRITER, reader(reads(CHATTER, kind="deny"), reads(CHATTER))), NO_READER, NONE
    ),
    # Validity and subjects.
    "expired": Row(writes(allows(CHATTER), validity=EXPIRED), NOT_THERE, FLOW, "it can be renewed"),
    "not yet valid": Row(writes(allows(CHATTER), validity=NOT_YET), NOT_THERE, FLOW, "it will be valid"),
    "reader: expired": Row(
        Trial(WRITER, reader(reads(CHATTER), validity=EXPIRED)), NOT_THERE_TO_READ, FLOW, "it can be renewed"
    ),
    "subject of another": Row(Trial(permissions(grant("/else", allows(CHATTER))), READER), NOT_THERE, REFUSED),
    "second grant of a subject": Row(
        Trial(permissions(grant("/writer", allows("rt/a")), grant("/writer", allows(CHATTER))), READER),
        NO_WRITER, FLOW, "it may count one day",
    ),
    "after an expired grant": Row(
        Trial(permissions(grant("/writer", validity=EXPIRED), grant("/writer", allows(CHATTER))), READER),
        ARRIVES, FLOW, other=NOT_THERE,
    ),
    "deny in an expired grant": Row(
        Trial(permissions(grant("/writer", denies("*"), validity=EXPIRED), grant("/writer", allows(CHATTER))), READER),
        ARRIVES, FLOW, other=NOT_THERE,
    ),
    # Domains: with Fast DDS a participant does not look at those of its own rules, the other one does.
    "allow in another domain": Row(writes(allows("rt/a"), ELSEWHERE_ONLY), NOTHING, NONE, other=NO_WRITER),
    "deny in another domain": Row(
        writes(denies(CHATTER, domains=ELSEWHERE), allows(CHATTER)), NO_WRITER, FLOW, "the standard allows it", ARRIVES
    ),
    "nothing but in another domain": Row(writes(ELSEWHERE_ONLY), APART, NONE),
    "governance of another domain": Row(
        replace(writes(allows(CHATTER)), governance=governance(domains=ELSEWHERE)), APART, FLOW, "told with its line",
        NOT_THERE,
    ),
    "allow in a range without an end": Row(
        writes(allows("rt/a"), allows(CHATTER, domains=FROM_ZERO)), NOTHING, FLOW, "the standard allows it", NO_WRITER
    ),
    "deny in a range without an end": Row(
        writes(denies(CHATTER, domains=FROM_ZERO), allows(CHATTER)), NO_WRITER, FLOW, "Cyclone DDS allows it", ARRIVES
    ),
    "governance in a range without an end, then off": Row(
        replace(governed(), governance=joined(PROTECTED, UNPROTECTED)), ARRIVES, TOLD, "the declared view"
    ),
    "governance off in a range without an end": Row(
        replace(governed(), governance=joined(OFF_FROM_ZERO, GOVERNED)), NO_WRITER, TOLD, "in the standard it is off"
    ),
    # Partitions: ROS 2 uses the default one.
    "partition": Row(within("a", allows(CHATTER, partition="a")), ARRIVES, FLOW),
    "wrong partition": Row(within("b", allows(CHATTER, partition="a")), NO_WRITER, FLOW, "told with its line"),
    "partition, none in the rule": Row(within("a", allows(CHATTER)), NO_WRITER, FLOW, "ROS 2 uses the default one"),
    "no partition, one in the rule": Row(
        writes(allows(CHATTER, partition="a")), NO_WRITER, FLOW, "told with its line"
    ),
    # Governance.
    "governance: off": Row(governed(topic_rule("*", *OFF)), ARRIVES, TOLD, "the declared view"),
    "governance: write off": Row(governed(topic_rule("*", writing="false")), NO_READER, TOLD, "granted nothing"),
    "governance: read off": Row(governed(topic_rule("*", reading="false")), NO_WRITER, TOLD, "granted nothing"),
    "governance: off for the topic": Row(
        governed(topic_rule(CHATTER, *OFF), topic_rule()), ARRIVES, TOLD, "the declared view"
    ),
    "governance: first rule wins": Row(
        governed(topic_rule(), topic_rule(CHATTER, *OFF)), NO_WRITER, NONE
    ),
    "governance: no rule for the topic": Row(governed(topic_rule("rt/other")), NO_WRITER, NONE),
    "open domain": Row(OPEN, ARRIVES, FLOW),
    # Signatures.
    "identity of a stranger": Row(replace(writes(allows(CHATTER)), named_by="stranger"), NOT_THERE, REFUSED),
    "signed by a stranger": Row(replace(writes(allows(CHATTER)), signed_by="stranger"), NOT_THERE, REFUSED),
}  # fmt: skip
# Who has no security, and so no keystore of which we could say something: with Fast DDS, with Cyclone DDS.
STRANGERS = {
    "neither has security": (Trial(None, None), ARRIVES, ARRIVES),
    "writer without security": (Trial(None, READER), APART, APART),
    "reader without security": (Trial(WRITER, None), APART, APART),
    "open domain, writer without security": (replace(OPEN, writer=None), APART, ARRIVES),  # the standard: they meet
    "open domain, reader without security": (replace(OPEN, reader=None), APART, ARRIVES),  # the standard: they meet
}
MANY = ("rt/a", "rt/ab", "rt/abc", "rt/b", "rt/c")
SEVERAL = Trial(writer(denies("rt/ab?"), allows("rt/a*", "rt/b")), reader(reads("rt/a*", "rt/c")), topics=MANY)
TRIALS = {
    **{name: row.trial for name, row in ROWS.items()},
    **{name: trial for name, (trial, _, _) in STRANGERS.items()},
    "several": SEVERAL,
}


def ours(cli: Cli, keystore: Path, domain: int) -> str:
    """What ``analyze`` says of data from the writer to the reader."""
    (keystore / "labels.yaml").write_text(LABELS)
    done = cli("analyze", keystore, "--domain", str(domain), "-l", keystore / "labels.yaml", "-f", "json")
    if done.returncode == 2:
        return REFUSED
    document = json.loads(done.stdout)
    if document["findings"]:
        return FLOW
    said = [one["message"] for one in document["diagnostics"] if CONTROL not in one["message"]]
    if not any("permissions are not asked" in message for message in said):
        return NONE
    assert document["verdict"] == "undetermined"
    return TOLD


def enforced(cli: Cli, keystore: Path, domain: int) -> str:
    """What it says of them in the enforced view (S6)."""
    done = cli("analyze", keystore, "--domain", str(domain), "-l", keystore / "labels.yaml", "--view", "enforced", "-q")
    return FLOW if done.returncode == 1 else NONE
