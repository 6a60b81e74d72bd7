"""All messages that an access list of Zenoh names, between two sessions on loopback: what passes, and what has to.

What a message needs was measured on ``eclipse-zenoh`` 1.10.2 by denying one message and flow at a time.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import zenoh

from tests.helpers.access_lists import KEYS

if TYPE_CHECKING:
    from collections.abc import Iterable
    from random import Random

SOME = tuple(key for key in KEYS if key.count("/") < 2)[:9]
OUT = {
    "put": "egress put",
    "delete": "egress delete",
    "query": "egress query",
    "reply": "egress query, ingress reply",
    "token": "egress liveliness_token",
    "token asked for": "egress liveliness_token",
}
"""Of the list of a session: what has to pass for what it sends; a reply is that to its own query."""
IN = {
    "put": "egress declare_subscriber, ingress put",
    "delete": "egress declare_subscriber, ingress delete",
    "query": "egress declare_queryable, ingress query",
    "reply": "egress declare_queryable, ingress query, egress reply",
    "token": "egress declare_liveliness_subscriber, ingress liveliness_token",
    "token asked for": "egress liveliness_query, ingress liveliness_token",
}
"""The same for what it gets; a reply is its own."""
THROUGH = {
    "put": "ingress declare_subscriber, ingress put, egress put",
    "delete": "ingress declare_subscriber, ingress delete, egress delete",
    "query": "ingress declare_queryable, ingress query, egress query",
    "reply": "ingress declare_queryable, ingress query, egress query, ingress reply, egress reply",
    "token": "ingress declare_liveliness_subscriber, ingress liveliness_token, egress liveliness_token",
    "token asked for": "ingress liveliness_query, ingress liveliness_token, egress liveliness_token",
}
"""Of the list of a router between two sessions."""
OF = dict.fromkeys(OUT, SOME) | {"token": SOME[::2], "token asked for": SOME[1::2]}
"""The keys of each: a session that is told of a token by itself needs not ask for it."""
Seen = set[tuple[str, str]]
"""(what, key)."""


def with_all_messages(random: Random, access: dict[str, Any]) -> dict[str, Any]:
    """An access list whose rules are about any of the messages."""
    from rosprivacy.ingest.deployed.access_file import MESSAGES

    rules = [
        {**one, "messages": random.sample(MESSAGES, random.randint(3, len(MESSAGES)))} for one in access["rules"][1:]
    ]
    for one in rules:
        if random.random() < 0.5:
            one["key_exprs"] = [*one["key_exprs"], *random.sample(("**", "a/**", "b/**", *SOME), 2)]
    return {**access, "rules": [*access["rules"][:1], *rules]}


def exchanged(sender: Any, receiver: Any, expected: Seen, mark: str) -> Seen:
    """What comes of one session to another when it sends all messages, until all that is expected is there.

    Parameters
    ----------
    mark
        What samples and queries carry, so that no others are taken for them.
    """
    seen: Seen = set()

    def hear(sample: Any) -> None:
        if sample.attachment and sample.attachment.to_string() == mark:
            seen.add(("put" if sample.kind == zenoh.SampleKind.PUT else "delete", str(sample.key_expr)))

    def answer(query: Any) -> None:
        if query.attachment and query.attachment.to_string() == mark:
            seen.add(("query", str(query.key_expr)))
            query.reply(query.key_expr, b"")

    def notice(sample: Any) -> None:
        if sample.kind == zenoh.SampleKind.PUT:
            seen.add(("token", str(sample.key_expr)))

    remote = zenoh.Locality.REMOTE
    kept = [receiver.declare_subscriber(key, hear, allowed_origin=remote) for key in SOME]
    kept += [receiver.declare_queryable(key, answer, allowed_origin=remote) for key in SOME]
    kept += [receiver.liveliness().declare_subscriber(key, notice, history=True) for key in OF["token"]]
    kept += [sender.liveliness().declare_token(key) for key in SOME]
    time.sleep(0.05)  # until they are known, or else it is sent again
    end = time.monotonic() + 10
    seen |= _send(sender, receiver, mark)
    while not expected <= seen and time.monotonic() < end:
        seen |= _send(sender, receiver, mark)
    time.sleep(0.05)
    seen |= _send(sender, receiver, mark)  # now that all is known, whatever else could come
    time.sleep(0.1)
    for one in kept:
        one.undeclare()
    time.sleep(0.05)  # until the tokens are gone
    return set(seen)


def _send(sender: Any, receiver: Any, mark: str) -> Seen:
    """Send all messages; the answers that come to queries."""
    for key in SOME:
        sender.put(key, b"", attachment=mark)
        sender.delete(key, attachment=mark)
    asked = [sender.get(key, attachment=mark, timeout=0.2) for key in SOME]
    tokens = [receiver.liveliness().get(key, timeout=0.2) for key in OF["token asked for"]]
    return _keys("reply", asked) | _keys("token asked for", tokens)


def _keys(what: str, answers: Iterable[Any]) -> Seen:
    return {(what, str(reply.ok.key_expr)) for answer in answers for reply in answer if reply.ok}
