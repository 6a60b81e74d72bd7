"""Decisions on a fleet: about patterns, or about robots by name; never about more than they say (rule S10)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.helpers.fleet_files import MODELS, folder, write

if TYPE_CHECKING:
    from tests.helpers.command import Cli

__all__ = ["folder"]  # a fixture
LEAKS = "labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /uplink: {leak: [Video]}\n"
FIVE = "fleet: 1\n" + MODELS + "groups: [{robots: 5, model: eye}]\n"
ACCEPT = "decision: accept, reason: agreed, owner: me, legal_basis: [6(1)(a)]"
CROSS = (
    "elements: {base: {kind: external-system, country: DE}}\n"
    "flows: [{from: '*:/uplink', to: base}, {from: base, to: '*:/uplink'}]\n"
)


@pytest.fixture(autouse=True)
def _five(folder: object) -> None:  # noqa: ARG001 - for what it does
    write("eye.yaml", LEAKS)
    write("five.yaml", FIVE)


def decide(*entries: str) -> None:
    write("d.yaml", "decisions: 1\nfindings:\n" + "".join(f"  - {{{entry}, {ACCEPT}}}\n" for entry in entries))


def told(cli: Cli, *options: str) -> dict[str, Any]:
    done = cli("analyze", "--fleet", "five.yaml", "--decisions", "d.yaml", "-f", "json", *options)
    assert done.returncode in (1, 4), done.stderr
    return dict(json.loads(done.stdout)) | {"code": done.returncode}


def pattern(cli: Cli) -> dict[str, Any]:
    decide("category: Voice")
    (only,) = told(cli)["fleet"]["patterns"]
    return dict(only)


def test_a_pattern_is_accepted_by_its_id(cli: Cli) -> None:
    decide(f"id: {pattern(cli)['id']}")
    document = told(cli)
    (found,) = document["fleet"]["patterns"]
    assert (document["verdict"], document["code"]) == ("undetermined", 4)  # nobody reviewed /image
    assert (found["findings"], found["accepted"]) == (5, 5)


def test_decide_takes_the_ids_of_patterns_from_a_report(cli: Cli) -> None:
    cli("analyze", "--fleet", "five.yaml", "-f", "json", "-o", "r.json")
    said = ("--report", "r.json", "--reason", "agreed", "--owner", "me", "--decisions", "d.yaml")
    (shown,) = json.loads(Path("r.json").read_text("utf-8"))["fleet"]["patterns"]
    assert cli("decide", "accept", shown["finding"], *said).returncode == 2
    assert cli("decide", "accept", shown["id"][:6], *said).returncode == 0
    assert told(cli)["fleet"]["patterns"][0]["accepted"] == 5
    text = cli("analyze", "--fleet", "five.yaml", "--decisions", "d.yaml").stdout
    assert f"[pattern {shown['id']}]" in text


def test_names_and_globs_are_about_all_robots(cli: Cli) -> None:
    decide("category: Video, leak: /up*")
    (found,) = told(cli)["fleet"]["patterns"]
    assert (found["findings"], found["accepted"]) == (5, 5)


def test_a_robot_by_name_is_about_that_robot_only(cli: Cli) -> None:
    decide("robot: eye_3, leak: /uplink")
    document = told(cli)
    (found,) = document["fleet"]["patterns"]
    assert (document["verdict"], document["code"]) == ("leak", 1)
    assert (found["findings"], found["accepted"]) == (5, 1)
    (shown,) = document["findings"]
    assert not shown["accepted"]
    assert shown["source"]["robot"] != "eye_3"
    (deviant,) = document["fleet"]["deviants"]
    assert deviant["robots"] == ["eye_3"]
    assert [share["accepted"] for share in deviant["more"]] == [True]


def test_the_id_of_what_stands_for_many_is_about_none_of_them(cli: Cli) -> None:
    """What a report shows of one robot has the id of that robot's finding; to accept it is not to accept all."""
    shown = pattern(cli)["finding"]
    decide(f"id: {shown}")
    document = told(cli)
    assert document["verdict"] == "leak"
    assert document["fleet"]["patterns"][0]["accepted"] == 0
    assert any("is about no finding" in said["message"] for said in document["diagnostics"])


def test_a_robot_that_stands_for_itself_has_findings_with_ids(cli: Cli) -> None:
    write("five.yaml", FIVE.replace("robots: 5", "robots: 1"))
    shown = pattern(cli)["finding"]
    decide(f"id: {shown}")
    assert told(cli)["fleet"]["patterns"][0]["accepted"] == 1


