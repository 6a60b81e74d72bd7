"""Leaks that are planted in a system, so that a test sees what hides them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import rosprivacy

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path


def planted(policy: str, folder: Path, every: int, ends: int) -> Iterable[tuple[Path, str]]:
    """A source and a leak at two nodes with a path between them, of each policy some."""
    nodes = [one for one in rosprivacy.analyze(policy).analysis.graph.elements if one.is_node]
    for source in nodes[::every]:
        file = folder / "planted.yaml"
        start = f'labels: 1\nnodes:\n  "{source.name}": {{source: [Video]}}\n'
        file.write_text(start, "utf-8")
        reached = rosprivacy.analyze(policy, str(file)).analysis.carried
        arrived = [one.element for one in reached if one.element.is_node and one.element != source]
        for leak in arrived[:: max(1, len(arrived) - 1)][-ends:]:
            file.write_text(f'{start}  "{leak.name}": {{leak: [Video]}}\n', "utf-8")
            yield file, f"{source.name} -> {leak.name}"
