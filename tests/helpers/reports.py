"""What tests of reports share: systems that mean harm, fleets, and documents with what other parts add to them."""

from __future__ import annotations

import copy
import json
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import quoteattr

import rosprivacy
from tests.helpers.graphs import care_home, factory

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

SCRIPT = "<script>document.title='harmed'</script>"
HOSTILE = (
    SCRIPT,
    "\"'><img src=x onerror=document.title='harmed'>",
    "</style></script><!--",
    "{{7*7}}{%x%}${x}",
    "](javascript:document.title) ![x](http://127.0.0.1:9/x) | `x` <http://127.0.0.1:9/>",
    "=HYPERLINK(1)",
    "\u05e9\u05dc\u05d5\u05dd\u0645\u0631\u062d\u0628\u0627",  # read from right to left
    "\u202eevil\u2066x",  # controls that turn the reading direction
    "x" * 4000,
)


def care() -> dict[str, Any]:
    return copy.deepcopy(care_home().document())  # tests write into it


def run(number: int) -> dict[str, Any]:
    """One of the factory's five runs."""
    return copy.deepcopy(factory(number).document())


def policy(profiles: Mapping[str, tuple[list[str], list[str]]]) -> str:
    """A policy of nodes with the topics that they publish and subscribe."""

    def topics(role: str, names: list[str]) -> str:
        inside = "".join(f"<topic>{name.replace('&', '&amp;').replace('<', '&lt;')}</topic>" for name in names)
        return f'<topics {role}="ALLOW">{inside}</topics>' if names else ""

    rows = "".join(
        f'<profile ns="/" node={quoteattr(node)}>{topics("publish", out)}{topics("subscribe", into)}</profile>'
        for node, (out, into) in profiles.items()
    )
    enclave = f'<enclave path="/e"><profiles>{rows}</profiles></enclave>'
    return f'<policy version="0.2.0"><enclaves>{enclave}</enclaves></policy>'


def hostile(folder: Path) -> dict[str, Any]:
    """A system whose names, labels and groups of persons mean harm, one way from each source to each leak."""
    names = [f"/{name}" for name in HOSTILE]
    rows = {"camera": (names, []), "cloud": ([], names)}
    (folder / "harm.policy.xml").write_text(policy(rows), "utf-8")
    groups = [name[:90] for name in HOSTILE]
    labels = {
        "labels": 1,
        "nodes": {"/camera": {"source": ["Video"], "subjects": groups}, "/cloud": {"leak": ["Video"]}},
    }
    (folder / "harm.labels.json").write_text(json.dumps(labels), "utf-8")
    result = rosprivacy.analyze([str(folder / "harm.policy.xml")], [str(folder / "harm.labels.json")])
    return harmed(result.document())


OF_OFFICE: dict[str, dict[str, Any]] = {
    "archive": {
        "kind": "storage", "country": "US", "recipient": "processor", "contract": "Article 28",
        "retention": "P1Y", "encrypted": False, "transfer": "standard-clauses",
    },
    "help desk": {"kind": "external-system", "country": "TN", "recipient": "processor", "transfer": "derogation"},
    "partner": {"kind": "external-system", "country": "DE", "recipient": "joint-controller"},
}  # fmt: skip


def office(folder: Path) -> dict[str, Any]:
    """A workplace with emotion estimates and a watch list, which rest abroad and are no finding."""
    profiles: dict[str, tuple[list[str], list[str]]] = {
        "camera": (["/image"], []),
        "emotion": (["/mood"], ["/image"]),
        "guard": (["/alarm"], ["/image"]),
        "mic": (["/audio"], []),
        "recorder": ([], ["/mood", "/alarm"]),
        "teleop": ([], ["/audio"]),
    }
    labels = {
        "labels": 1,
        "context": ["workplace"],
        "country": "DE",
        "nodes": {
            "/camera": {"source": ["Video"]},
            "/mic": {"source": ["Voice"]},
            "/emotion": {"derives": [{"from": "Video", "to": "EmotionEstimate"}], "sanitizer": {"Video": "drop"}},
            "/guard": {"derives": [{"from": "Video", "to": "WatchListMatch"}], "sanitizer": {"Video": "drop"}},
            "/recorder": "conduit",
            "/teleop": "conduit",
        },
        "channels": dict.fromkeys(("/image", "/mood", "/alarm", "/audio"), "sensitive"),
        "elements": OF_OFFICE,
        "flows": [
            {"from": "/recorder", "to": "archive"},
            {"from": "/teleop", "to": "help desk"},
            {"from": "/teleop", "to": "partner"},
        ],
    }
    (folder / "office.policy.xml").write_text(policy(profiles), "utf-8")
    (folder / "office.labels.json").write_text(json.dumps(labels), "utf-8")
    analysed = rosprivacy.analyze([str(folder / "office.policy.xml")], [str(folder / "office.labels.json")])
    return json.loads(json.dumps(analysed.document()))  # type: ignore[no-any-return]  # JSON


