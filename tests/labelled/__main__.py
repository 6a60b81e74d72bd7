"""How good suggestions are on the labelled set: ``python -m tests.labelled [dev|held-out] [--wrong]``."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from rosprivacy.ontology.vocabulary import load
from tests.labelled.labelled_set import READERS, judged, kappa, said, systems
from tests.labelled.measuring import LOOKS, Share, measured


def main() -> None:
    """Print agreement, and precision and recall by what is looked at."""
    dev, held_out = systems()
    some = held_out if "held-out" in sys.argv else dev
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
            if "--wrong" in sys.argv:
                for name, pairs in result.wrong.items():
                    print("".join(f"    {name}: {' '.join(pair)}\n" for pair in pairs), end="")


def _shown(share: Share) -> str:
    low, high = share.interval()
    return f"{share.part}/{share.of} = {share.value:.2f} ({low:.2f} to {high:.2f})"


if __name__ == "__main__":
    main()