def test_what_goes_from_robot_to_robot_is_decided_by_its_own_id(cli: Cli) -> None:
    write("five.yaml", FIVE + CROSS)
    decide("category: Voice")
    before = {p["across"]: p for p in told(cli)["fleet"]["patterns"] if p["findings"] in (5, 20)}
    assert (before[False]["findings"], before[True]["findings"]) == (5, 20)
    decide(f"id: {before[True]['id']}")
    after = {p["across"]: p for p in told(cli)["fleet"]["patterns"] if p["findings"] in (5, 20)}
    assert (after[False]["accepted"], after[True]["accepted"]) == (0, 20)


def test_without_a_valid_decision_nothing_differs_from_the_fleet_without_decisions(cli: Cli) -> None:
    write("five.yaml", FIVE + CROSS)
    decide("category: Voice")
    document = told(cli)
    plain = json.loads(cli("analyze", "--fleet", "five.yaml", "-f", "json").stdout)
    for key in ("verdict", "open", "carries", "roles"):
        assert document[key] == plain[key]
    assert document["fleet"] == plain["fleet"]
    assert [f["id"] for f in document["findings"]] == [f["id"] for f in plain["findings"]]


def decided_by_report(cli: Cli) -> str:
    """Accept the one pattern of the fleet, as it is now."""
    cli("analyze", "--fleet", "five.yaml", "-f", "json", "-o", "r.json")
    said = ("--report", "r.json", "--reason", "agreed", "--owner", "me", "--decisions", "d.yaml")
    (shown,) = json.loads(Path("r.json").read_text("utf-8"))["fleet"]["patterns"]
    assert cli("decide", "accept", shown["id"], *said).returncode == 0
    return str(shown["id"])


def test_a_robot_that_joins_an_accepted_pattern_is_not_accepted(cli: Cli) -> None:
    """A wrong 'nothing found' is the worst: nobody looked at that robot."""
    decided_by_report(cli)
    before = told(cli)
    assert (before["verdict"], before["fleet"]["patterns"][0]["accepted"]) == ("undetermined", 5)
    assert not any("changed since" in said["message"] for said in before["diagnostics"])
    write("five.yaml", FIVE.replace("robots: 5", "robots: 6"))
    after = told(cli)
    (found,) = after["fleet"]["patterns"]
    assert (after["verdict"], after["code"]) == ("leak", 1)
    assert (found["findings"], found["accepted"]) == (6, 5)
    (entry,) = after["decisions"]
    assert entry["changed"] == [{"what": "robots", "before": "5", "now": "6, +eye_6"}]
    (message,) = (said["message"] for said in after["diagnostics"] if "changed since" in said["message"])
    assert "robots: 5 then, 6, +eye_6 now; decide anew" in message
    assert not any("names no from_robot" in said["message"] for said in after["diagnostics"])


def test_it_is_accepted_when_it_is_decided_anew_and_the_file_keeps_what_was(cli: Cli) -> None:
    decided_by_report(cli)
    write("five.yaml", FIVE.replace("robots: 5", "robots: 6"))
    decided_by_report(cli)
    document = told(cli)
    assert document["fleet"]["patterns"][0]["accepted"] == 6
    assert "changed" not in document["decisions"][0]
    text = Path("d.yaml").read_text("utf-8")
    assert "history:" in text
    assert text.count("eye_6") == 1


def test_without_what_was_there_a_pattern_is_about_all_robots_as_before(cli: Cli) -> None:
    """Decisions files of earlier versions mean what they meant."""
    decide(f"id: {pattern(cli)['id']}")
    write("five.yaml", FIVE.replace("robots: 5", "robots: 6"))
    document = told(cli)
    assert document["fleet"]["patterns"][0]["accepted"] == 6
    assert not any("changed since" in said["message"] for said in document["diagnostics"])


def test_what_a_new_robot_gets_from_another_is_not_accepted_either(cli: Cli) -> None:
    write("five.yaml", FIVE + CROSS)
    decide("category: Voice")
    plain = {p["across"]: p for p in told(cli)["fleet"]["patterns"] if p["findings"] in (5, 20)}
    cli("analyze", "--fleet", "five.yaml", "-f", "json", "-o", "r.json")
    said = ("--report", "r.json", "--reason", "agreed", "--owner", "me", "--decisions", "e.yaml")
    assert cli("decide", "accept", plain[True]["id"], *said).returncode == 0
    Path("d.yaml").write_text(Path("e.yaml").read_text("utf-8"), "utf-8")
    assert {p["id"]: p["accepted"] for p in told(cli)["fleet"]["patterns"]}[plain[True]["id"]] == 20
    write("five.yaml", FIVE.replace("robots: 5", "robots: 6") + CROSS)
    (after,) = (p for p in told(cli)["fleet"]["patterns"] if p["id"] == plain[True]["id"])
    assert (after["findings"], after["accepted"]) == (30, 20)


def by_id(cli: Cli, *, across: bool = False) -> str:
    decide("category: Voice")
    return next(str(p["id"]) for p in told(cli)["fleet"]["patterns"] if p["across"] == across)


