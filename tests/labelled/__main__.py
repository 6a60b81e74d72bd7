"""How good suggestions are on the labelled set: ``python -m tests.labelled [dev|held-out] [--wrong] [--missed]``."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.ontology.vocabulary import load
from tests.labelled.labelled_set import READERS, judged, kappa, labelled, said, systems
from tests.labelled.measuring import LOOKS, Share, measured

if TYPE_CHECKING:
    from collections.abc import Iterable

    from tests.labelled.labelled_set import Pair, System


def main() -> None:
    """Print agreement, and precision and recall by what is looked at."""
    dev, held_out = systems()
    chosen = held_out if "held-out" in sys.argv else dev
    some = labelled(chosen)
    if len(some) < len(chosen):
        print(f"{len(chosen) - len(some)} systems are collected and not labelled yet; they are not measured")
    if not some:
        return
    one, other = (said(reader, some) for reader in READERS)
    truth = judged(some, load().hierarchy.overlaps)
    print(f"{len(some)} systems, {sum(len(system.nodes) for system in some)} nodes")
    print(f"statements: {len(one)} and {len(other)}; equal {len(one & other)} of {len(one | other)}")
    print(f"agreed {len(truth.agreed)}, disputed {len(truth.disputed)}, kappa {kappa(some):.2f}")
    with tempfile.TemporaryDirectory() as folder:
        for look in LOOKS:
            result = measured(some, look, Path(folder))
            print(f"\n{look.name}")
            for title, shares in (("precision", result.precision), ("recall", result.recall)):
                print(f"  {title}: " + "; ".join(f"{name} {_shown(share)}" for name, share in shares.items()))
            print(f"  sources by that kind or a narrower one: {_shown(result.by_that_kind)}")
            print(f"  sources of nodes of which any source is suggested: {_shown(result.asked_about)}")
            print(f"  missed of nodes of which nothing is suggested: {_shown(result.unseen)}")
            if "--wrong" in sys.argv:
                for name, pairs in result.wrong.items():
                    print("".join(f"    {name}: {' '.join(pair)}\n" for pair in pairs), end="")
            if "--missed" in sys.argv:
                print("".join(f"    missed: {' '.join(pair)}\n{_facts(some, pair)}" for pair in result.missed), end="")


def _facts(some: Iterable[System], pair: Pair) -> str:
    """What the program was told of a node."""
    node = next(system.nodes[pair.node] for system in some if system.name == pair.system)
    return "".join(f"        {key}: {node[key]}\n" for key in node if node[key])


def _shown(share: Share) -> str:
    low, high = share.interval()
    return f"{share.part}/{share.of} = {share.value:.2f} ({low:.2f} to {high:.2f})"


if __name__ == "__main__":
    main()
