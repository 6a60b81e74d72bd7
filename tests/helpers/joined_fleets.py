"""Random fleets as people write them: robots of random systems that share elements, infrastructure and domains."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from hypothesis import strategies as st

from tests.helpers.written_systems import NODES, Written, written

if TYPE_CHECKING:
    from pathlib import Path

ROBOTS = ("a", "b", "c")
SHARED = (
    ("cloud", "{kind: external-system, country: US}"),
    ("cloud", "{kind: external-system, country: DE, sanitizer: {Video: anonymise}}"),
    ("cloud", "{kind: external-system, country: DE, conduit: [PersonalData], source: [Location]}"),
    ("bucket", "{kind: storage, country: IE, retention: P30D, sanitizer: {Voice: drop}}"),
    ("bucket", "{kind: storage, retention: P90D}"),
    ("hub", "{kind: side-channel, sanitizer: {Voice: drop, Video: pseudonymise}, note: checked}"),
    ("hub", "{kind: side-channel, derives: [{from: Video, to: FaceTemplate}]}"),
)
SAID = ("", ", never: [Video]", ", only: [Video, Voice]", ", never: [FaceTemplate]")


@dataclass(frozen=True)
class JoinedFleet:
    """The texts of a fleet file and of its robots."""

    robots: dict[str, Written]
    text: str

    def write(self, folder: Path) -> str:
        """Return the name of the fleet file."""
        for name, system in self.robots.items():
            system.write(folder, name)
        (folder / "f.yaml").write_text(self.text, "utf-8")
        return "f.yaml"


@st.composite
def joined_fleets(draw: st.DrawFn) -> JoinedFleet:
    """One to three models, alone, as groups that are alike, in one domain, as infrastructure; lines of all sorts."""
    robots = dict(zip(ROBOTS, draw(st.lists(written(), min_size=1, max_size=3)), strict=False))
    shared = dict(draw(st.lists(st.sampled_from(SHARED), min_size=1, max_size=3)))
    lines = ["fleet: 1", *draw(st.sampled_from(([], ["context: [care]"], ["controller: Haven Home", "purpose: care"])))]
    lines += ["models:", *(f"  {name}: {{policies: {name}.xml, labels: {name}.yaml}}" for name in robots)]
    own, groups = [], []
    for name in robots:
        domain = draw(st.sampled_from(("", "", "", ", domain: hall")))
        sort = draw(st.sampled_from(("robot", "robot", "group", "both")))
        own += [f"  {name}_own: {{model: {name}{domain}}}"] if sort != "group" else []
        groups += [f"  - {{robots: {draw(st.integers(2, 3))}, model: {name}}}"] if sort != "robot" else []
    lines += [*(["robots:", *own] if own else []), *(["groups:", *groups] if groups else [])]
    places = ["*", *(f"{name}_*" for name in robots), *(line.split(":")[0].strip() for line in own[:1])]
    if draw(st.integers(0, 3)) == 0:
        domain = draw(st.sampled_from(("", ", domain: hall")))
        lines += ["infrastructure:", f"  base: {{policies: a.xml, labels: a.yaml{domain}}}"]
        places.append("base")
    lines += ["elements:", *(f"  {name}: {said}" for name, said in sorted(shared.items()))]
    on_robot = st.builds('"{}:{}"'.format, st.sampled_from(places), st.sampled_from((*NODES, "disk")))
    hub = st.sampled_from(sorted(shared))
    pairs = st.one_of(st.tuples(on_robot, hub), st.tuples(hub, on_robot), st.tuples(on_robot, on_robot))
    flows = draw(st.lists(st.tuples(pairs, st.sampled_from(SAID)), min_size=1, max_size=5))
    lines += ["flows:", *(f"  - {{from: {a}, to: {b}{said}}}" for (a, b), said in flows)]
    return JoinedFleet(robots, "\n".join([*lines, ""]))
