"""Random fleets as people write them: policies, label files, a fleet file with domains, infrastructure and a cloud."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from pathlib import Path

KINDS = ("PersonalData", "Biometric", "FaceTemplate", "Video", "Voice", "Location")
NODES, TOPICS = tuple(f"/n{i}" for i in range(4)), ("/a", "/b", "/c", "/a*", "/rosout")
DERIVED = (("Video", "FaceTemplate"), ("PersonalData", "Location"), ("Voice", "Biometric"))


def fleet(number: int, folder: Path, *, apart: bool) -> str:
    """Write a fleet and return its file; the same for the same number.

    Parameters
    ----------
    apart
        No two robots are alike, and nothing else differs: each has a policy of its own, with ``+`` in its name.
    """
    random, name = Random(number), f"f{number:02}"  # noqa: S311 - the same each time
    models = {model: _system(random, folder, f"{name}{model}") for model in ("x", "y", "z")[: random.randint(1, 3)]}
    joined = random.random() < 0.8
    lines = ["fleet: 1", f"name: {name}", "robots:"]
    robots: list[str] = []
    for model, files in models.items():
        for i in range(random.choice((1, 1, 2, 3))):
            robot = f"{name}{model}{i}"
            written = folder / f"{name}{model}.xml"
            own = f"{name}{model}{'+' * len(robots)}.xml" if apart else written.name
            (folder / own).write_text(written.read_text("utf-8") + f"<!--{own}-->" * apart, "utf-8")
            where = f", domain: lab{number}" if joined and model != "z" else ""
            lines.append(f"  {robot}: {{policies: [{own}], labels: [{files}]{where}}}")
            robots.append(robot)
    if random.random() < 0.7:
        files = _system(random, folder, f"{name}base")
        where = f", domain: lab{number}" if joined else ""
        lines.append(f"infrastructure: {{{name}base: {{policies: [{name}base.xml], labels: [{files}]{where}}}}}")
        robots.append(f"{name}base")
    lines += [
        "elements:",
        f"  cloud{number}: {{kind: external-system, country: {random.choice(('US', 'DE'))}}}",
        f"  disk{number}: {{kind: storage, country: DE{random.choice(('', ', retention: P3D'))}}}",
        "flows:",
        f"  - {{from: '*:/n{random.randint(0, 3)}', to: cloud{number}}}",
        f"  - {{from: '{random.choice(robots)}:/n{random.randint(0, 3)}', to: disk{number}}}",
        f"  - {{from: disk{number}, to: '{random.choice(robots)}:/n{random.randint(0, 3)}'}}",
        f"  - {{from: '{random.choice(robots)}:/n1', to: '*:/n{random.choice((0, 2, 3))}'}}",
    ]
    file = folder / f"{name}.fleet.yaml"
    file.write_text("\n".join([*lines, ""]), "utf-8")
    return str(file)


def _system(random: Random, folder: Path, name: str) -> str:
    """Write the policy and the labels of a model; return the name of the label file."""
    profiles = []
    for node in NODES:
        written, read = (",".join(sorted(random.sample(TOPICS, random.randint(0, 3)))) for _ in "wr")
        deny = random.choice(("", "", ",!/b"))
        profiles.append(policy(f"{node}>{written}{deny if written else ''}<{read}"))
    enclaves = [text.partition("<enclaves>")[2].partition("</enclaves>")[0] for text in profiles]
    enclaves = [text.replace('path="/e"', f'path="/e{min(i, 2)}"') for i, text in enumerate(enclaves)]
    both = enclaves[2].replace("</profiles></enclave>", enclaves[3].partition("<profiles>")[2])  # one for two nodes
    text = f'<policy version="0.2.0"><enclaves>{"".join((*enclaves[:2], both))}</enclaves></policy>'
    (folder / f"{name}.xml").write_text(
        text.replace("<profile ", "\n<profile ").replace("<topics", "\n<topics"), "utf-8"
    )
    roles = {NODES[0]: f"{{source: [{random.choice(KINDS)}]}}"}
    for node in random.sample(NODES[1:], 3):
        made, of = random.choice(DERIVED)[::-1]
        clean = random.choice(("anonymise", "pseudonymise", "drop"))
        roles[node] = random.choice(
            (
                f"{{leak: [{random.choice(KINDS)}]}}", f"{{leak: [{random.choice(KINDS)}, Voice]}}", "conduit",
                f"{{sanitizer: {{{random.choice(KINDS)}: {clean}}}}}", f"{{derives: [{{from: {of}, to: {made}}}]}}",
                f"{{source: [{random.choice(KINDS)}]}}", f"{{sanitizer: [{random.choice(KINDS)}]}}", "",
            )
        )  # fmt: skip
    used = [topic for topic in TOPICS[:3] if f"<topic>{topic}<" in text and random.random() < 0.5]
    said = {topic: random.choice(("mundane", "sensitive", "{never: [Voice]}", "{only: [Video]}")) for topic in used}
    lines = ["labels: 1", "nodes:", *(f"  {node}: {role}" for node, role in sorted(roles.items()) if role)]
    lines += ["channels:", *(f"  {topic}: {word}" for topic, word in sorted(said.items()))] if said else []
    (folder / f"{name}.yaml").write_text("\n".join([*lines, ""]), "utf-8")
    return f"{name}.yaml"
