"""Topics and services that are parts of an action -> the action, as a policy states it (rule S3).

In: endpoints. Out: endpoints. A node that sends goals calls the action, one that takes them executes it; its other
parts go with it. What only listens to feedback or status is no client: it keeps its topic, so that nothing is granted
that nobody did; the analysis takes that topic as the action's response all the same.
"""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.ingest.policies.names import ACTION_SERVICES, ACTION_TOPICS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.ingest.observe.observation import ObservedEndpoint

_PART = re.compile(rf"(.+)/_action/({'|'.join(ACTION_SERVICES + ACTION_TOPICS)})")
_OF_TYPE = ("SendGoal", "GetResult", "FeedbackMessage")
_SIDES = {"publish": "execute", "reply": "execute", "subscribe": "call", "request": "call"}
GOAL = "send_goal"


def whole_actions(endpoints: Iterable[ObservedEndpoint]) -> tuple[ObservedEndpoint, ...]:
    """Return endpoints with the parts of each action together."""
    kept: list[ObservedEndpoint] = []
    parts: dict[tuple[str, str, str, str], list[ObservedEndpoint]] = defaultdict(list)
    for endpoint in endpoints:
        match = _PART.fullmatch(endpoint.name) if endpoint.role in _SIDES else None
        if match:
            parts[endpoint.node, endpoint.participant, _SIDES[endpoint.role], match[1]].append(endpoint)
        else:
            kept.append(endpoint)
    whole = {(one.node, one.participant, one.role, one.name) for one in kept if one.kind == "action"}
    for (node, participant, role, name), several in parts.items():
        goals = [one for one in several if one.name.endswith(f"/{GOAL}")]
        if goals:
            seen = several[0].seen
            for one in several:
                seen = seen.with_(one.seen)
            kept += [
                replace(goal, role=role, name=name, type=action_type(goal.type), hash="", seen=seen) for goal in goals
            ]
        elif (node, participant, role, name) not in whole:
            kept += several
    return tuple(kept)


def action_type(name: str) -> str:
    """Return the type of an action from that of one of its parts; empty where the part does not tell it.

    >>> action_type("nav2_msgs/action/Spin_SendGoal"), action_type("action_msgs/srv/CancelGoal")
    ('nav2_msgs/action/Spin', '')
    """
    action, _, part = name.rpartition("_")
    return action if part in _OF_TYPE and "/action/" in action else ""
