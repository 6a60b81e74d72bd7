"""The report: its size, how long Chromium takes to open it, and whether the time to make it grows with the findings.

The systems are made up: stations of a plant, each with cameras, microphones and trackers, a switch that nobody has
reviewed, filters, and places that let data out, so that a finding has several ways. Chromium and chromedriver are
needed.
"""

from __future__ import annotations

import sys
import time
from functools import partial
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from measure import REPOSITORY, Measured, NotMeasured, Row, shown, timed_or_counted

import rosprivacy
from rosprivacy.documents import document_of
from rosprivacy.report.document.contents import PATHS
from rosprivacy.report.page.figures import figures
from rosprivacy.report.page.html import html
from rosprivacy.report.page.outline import outline

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.result import Result

MOST_BYTES, MOST_SECONDS = 10 * 10**6, 3.0
SIZES, FEW = (250, 500, 1000), (50, 100, 200)  # findings
GROWTH = 2.3  # of the time, at most, for twice the findings
KINDS = ("Video", "Voice", "PersonTrack", "FaceTemplate", "Location")
SENSORS = LEAKS = 5
PER_STATION = SENSORS * LEAKS  # findings


def write_system(folder: Path, findings: int) -> tuple[str, str]:
    """Write a policy and labels with so many findings; return their names."""
    profiles: list[str] = []
    labels: list[str] = []
    for number in range(findings // PER_STATION):
        place, kind = f"/plant/station_{number:03}", KINDS[number % len(KINDS)]
        raw = [f"{place}/sensor_{i}/data" for i in range(SENSORS)]
        profiles += [_profile(f"{place}/sensor_{i}", [topic], []) for i, topic in enumerate(raw)]
        profiles.append(_profile(f"{place}/switch", [f"{place}/switched", f"{place}/spare"], raw))
        profiles.append(_profile(f"{place}/filter", [f"{place}/filtered"], [f"{place}/switched"]))
        read = [f"{place}/switched", f"{place}/filtered", f"{place}/spare"]
        profiles += [_profile(f"{place}/uplink_{i}", [], read[: 1 + i % len(read)]) for i in range(LEAKS)]
        labels += [f"  {place}/sensor_{i}: {{source: [{kind}]}}" for i in range(SENSORS)]
        labels += [f"  {place}/filter: {{sanitizer: {{{kind}: pseudonymise}}}}"]
        labels += [f"  {place}/uplink_{i}: {{leak: [{kind}]}}" for i in range(LEAKS)]
    policy, said = folder / f"{findings}.policy.xml", folder / f"{findings}.labels.yaml"
    inside = "\n".join(profiles)
    policy.write_text(
        f'<policy version="0.2.0"><enclaves><enclave path="/plant"><profiles>\n{inside}\n'
        "</profiles></enclave></enclaves></policy>\n",
        "utf-8",
    )
    said.write_text("\n".join(["labels: 1", "nodes:", *labels, ""]), "utf-8")
    return str(policy), str(said)


def _profile(node: str, writes: list[str], reads: list[str]) -> str:
    space, _, name = node.rpartition("/")
    rows = [("publish", topic) for topic in writes] + [("subscribe", topic) for topic in reads]
    lines = [f'<topics {role}="ALLOW"><topic>{topic}</topic></topics>' for role, topic in rows]
    return f'<profile ns="{space}" node="{name}">\n{chr(10).join(lines)}\n</profile>'


def made(result: Result) -> str:
    """Make the page of an analysis, as ``rosprivacy report`` does, with all its pictures."""
    told = outline(result.document(), "en", date="2026-01-01")
    return html(told, figures(document_of(result, (PATHS,)), told))


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured."""
    sizes = FEW if quick else SIZES
    with TemporaryDirectory() as name:
        folder = Path(name)
        results = [_analysed(folder, size) for size in sizes]
        for before, after in ((0, 1), (1, 2)):
            ours = f"making a report of {sizes[after]} findings"
            some = results[after], results[before]
            yield Row(ours, f"of {sizes[before]}", partial(_made, *some, quick=quick), GROWTH, counts=quick)
        if quick:
            return
        page = folder / "report.html"
        page.write_text(made(results[1]), "utf-8")
        yield Row(f"a report of {sizes[1]} findings", f"{MOST_BYTES / 10**6:g} MB", lambda: _size(page), bound=1)
        yield Row("it is open in Chromium", f"{MOST_SECONDS:g} s", lambda: _open(page, folder / "profile"), bound=1)


def _analysed(folder: Path, size: int) -> Result:
    policy, labels = write_system(folder, size)
    result = rosprivacy.analyze([policy], [labels])
    if len(result.analysis.findings) != size:
        sys.exit(f"{len(result.analysis.findings)} findings, not {size}: the system is not what it should be")
    return result


def _made(large: Result, small: Result, *, quick: bool) -> Measured:
    return timed_or_counted(5, lambda: made(large), lambda: made(small), quick=quick)


def _size(page: Path) -> Measured:
    bytes_, pictures = page.stat().st_size, page.read_text("utf-8").count("<figure")
    note = f"{pictures} pictures, {bytes_ / SIZES[1] / 1000:.1f} kB for each finding"
    return Measured(f"{bytes_ / 10**6:.2f} MB", f"{MOST_BYTES / 10**6:g} MB", bytes_ / MOST_BYTES, note)


def _open(page: Path, profile: Path) -> Measured:
    opened = _opened(page, profile, 9)
    note = f"from the call to the first frame after it is loaded; the slowest of {len(opened)}: {max(opened):.2f} s"
    return Measured(shown(opened), f"{MOST_SECONDS:g} s", median(opened) / MOST_SECONDS, note)


def _opened(page: Path, profile: Path, rounds: int) -> list[float]:
    """Seconds that Chromium takes to open a page, after one round that does not count."""
    sys.path.insert(0, str(REPOSITORY))
    from tests.helpers import browser as chrome

    if chrome.missing():
        raise NotMeasured(f"{', '.join(chrome.missing())} missing: apt-get install chromium chromium-driver")
    seconds = []
    with chrome.chromium(profile) as browser:
        for _ in range(rounds + 1):
            browser.get("about:blank")
            begin = time.perf_counter()
            browser.get(page.as_uri())
            browser.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")
            seconds.append(time.perf_counter() - begin)
            if len(browser.find_elements("css selector", "article.way")) != SIZES[1]:
                sys.exit("the page does not show every finding")
    return seconds[1:]
