"""Choices -> files of the YAML family: labels, standard channels, decisions, limits, fleets.

All are about the system of ``BASE``, so that most names fit. Each has one odd place now and then.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import CLEANS, NON_ROS
from rosprivacy.analysis.non_ros import RECIPIENTS, TRANSFERS
from tests.fuzzing.words import CHANNELS, COUNTRIES, DURATIONS, GLOBS, KINDS, NODES, TOPICS, with_fault
from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from tests.fuzzing.choices import Choices

BASE = policy(
    "/n0>/a,/b,/parameter_events</c/image", "/n1>/c/image</a,/rosout", "/n2>/rosout</a/*,/b", "/robot/arm>/a/*,!/b</b",
    "/robot/eye>/c/image</c/image,/a",
).replace('<profile ns="/" node="n0">', '<profile ns="/" node="n0"><services reply="ALLOW" request="ALLOW">'
          "<service>/s</service><service>~/get_parameters</service></services>"
          '<actions call="ALLOW" execute="ALLOW"><action>/spin</action></actions>')  # fmt: skip
BASE_LABELS = """labels: 1
nodes: {/n0: {source: [Video]}, /n1: {leak: [Video, Voice]}, /n2: {sanitizer: {Voice: drop}}, /robot/eye: conduit}
channels: {/a: sensitive}
elements: {disk: {kind: storage, country: DE}}
flows: [{from: /robot/arm, to: disk}]
"""
EXAMPLE_FLEET = (
    "fleet: 1\nmodels: {m: {policies: base.xml, labels: base.yaml}}\nrobots: {r1: {model: m}, r2: {model: m}}\n"
)
STAR_LABELS = "labels: 1\nnodes: {'*': {source: [Video], leak: [Voice], derives: [{from: Video, to: Voice}]}}\n"
NON_ROS_NAMES = ("disk", "fleet cloud", "screen")
FAULTY = 4  # one file in so many has an odd place


def written(choices: Choices, top: dict[str, Any]) -> str:
    """YAML or JSON."""
    if choices.once_in(FAULTY):
        top = with_fault(choices, top)
    if not isinstance(top, dict) or choices.once_in(4):
        return json.dumps(top, indent=1)
    lines = []
    for key, value in top.items():
        if isinstance(value, dict) and value:
            lines += [f"{json.dumps(key)}:", *(f"  {json.dumps(name)}: {json.dumps(v)}" for name, v in value.items())]
        elif isinstance(value, list) and value:
            lines += [f"{json.dumps(key)}:", *(f"  - {json.dumps(item)}  # x" for item in value)]
        else:
            lines.append(f"{json.dumps(key)}: {json.dumps(value)}")
    return "\n".join([*lines, ""])


def labels(choices: Choices) -> dict[str, str]:
    if choices.once_in(12):
        lists = ("source", "leak", "conduit", "sanitizer", "sensitive", "mundane")
        return {"labels.yaml": json.dumps({key: choices.some(CHANNELS if key[0] in "sm" else NODES) for key in lists})}
    top: dict[str, Any] = {"labels": 1, "nodes": _keyed(choices, (*NODES, *NODES, *GLOBS, "=/n0"), _node)}
    if choices.once_in(2):
        top["channels"] = _keyed(choices, (*CHANNELS, *GLOBS, "=/a/*"), _channel)
    for section, names in (("topics", TOPICS), ("services", ("/s", "/*")), ("actions", ("/spin",))):
        if choices.once_in(6):
            top[section] = _keyed(choices, names, _channel)
    if choices.once_in(2):
        top |= _non_ros(choices, NODES)
    elif choices.once_in(3):
        top["flows"] = [{"from": "/n0", "to": choices.pick(("/a", "/b")), **_restriction(choices)}]
    if choices.once_in(9):
        top["pins"] = _pins(choices)
    return {"labels.yaml": written(choices, top)}


def _pins(choices: Choices) -> dict[str, Any]:
    """What a person has seen: names in full, and now and then one that is not."""
    kinds = ("Video", "Voice", "FaceTemplate")
    nodes = _keyed(choices, (*NODES, "=/n0", "/*"), lambda c: c.some(kinds, 1))
    ends = {"from": choices.pick(({"node": "/n0"}, "disk")), "to": choices.pick(({"topic": "/a"}, "/b"))}
    return {
        "nodes": nodes,
        "topics": _keyed(choices, (*TOPICS, "=/a/*"), lambda c: c.some(kinds, 1)),
        **({"flows": [{**ends, "kinds": ["Video"]}]} if choices.once_in(3) else {}),
    }


def journal(choices: Choices) -> dict[str, str]:
    """What a session of the explorer left that was not saved, and the label file that it was about."""
    head: Any = {"rosprivacy.session": 1, "labels": "", "policies": ""}
    lines = [with_fault(choices, head) if choices.once_in(FAULTY) else head]
    for _ in range(choices.below(4)):
        node = choices.once_in(2)
        section = "nodes" if node else choices.pick(("topics", "channels", "services", "elements", "labels"))
        name = choices.pick((*NODES, *GLOBS) if node else (*CHANNELS, *NON_ROS_NAMES))
        value = _node(choices) if node else choices.pick((_channel(choices), _element(choices, NON_ROS_NAMES), None))
        line: Any = [section, name, value, *(["edited.yaml"] if choices.once_in(FAULTY) else [])]
        lines.append(with_fault(choices, line) if choices.once_in(FAULTY) else line)
    text = "".join(f"{json.dumps(line)}\n" for line in lines)
    return {"journal.jsonl": text[:-2] if choices.once_in(8) else text, "edited.yaml": BASE_LABELS}


def standard(choices: Choices) -> dict[str, str]:
    sections = {
        section: _keyed(choices, (*CHANNELS, *GLOBS), lambda c: c.pick(("mundane", "mundane", {"never": ["Video"]})))
        for section in choices.some(("channels", "topics", "services", "actions"), 1)
    }
    if not choices.once_in(3):
        sections = {section: dict.fromkeys(said, "mundane") for section, said in sections.items()}
    return {"standard.yaml": written(choices, {"labels": 1, **sections})}


def decisions(choices: Choices) -> dict[str, str]:
    entries = [decision(choices) for _ in range(choices.below(4))]
    return {"decisions.yaml": written(choices, {"decisions": 1, "findings": entries})}


def limits(choices: Choices) -> dict[str, str]:
    names = (*NODES, *CHANNELS, "/*", "/n*", "=/a/*", "disk")
    change: dict[str, Any]
    places = []
    for _ in range(choices.below(3)):
        change = choices.pick(({"never": "all"}, {"never": ["filter"]}, {"factor": 3}, {"never": "deny", "factor": 2}))
        ends = (
            {"at": choices.pick(names)},
            {"from": "/n0", "to": choices.pick(("/a", "/b"))},
            {"from": "*", "to": "*"},
        )
        places.append({**choices.pick(ends), **change})
    top: dict[str, Any] = {"limits": 1, "places": places}
    if choices.once_in(2):
        top["time_critical"] = choices.some((*NODES, "/n*"))
    if choices.once_in(3):
        top["weights"] = {key: 1 + choices.below(40) for key in choices.some(("review", "filter", "node", "deny"))}
    return {"limits.yaml": written(choices, top)}


def fleet(choices: Choices) -> dict[str, str]:
    spec = {"policies": choices.pick(("base.xml", ["base.xml"], ["b?se.xml"])), "labels": "base.yaml"}
    models = dict.fromkeys(("eye", "wall")[: 1 + choices.below(2)], spec)
    top: dict[str, Any] = {"fleet": 1, "models": models}
    robots = {f"r{number}": _robot(choices, list(models)) for number in range(choices.below(3))}
    groups = [{"robots": 1 + choices.below(20), **_robot(choices, list(models))} for _ in range(choices.below(2))]
    top |= {"robots": robots or {"r9": {"model": "eye"}}} | ({"groups": groups} if groups else {})
    if choices.once_in(4):
        top["infrastructure"] = {"base": dict(spec)}
    if choices.once_in(4):
        top["name"] = choices.pick(("hospital", "h1", 7))
    if choices.once_in(8):
        top["include"] = choices.pick(("more.yaml", ["more.yaml"], "fleet.yaml", "../outside/secret.txt", "link.xml"))
    if choices.once_in(2):
        top |= _non_ros(choices, ("*:/robot/arm", "r*:/n0", "eye_*:/n1", "*:/n2"))
    return {"fleet.yaml": written(choices, top), "more.yaml": "fleet: 1\nmodels: {more: {policies: base.xml}}\n"}


def _robot(choices: Choices, models: list[str]) -> dict[str, Any]:
    robot: dict[str, Any] = {"model": choices.pick(models)}
    if choices.once_in(3):
        robot["domain"] = choices.pick((0, 1, "d", "d"))
    if choices.once_in(5):
        robot["namespace"] = choices.pick(({"add": "/*"}, {"strip": "/*"}, {"add": "/x"}))
    return robot


def _keyed(choices: Choices, names: tuple[str, ...], said: Any) -> dict[str, Any]:
    return {name: said(choices) for name in choices.some(names, 1, 4)}


def _kinds(choices: Choices) -> list[str]:
    return choices.some(KINDS, 1, 2)


def _node(choices: Choices) -> Any:
    how = choices.below(10)
    kinds = _kinds(choices)
    if how == 9:
        return choices.pick((None, "conduit", {"absent": "sold"}, {"leak": "none"}, {"source": "none", "note": "x"}))
    said: dict[str, Any] = {}
    if how < 3:
        said["source"] = choices.pick((kinds, {kind: ["/a"] for kind in kinds}))
        if choices.once_in(3):
            said["subjects"] = ["residents", "staff"]
    if how in (2, 3, 4, 5):
        said["leak"] = kinds
    if how == 6:
        said["sanitizer"] = choices.pick((kinds, {kind: choices.pick((*map(str, CLEANS), None)) for kind in kinds}))
    if how == 7:
        said["derives"] = [{"from": "Video", "to": "FaceTemplate"}]
    if how == 8:
        said["conduit"] = kinds
    return said


def _channel(choices: Choices) -> Any:
    return choices.pick(("mundane", "sensitive", None, {**_restriction(choices), "note": "x"}))


def _restriction(choices: Choices) -> dict[str, list[str]]:
    return {choices.pick(("only", "never")): _kinds(choices)}


def _non_ros(choices: Choices, others: tuple[str, ...]) -> dict[str, Any]:
    """Elements outside ROS, with limits and flows."""
    names = choices.some(NON_ROS_NAMES, 1)
    top: dict[str, Any] = {"elements": {name: _element(choices, others) for name in names}}
    if choices.once_in(2):
        top["limits"] = {kind: choices.pick(DURATIONS) for kind in choices.some(KINDS[:9], 1, 2)}
    flows = []
    for name in names:
        ends = (choices.pick(others), name)
        there = ends if choices.once_in(2) else ends[::-1]
        flows.append({"from": there[0], "to": there[1], **(_restriction(choices) if choices.once_in(3) else {})})
    return {**top, "flows": flows}


def _element(choices: Choices, others: tuple[str, ...]) -> dict[str, Any]:
    kind = choices.pick(tuple(NON_ROS))
    said: dict[str, Any] = {"kind": kind}
    if choices.once_in(2):
        said["country"] = choices.pick(COUNTRIES)
    if choices.once_in(3):
        said |= {"operator": "Example Inc.", "recipient": choices.pick(tuple(RECIPIENTS))}
        said["transfer"] = choices.pick((*TRANSFERS, "none"))
    if kind == "storage":
        kept = {kind: choices.pick(DURATIONS) for kind in _kinds(choices)}
        said |= {"retention": choices.pick((choices.pick(DURATIONS), kept)), "encrypted": choices.once_in(2)}
        said["backups"] = choices.pick((True, False, "P7D"))
    if kind in ("shared-memory", "side-channel") and ":" not in others[0]:
        said["between"] = ["/n0", choices.pick(("/n1", {"node": "/n2"}))]
    if kind == "device" or choices.once_in(4):
        said["source"] = _kinds(choices)
    return said


def decision(choices: Choices) -> dict[str, Any]:
    """What is decided about a finding, as an entry of a decisions file."""
    said: dict[str, Any] = {"decision": choices.pick(("accept", "mitigate", "delegate", "avoid"))}
    if choices.once_in(3):
        said["id"] = "".join(choices.pick("0123456789abcdef") for _ in range(16))
    else:
        target = {
            "category": KINDS[:9],
            "source": (*NODES, "/n*"),
            "leak": (*NODES, "disk", "*"),
            "kind": ("disclosure",),
        }
        said |= {key: choices.pick(target[key]) for key in choices.some(tuple(target), 1)}
    if said["decision"] == "accept" or choices.once_in(2):
        said |= {"reason": "agreed", "owner": "A. Person"}
    dates = ("2026-01-01", "2099-12-31", "0001-01-01", "9999-12-31")
    said |= {key: choices.pick(dates) for key in choices.some(("date", "expires"))}
    if choices.once_in(3):
        said["legal_basis"] = choices.pick((["6(1)(c)"], ["Article 6(1)(f)", "9(2)(h)"], ["10"]))
    if choices.once_in(6):
        said |= {"pseudonymised": choices.once_in(2), "history": [{"decision": "avoid"}]}
    return said
