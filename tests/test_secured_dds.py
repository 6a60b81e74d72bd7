"""What Fast DDS holds secured participants to: facts by which we judge what we say of permissions and governance.

Debian's library (2.9) has the security plugins compiled in. Where the standard (DDS-Security 1.1, 9.4.1) says otherwise
than Fast DDS does, a row says so. All on loopback, all at one time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from tests.helpers.keystores import Enclave, Governance, Grant, Rule, TopicRule
from tests.helpers.secured_dds import Trial

if TYPE_CHECKING:
    from tests.helpers.secured_dds import Judge, Outcome

pytestmark = pytest.mark.slow
CHATTER = "rt/chatter"
ELSEWHERE = ((231, 232),)  # domains in which no trial is
EXPIRED = ("2020-01-01T00:00:00", "2021-01-01T00:00:00")
NOT_YET = ("2038-01-01T00:00:00", "2039-01-01T00:00:00")
SROS2 = Governance()
ARRIVES, NOTHING, APART = "arrives", "nothing arrives", "the participants do not meet"
NO_WRITER, NO_READER = "the writer is refused", "the reader is refused"
NOT_THERE, NOT_THERE_TO_READ = "the writer's participant is refused", "the reader's participant is refused"


def allows(*topics: str, **more: Any) -> Rule:
    return Rule(allow=True, publish=topics, **more)


def denies(*topics: str, **more: Any) -> Rule:
    return Rule(allow=False, publish=topics, **more)


def reads(*topics: str, allow: bool = True) -> Rule:
    return Rule(allow=allow, subscribe=topics)


def enclave(*rules: Rule, governance: Governance = SROS2, **more: Any) -> Enclave:
    return Enclave((Grant(rules, **more),), governance)


def writes(*rules: Rule, partition: str = "", governance: Governance = SROS2, **more: Any) -> Trial:
    """A writer with these rules, beside a reader that may read everything everywhere."""
    everything = Rule(allow=True, subscribe=("*",), partitions=("*",) if partition else ())
    reader = enclave(everything, governance=governance)
    return Trial(enclave(*rules, governance=governance, **more), reader, (CHATTER,), partition)


def governed(*rules: TopicRule) -> Trial:
    """A writer and a reader that are granted another topic only, where governance says this."""
    either = enclave(OTHER, governance=Governance(rules))
    return Trial(either, either)


OTHER = Rule(allow=True, publish=("rt/other",), subscribe=("rt/other",))  # without any, no participant may be there
ANYTHING = Rule(allow=True, publish=("*",), subscribe=("*",))
OPEN = enclave(  # strangers may be there, and nothing is signed, encrypted or asked for
    ANYTHING,
    governance=Governance(
        (TopicRule(read=False, write=False, protection="NONE", discovery=False, liveliness=False),),
        join=False,
        unauthenticated=True,
        discovery="NONE",
        liveliness="NONE",
        rtps="NONE",
    ),
)
WRITER, READER = enclave(allows(CHATTER)), enclave(reads(CHATTER))
ELSEWHERE_ONLY = allows(CHATTER, domains=ELSEWHERE)
ROWS = {
    # Names, and the default.
    "allow": (writes(allows(CHATTER)), ARRIVES),
    "allow by *": (writes(allows("rt/ch*")), ARRIVES),
    "allow by ?": (writes(allows("rt/chatte?")), ARRIVES),
    "allow by [a-s]": (writes(allows("rt/chatte[a-s]")), ARRIVES),
    "not by [!a-s]": (writes(allows("rt/chatte[!a-s]")), NO_WRITER),
    "wrong topic": (writes(OTHER), NO_WRITER),
    "granted to read, not to write": (writes(reads(CHATTER)), NO_WRITER),
    "reader: wrong topic": (Trial(WRITER, enclave(OTHER)), NO_READER),
    "default allow": (writes(OTHER, default="ALLOW"), NO_WRITER),  # the standard: allowed
    "default allow, no rule": (writes(default="ALLOW"), NOT_THERE),  # the standard: allowed
    "default allow, deny": (writes(OTHER, denies(CHATTER), default="ALLOW"), NO_WRITER),
    # The first rule that matches wins.
    "deny, then allow": (writes(denies(CHATTER), allows(CHATTER)), NO_WRITER),
    "allow, then deny": (writes(allows(CHATTER), denies(CHATTER)), ARRIVES),
    "deny *, then allow": (writes(denies("*"), allows(CHATTER)), NO_WRITER),
    "reader: deny, then allow": (Trial(WRITER, enclave(reads(CHATTER, allow=False), reads(CHATTER))), NO_READER),
    # Validity and subjects: of the grants that hold now and name the subject, the first one counts.
    "expired": (writes(allows(CHATTER), valid=EXPIRED), NOT_THERE),
    "not yet valid": (writes(allows(CHATTER), valid=NOT_YET), NOT_THERE),
    "reader: expired": (Trial(WRITER, enclave(reads(CHATTER), valid=EXPIRED)), NOT_THERE_TO_READ),
    "subject of another": (writes(allows(CHATTER), subject="/somebody/else"), NOT_THERE),
    "second grant of a subject": (Trial(Enclave((Grant((OTHER,)), Grant((allows(CHATTER),)))), READER), NO_WRITER),
    "after an expired grant": (
        Trial(Enclave((Grant((OTHER,), valid=EXPIRED), Grant((allows(CHATTER),)))), READER),
        ARRIVES,
    ),
    # Domains: the writer itself does not look at those of rules, its reader does.
    "allow in another domain": (writes(OTHER, ELSEWHERE_ONLY), NOTHING),
    "deny in another domain": (
        writes(denies(CHATTER, domains=ELSEWHERE), allows(CHATTER)),
        NO_WRITER,
    ),  # the standard: allowed
    "nothing but in another domain": (writes(ELSEWHERE_ONLY), APART),
    "governance of another domain": (writes(allows(CHATTER), governance=Governance(domains=ELSEWHERE)), APART),
    # Partitions.
    "partition": (writes(allows(CHATTER, partitions=("a",)), partition="a"), ARRIVES),
    "wrong partition": (writes(allows(CHATTER, partitions=("a",)), partition="b"), NO_WRITER),
    "partition, none in the rule": (writes(allows(CHATTER), partition="a"), NO_WRITER),
    "no partition, one in the rule": (writes(allows(CHATTER, partitions=("a",))), NO_WRITER),
    # Governance.
    "governance: off": (governed(TopicRule(read=False, write=False)), ARRIVES),
    "governance: write off": (governed(TopicRule(write=False)), NO_READER),
    "governance: read off": (governed(TopicRule(read=False)), NO_WRITER),
    "governance: off for the topic": (governed(TopicRule(CHATTER, read=False, write=False), TopicRule()), ARRIVES),
    "governance: first rule wins": (governed(TopicRule(), TopicRule(CHATTER, read=False, write=False)), NO_WRITER),
    "governance: no rule for the topic": (governed(TopicRule("rt/other")), NO_WRITER),
    # Signatures, and who has none.
    "identity of a stranger": (Trial(Enclave((Grant((allows(CHATTER),)),), identity_by="stranger"), READER), NOT_THERE),
    "signed by a stranger": (
        Trial(Enclave((Grant((allows(CHATTER),)),), permissions_by="stranger"), READER),
        NOT_THERE,
    ),
    "writer without security": (Trial(None, READER), APART),
    "reader without security": (Trial(WRITER, None), APART),
    "neither has security": (Trial(None, None), ARRIVES),
    "open domain": (Trial(OPEN, OPEN), ARRIVES),
    "open domain, writer without security": (Trial(None, OPEN), APART),  # the standard: they meet
    "open domain, reader without security": (Trial(OPEN, None), APART),  # the standard: they meet
}
MANY = ("rt/a", "rt/ab", "rt/abc", "rt/b", "rt/c")


@pytest.fixture(scope="module")
def outcomes(judge: Judge) -> dict[str, Outcome]:
    several = Trial(enclave(denies("rt/ab?"), allows("rt/a*", "rt/b")), enclave(reads("rt/a*", "rt/c")), MANY)
    return judge({name: trial for name, (trial, _) in ROWS.items()} | {"several": several})


@pytest.mark.parametrize("name", ROWS)
def test_what_two_participants_may_exchange(outcomes: dict[str, Outcome], name: str) -> None:
    print(f"{name}: {outcomes[name].said(CHATTER)}")
    assert outcomes[name].said(CHATTER) == ROWS[name][1]


def test_of_several_topics_of_one_pair_those_arrive_that_both_may(outcomes: dict[str, Outcome]) -> None:
    several = outcomes["several"]
    assert several.writers == {"rt/a", "rt/ab", "rt/b"}
    assert several.readers == {"rt/a", "rt/ab", "rt/abc", "rt/c"}
    assert several.arrived == {"rt/a", "rt/ab"}
