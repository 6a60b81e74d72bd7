"""What a hostile input costs, byte for byte beside a real policy: CPU seconds and peak memory of a fresh process.

Each shape is made to press on one reader or one step of the analysis, and is
analysed by the command itself. From its CPU time and its memory those of a tiny policy are taken away, which are the
start of the program; what is left, for each kB of input, is divided by the same of the largest public policy, in the
same run. A shape with exit code 2 met a bound: its cost does not grow with the input any more.
"""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from random import Random
from statistics import median
from subprocess import DEVNULL, Popen
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from measure import Measured, NotMeasured, Row, corpus

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.python_311 import Unpack

ROUNDS = 3  # of the real policy and of the tiny one
FLEET = "fleet: 1\nmodels: {m: {policies: p.xml}}\ngroups:\n"
XI = 'xmlns:xi="http://www.w3.org/2001/XInclude"'


@dataclass(frozen=True, slots=True)
class Cost:
    """Of one run: CPU seconds, peak memory in MB, bytes of input, exit code."""

    seconds: float
    megabytes: float
    size: int
    code: int


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured.

    Raises
    ------
    NotMeasured
        In the quick form: none of these has a bound.
    """
    if quick:
        raise NotMeasured("no bounds; in the full form only")
    file = largest()
    with TemporaryDirectory() as name:
        folder = Path(name)
        tiny = middle([run(folder, {"p.xml": policy(node("a", topics("publish", ["t"])))}) for _ in range(ROUNDS)])
        plain = middle([run(folder, {"p.xml": file.read_text("utf-8")}) for _ in range(ROUNDS)])
        for shape, (files, *arguments) in shapes().items():
            yield Row(f"per kB: {shape}", file.name, partial(_beside, folder, files, arguments, tiny, plain))


def _beside(folder: Path, files: Mapping[str, str], arguments: list[str], tiny: Cost, plain: Cost) -> Measured:
    """Compare what each kB of an input costs with what each of a real one does, beyond what a tiny one costs."""
    cost = run(folder, files, *arguments)
    each = [(one.seconds - tiny.seconds) / one.size for one in (cost, plain)]
    space = [(one.megabytes - tiny.megabytes) / one.size for one in (cost, plain)]
    size = f"{cost.size / 1e3:,.1f} kB, {cost.megabytes - tiny.megabytes:,.0f} MB; memory {space[0] / space[1]:,.1f}"
    ours, other = (f"{one * 1e6:,.2f} ms" for one in each)
    return Measured(ours, other, each[0] / each[1], f"{size}; exit code {cost.code}")


def run(folder: Path, files: Mapping[str, str], *arguments: str) -> Cost:
    """Analyse files in a fresh process."""
    for name, text in files.items():
        (folder / name).write_text(text, "utf-8")
    command = [sys.executable, "-m", "rosprivacy", "analyze", *(arguments or ("p.xml",)), "--quiet"]
    with Popen(command, cwd=folder, stdout=DEVNULL, stderr=DEVNULL) as process:
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    size = sum(len(text.encode()) for text in files.values())
    return Cost(used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, size, process.returncode)


def middle(costs: Iterable[Cost]) -> Cost:
    """Return the cost with the median of seconds and of memory."""
    costs = list(costs)
    return Cost(median(c.seconds for c in costs), median(c.megabytes for c in costs), costs[0].size, costs[0].code)


def largest() -> Path:
    """Return the largest public policy that stands alone."""
    files = [path for path in (corpus() / "policies").rglob("*.xml") if b"XInclude" not in path.read_bytes()]
    return max((path for path in files if b"<policy" in path.read_bytes()), key=lambda path: path.stat().st_size)


def shapes() -> dict[str, tuple[Mapping[str, str], Unpack[tuple[str, ...]]]]:
    """Return the files of each shape, and the arguments beside which they are read."""
    tiny = policy(node("a", topics("publish", ["t"])))
    with_labels, fleet = ("p.xml", "-l", "l.yaml"), ("--fleet", "f.yaml")
    return {
        "tiny profiles, an enclave each": ({"p.xml": each(4_000)},),
        "topics without a name": (
            {"p.xml": policy(node("a", f'<topics publish="ALLOW">{"<topic/>" * 20_000}</topics>'))},
        ),
        "nested elements": ({"p.xml": "<a>" * 100_000},),
        "a name of 4 MB": ({"p.xml": policy(node("a", topics("publish", ["n" * 2**22])))},),
        "includes that double at each step": (doubling(20), "p.xml"),
        "long wildcards that overlap": ({"p.xml": pairs([f"/*{'a*b' * 300}{i}*" for i in range(40)])},),
        "short wildcards that overlap": ({"p.xml": pairs([f"/*a{i}*" for i in range(800)])},),
        "wildcards over names": (
            {"p.xml": policy(node("w", topics("publish", [f"/*{'?' * i}" for i in range(400)])),
                             node("r", topics("subscribe", [f"/{'t' * 400}{i}" for i in range(400)])))},
        ),
        "DENYs with wildcards": ({"p.xml": denied(60)},),
        "an enclave of many nodes, enforced": ({"p.xml": each(1_100, "/e")}, "p.xml", "--view", "enforced"),
        "YAML of empty maps": ({"p.xml": tiny, "l.yaml": "labels: 1\nflows:\n" + "- {}\n" * 100_000}, *with_labels),
        "YAML of brackets": ({"p.xml": tiny, "l.yaml": "labels: 1\nnodes: " + "[" * 100_000}, *with_labels),
        "globs of labels over all names": ({"p.xml": each(1_500), "l.yaml": globs(1_500)}, *with_labels),
        "findings: 60 sources, 60 leaks, 3 kinds": (findings(60), *with_labels),
        "findings: 300 sources, 300 leaks, 3 kinds": (findings(300), *with_labels),
        "paths: a mesh of 1,250 nodes, 200 leaks": (mesh(1_250), *with_labels),
        "a fleet of 20 groups of 1,000,000": (
            {"p.xml": tiny, "f.yaml": FLEET + "".join(f"  - {group(1_000_000, i)}\n" for i in range(20))},
            *fleet,
        ),
        "a fleet of 200,000": ({"p.xml": tiny, "f.yaml": f"{FLEET}  - {{robots: 200000, model: m}}\n"}, *fleet),
        "a fleet of 1,000 in one domain": (
            {"p.xml": policy(node("a", topics("publish", ["/*"]), topics("subscribe", ["/*"]))),
             "f.yaml": f"{FLEET}  - {{robots: 1000, model: m, domain: d}}\n"},
            *fleet,
        ),
        "a number of 100,000 digits": (
            {"p.xml": tiny, "f.yaml": f"{FLEET}  - {{robots: {'9' * 100_000}, model: m}}\n"}, *fleet,
        ),
    }  # fmt: skip


def group(robots: int, number: int) -> str:
    """Return a group of a fleet."""
    return f"{{robots: {robots}, model: m, id: g{number}_*}}"


def policy(*profiles: str) -> str:
    """Return a policy with an enclave for each of some profiles."""
    enclaves = "".join(f'<enclave path="/e{i}"><profiles>{one}</profiles></enclave>' for i, one in enumerate(profiles))
    return f'<policy version="0.2.0"><enclaves>{enclaves}</enclaves></policy>'


def node(name: str, *groups: str) -> str:
    """Return a profile."""
    return f'<profile ns="/" node="{name}">{"".join(groups)}</profile>'


def topics(role: str, names: Iterable[str], rule: str = "ALLOW") -> str:
    """Return a group of topics."""
    return f'<topics {role}="{rule}">{"".join(f"<topic>{name}</topic>" for name in names)}</topics>'


def each(number: int, enclave: str = "") -> str:
    """Return a policy of nodes that publish one topic each, in enclaves of their own or in one."""
    nodes = [node(f"n{i}", topics("publish", [f"t{i}"])) for i in range(number)]
    return policy("".join(nodes)) if enclave else policy(*nodes)


def pairs(names: list[str]) -> str:
    """Return a policy in which half of some names are written and half are read."""
    half = len(names) // 2
    return policy(node("w", topics("publish", names[:half])), node("r", topics("subscribe", names[half:])))


def denied(number: int) -> str:
    """Return a policy of wildcards from which other wildcards are taken."""
    rules = (
        ("publish", "a", "ALLOW"),
        ("subscribe", "b", "ALLOW"),
        ("publish", "c", "DENY"),
        ("subscribe", "d", "DENY"),
    )
    groups = (topics(role, [f"/*{letter}{i}*" for i in range(number)], rule) for role, letter, rule in rules)
    return policy(node("a", *groups))


def doubling(steps: int) -> dict[str, str]:
    """Return a policy that includes a file twice, which includes another twice, and so on."""

    def include(number: int) -> str:
        return f'<xi:include href="{number}.xml" xpointer="xpointer(/profile/*)"/>'

    files = {
        f"{i}.xml": f'<profile {XI} ns="/" node="a">{include(i + 1) * 2}</profile>' for i in range(steps)
    }  # fmt: skip
    files[f"{steps}.xml"] = node("a", topics("publish", ["t"]))
    return files | {"p.xml": policy(node("a", include(0).replace("<xi:include", f"<xi:include {XI}")))}


def globs(number: int) -> str:
    """Return labels of globs that match many channels."""
    return "labels: 1\nchannels:\n" + "".join(f'  "/*{i}*": mundane\n' for i in range(number))


def findings(number: int) -> dict[str, str]:
    """Return as many sources as leaks, of three kinds each, around one topic."""
    kinds = "[Video, Voice, Location]"
    sources = [node(f"s{i}", topics("publish", ["/t"])) for i in range(number)]
    leaks = [node(f"l{i}", topics("subscribe", ["/t"])) for i in range(number)]
    labels = f"labels: 1\nnodes:\n  /s*: {{source: {kinds}}}\n  /l*: {{leak: {kinds}}}\n"
    return {"p.xml": policy(*sources, *leaks), "l.yaml": labels}


def mesh(number: int) -> dict[str, str]:
    """Return nodes that share topics at random, ten ways in and ten out of each."""
    random = Random(3)  # noqa: S311 - no secret

    def some() -> list[str]:
        return [f"/t{random.randrange(number)}" for _ in range(10)]

    nodes = [node(f"n{i}", topics("publish", some()), topics("subscribe", some())) for i in range(number)]
    labels = "labels: 1\nnodes:\n  /n0: {source: [Video]}\n  /n1: {source: [Voice]}\n  /n1??: {leak: [Video, Voice]}\n"
    return {"p.xml": policy(*nodes), "l.yaml": labels}