def test_a_list_of_robots_is_about_these_and_none_that_joins(cli: Cli) -> None:
    decide(f"id: {by_id(cli)}, robots: [eye_2, eye_4]")
    document = told(cli)
    (found,) = document["fleet"]["patterns"]
    assert (document["verdict"], found["findings"], found["accepted"]) == ("leak", 5, 2)
    assert document["decisions"][0]["target"] == {"id": found["id"], "robots": ["eye_2", "eye_4"]}
    decide(f"id: {found['id']}, robots: [{', '.join(f'eye_{n}' for n in range(1, 6))}]")
    assert told(cli)["verdict"] == "undetermined"
    write("five.yaml", FIVE.replace("robots: 5", "robots: 6"))
    document = told(cli)
    assert (document["verdict"], document["fleet"]["patterns"][0]["accepted"]) == ("leak", 5)


def test_robots_of_one_list_stay_alike(cli: Cli) -> None:
    decide(f"id: {by_id(cli)}, robots: [eye_1, eye_2, eye_3, eye_4, eye_5]")
    (group,) = told(cli)["fleet"]["alike"]
    assert len(group["robots"]) == 5


def test_what_goes_from_robot_to_robot_is_on_the_lists_of_both_ends(cli: Cli) -> None:
    write("five.yaml", FIVE + CROSS)
    pattern = by_id(cli, across=True)

    def accepted(target: str) -> int:
        decide(f"id: {pattern}, {target}")
        return int(next(p["accepted"] for p in told(cli)["fleet"]["patterns"] if p["id"] == pattern))

    assert accepted("robots: [eye_2, eye_3], from_robots: [eye_1]") == 2
    assert accepted("robots: [eye_1, eye_2], from_robots: [eye_1, eye_2]") == 2
    assert accepted("robots: [eye_2]") == 0  # nothing is said of what comes from another robot
    assert accepted("from_robots: [eye_1]") == 4


def test_of_two_lists_the_shorter_one_counts_and_a_list_before_none(cli: Cli) -> None:
    pattern = by_id(cli)
    entries = (
        f"- {{id: {pattern}, {ACCEPT}}}",
        f"- {{id: {pattern}, robots: [eye_1, eye_2], decision: avoid}}",
        f"- {{id: {pattern}, robots: [eye_2], {ACCEPT}}}",
    )
    for order in (entries, entries[::-1]):
        write("d.yaml", "decisions: 1\nfindings:\n" + "".join(f"  {entry}\n" for entry in order))
        document = told(cli)
        assert document["fleet"]["patterns"][0]["accepted"] == 4  # all but eye_1
    write("d.yaml", "decisions: 1\nfindings:\n" + "".join(f"  {entry}\n" for entry in entries[1:2]))
    assert told(cli)["fleet"]["patterns"][0]["accepted"] == 0


@pytest.mark.parametrize(
    ("entries", "problem"),
    [
        ("{id: P, robots: []}", "robots of a decision names nothing"),
        ("{id: P, robots: eye_1}", "robots takes a list"),
        ("{id: P, robots: [eye_1], robot: eye_1}", "robot and robots"),
        ("{id: P, from_robots: [a], from_robot: a}", "from_robot and from_robots"),
        ("{robots: [eye_1]}", "a decision about everything"),
        ("{id: P, robots: [a, b]}\n  - {id: P, robots: [b, a]}", "again, first in line"),
    ],
)
def test_what_a_list_cannot_say_is_an_error(cli: Cli, entries: str, problem: str) -> None:
    text = entries.replace("P", "0123456789abcdef").replace("}", ", decision: avoid}")
    write("d.yaml", f"decisions: 1\nfindings:\n  - {text}\n")
    done = cli("analyze", "--fleet", "five.yaml", "--decisions", "d.yaml")
    assert done.returncode == 2
    assert problem in done.stderr


def test_two_lists_that_differ_about_a_robot_contradict_each_other(cli: Cli) -> None:
    pattern = by_id(cli)
    first, second = (f"{{id: {pattern}, robots: [eye_1, eye_{n}]" for n in (2, 3))
    write("d.yaml", f"decisions: 1\nfindings:\n  - {first}, {ACCEPT}}}\n  - {second}, decision: avoid}}\n")
    done = cli("analyze", "--fleet", "five.yaml", "--decisions", "d.yaml")
    assert done.returncode == 2
    assert "contradicts line 3" in done.stderr


def test_what_has_changed_is_told_of_the_robots_of_the_list(cli: Cli) -> None:
    pattern = by_id(cli)
    for path, changed in (("/camera, /image, /uplink", False), ("/camera, /uplink", True)):
        decide(f"id: {pattern}, robots: [eye_2], made_about: {{path: [{path}]}}")
        assert ("changed" in told(cli)["decisions"][0]) == changed