def harmed(document: dict[str, Any]) -> dict[str, Any]:
    """A document with a way through each hostile name, as a hostile policy or database could have it."""
    (template,) = document["findings"]
    document["findings"] = []
    for number, name in enumerate(HOSTILE):
        finding = copy.deepcopy(template)
        finding["id"] = f"{number:016x}"
        finding["source"]["name"], finding["leak"]["name"] = f"/from/{name}", f"/to/{name}"
        finding["witness"] = [finding["source"], {**finding["witness"][1], "name": f"/{name}"}, finding["leak"]]
        finding["steps"][0]["policy"] = [{"file": name, "line": number, "enclave": name, "profile": name}]
        document["findings"].append(finding)
    document["assumptions"]["labels"].append({"file": SCRIPT, "sha256": "0" * 64})
    document["diagnostics"].append({"file": SCRIPT, "line": 1, "severity": "notice", "message": HOSTILE[1]})
    decide(document, 0, reason=SCRIPT, owner=HOSTILE[1], legal_basis=[HOSTILE[4]], ticket=HOSTILE[2])
    document["outside"] = [
        {
            "element": {"robot": SCRIPT, "kind": "storage", "name": HOSTILE[1]},
            "file": SCRIPT,
            "line": 1,
            "operator": HOSTILE[5],
            "country": "DE",
            "area": "eea",
            "retention": {"Video": "P30D"},
            "holds": ["Video"],
        }
    ]
    (like,) = document["register"]
    ends = {finding["id"]: finding for finding in document["findings"]}
    document["register"] = [registered(like, document["outside"][0])]
    document["register"] += [{**like, "places": [one["leak"]], "findings": [of]} for of, one in ends.items()]
    return document


def decide(document: dict[str, Any], number: int | None, **said: Any) -> None:
    """Write a decision about a finding, or about none, into a document, as ``with_decisions`` does."""
    nothing: dict[str, Any] = {
        "reason": "",
        "owner": "",
        "legal_basis": [],
        "date": None,
        "expires": None,
        "ticket": None,
    }
    decision = {"choice": "accept", "state": "valid", **nothing, "file": "decisions.yaml", "line": 1} | said
    about = [] if number is None else [document["findings"][number]]
    for finding in about:
        finding["decision"] = decision
    ids = [finding["id"] for finding in about]
    document.setdefault("decisions", []).append({**decision, "target": {}, "findings": ids})


def fleet(document: Mapping[str, Any], robots: list[str]) -> dict[str, Any]:
    """The same system on several robots."""
    found: dict[str, Any] = {**copy.deepcopy(dict(document))}
    lists = ("findings", "open", "carries", "roles", "sanitizers", "derivations", "subjects", "unreached")
    found |= {key: [] for key in lists}
    for number, robot in enumerate(robots):
        for key in lists:
            found[key] += [_on(robot, number, row) for row in document[key]]
    return found


def _on(robot: str, number: int, value: Any) -> Any:
    if isinstance(value, list):
        return [_on(robot, number, item) for item in value]
    if not isinstance(value, dict):
        return value
    copied = {key: _on(robot, number, item) for key, item in value.items()}
    if {"robot", "kind", "name"} <= set(value):
        copied["robot"] = robot
    if "disjoint_paths" in value:
        copied["id"] = f"{int(value['id'], 16) + number:016x}"[-16:]
    return copied


OUTSIDE: list[dict[str, Any]] = [
    {
        "element": {"robot": "", "kind": "external-system", "name": "speech service"},
        "file": "fleet.yaml", "line": 4, "country": "US", "area": "partly", "operator": "Speech Inc.",
        "recipient": "processor", "transfer": "standard-clauses", "holds": ["Voice"],
    },
    {
        "element": {"robot": "", "kind": "storage", "name": "archive"},
        "file": "fleet.yaml", "line": 9, "retention": {"Video": "P30D", "every": "P1Y"}, "backups": True,
        "encrypted": False, "holds": ["Video", "Voice"], "missing": ["country"], "without_limit": ["Voice"],
    },
]  # fmt: skip


def with_outside(document: dict[str, Any]) -> dict[str, Any]:
    """A document with storages and external systems, as label files state them."""
    document["outside"] = copy.deepcopy(OUTSIDE)
    document["assumptions"] |= {"taken_by_kind": {"storage": "conduit"}, "countries_as_of": "2026-06-30"}
    kept = copy.deepcopy(document["findings"][1])
    kept |= {"id": "f" * 16, "kind": "storage-limitation", "reason": "no retention is stated", "pseudonymised": False}
    kept["because"] = {"key": "no-retention", "values": {}}
    kept["leak"] = kept["witness"][-1] = OUTSIDE[1]["element"]
    document["findings"].append(kept)
    of_kinds = {row["category"]: row for row in document["register"]}
    document["register"] += [registered(of_kinds[kind], row) for row in OUTSIDE for kind in row["holds"]]
    return document


def registered(like: Mapping[str, Any], stated: Mapping[str, Any]) -> dict[str, Any]:
    """A row of the register like another one, at a place of which something is stated; nothing is to be completed."""
    fields = ("operator", "recipient", "contract", "country", "area", "transfer", "backups", "encrypted")
    kept = stated.get("retention", {})
    return {
        **copy.deepcopy(dict(like)),
        **{field: stated.get(field, None if field in ("backups", "encrypted") else "") for field in fields},
        "retention": [kept[of] for of in (like["category"], "every") if of in kept][:1],
        "places": [stated["element"]],
        "safeguards": [],
        "measures": [],
        "findings": [],
        "to_complete": [],
    }


def with_decisions(document: dict[str, Any]) -> dict[str, Any]:
    """A document in which the first finding is accepted without an exception, the second is to be mitigated."""
    document["findings"][0]["accepted"] = True
    accepted = {"owner": "care management", "legal_basis": ["6(1)(c)"], "expires": "2027-03-31"}
    decide(document, 0, reason="staff has to know", **accepted)
    decide(document, 1, choice="mitigate", reason="a filter is ordered", owner="robot team")
    decide(document, None, reason="of last year", owner="nobody", state="orphaned")
    return document
