"""Every output counts elements, flows and what is not reviewed alike, and says so where it counts legs."""

from __future__ import annotations

import json
import re
from html import unescape
from typing import TYPE_CHECKING, Any

import pytest

from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from tests.helpers.command import Cli

FACTORY, HOME = "examples/factory", "examples/care-home"
SYSTEMS = {
    "factory": (f"{FACTORY}/before.policy.xml", "-l", f"{FACTORY}/run2.labels.yaml"),
    "factory, before any label but one": (f"{FACTORY}/before.policy.xml", "-l", f"{FACTORY}/run1.labels.yaml"),
    "care home": (f"{HOME}/care-home.policy.xml", "-l", f"{HOME}/care-home.labels.yaml"),
    "fleet": ("--fleet", "examples/fleet/fleet.yaml"),
}


def said(text: str, expression: str) -> tuple[int, ...]:
    """The numbers of the first place where a text counts."""
    found = re.search(expression, text)
    assert found, f"{expression} is not in {text[:500]}"
    return tuple(int(number.replace(",", "")) for number in found.groups())


@pytest.mark.slow
@pytest.mark.parametrize("system", SYSTEMS)
def test_all_outputs_count_alike(cli: Cli, system: str) -> None:
    def told(command: str, *options: str) -> str:
        done = cli(command, *SYSTEMS[system], *options, cwd=ROOT)
        assert done.returncode in (0, 1, 4), done.stderr
        return done.stdout

    document: dict[str, Any] = json.loads(told("analyze", "-f", "json"))
    keys = [tuple(row["element"][part] for part in ("robot", "kind", "name")) for row in document["open"]]
    whole = {"elements": document["elements"], "flows": document["flows"], "open": len(set(keys))}
    text, page = told("analyze"), told("report")
    markdown, picture = told("report", "-f", "markdown"), told("graph", "--show", "privacy", "-f", "dot")
    run = json.loads(told("analyze", "-f", "sarif"))["runs"][0]
    plain = unescape(re.sub("<[^>]+>", " ", page))
    counts: dict[str, tuple[int, ...]] = {
        "text, elements and flows": said(text, r"([\d,]+) elements and ([\d,]+) flows in all"),
        "page, elements and flows": said(plain, r"([\d,]+) elements and ([\d,]+) flows were analysed"),
        "markdown, elements and flows": said(markdown, r"([\d,]+) elements and ([\d,]+) flows were analysed"),
        "text, open": said(text, r"([\d,]+) elements? to review"),
        "page, open": said(plain, r"no label or glob answers for it in full\s+([\d,]+)"),
        "markdown, open": said(markdown, r"no label or glob answers for it in full: \*\*([\d,]+)\*\*"),
        "picture, open": said(picture, r"([\d,]+) elements? not reviewed"),
        "sarif, open": (run["properties"]["unreviewedElements"],),
        "sarif's message, open": said(json.dumps(run), r"; ([\d,]+) elements? that data reaches"),
    }
    if "fleet" not in system:  # of which the picture has one robot for all that are alike
        title = " ".join(re.findall(r"<TD ALIGN=\"LEFT\">(.*?)</TD>", told("graph", "-f", "dot", "--all")))
        kinds = re.findall(r"(\d+) (?:nodes?|actions?|services?|topics?|standard ROS channels?)", title)
        assert sum(map(int, kinds)) == whole["elements"], title
    for where, numbers in counts.items():
        both = (whole["elements"], whole["flows"])
        assert numbers == ((whole["open"],) if "open" in where else both), where
    groups = re.findall(r"^(?:Review next .*|Channels not reviewed|Nodes behind those): (\d+)", text, re.MULTILINE)
    assert sum(map(int, groups)) == whole["open"]
    legs = f"{whole['open']} elements to review ({len(keys)} counting the legs of services and actions)"
    assert (legs in text) == (len(keys) != whole["open"])
