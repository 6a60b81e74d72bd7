"""The two forms of the fixpoint, on integers and on arrays: each is the other's measure, bit for bit (rule S8)."""

from __future__ import annotations

import random
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.kernel import least_solution as chosen
from rosprivacy.analysis.kernel.arrays import solved
from rosprivacy.analysis.kernel.backward import Opened, backward
from rosprivacy.analysis.kernel.labelled_graph import LabelledGraph
from rosprivacy.analysis.kernel.least_solution import SMALL, least_solution, worklist
from rosprivacy.analysis.kernel.spreading import spread
from tests.helpers.systems import System, systems


def random_graph(seed: int, count: int, edges: int, width: int) -> LabelledGraph:
    rng = random.Random(seed)  # noqa: S311 - a case, no secret
    some = rng.sample(range(count), rng.randint(0, count))
    sources, targets = ([rng.randrange(count) for _ in range(edges)] for _ in range(2))
    derivations = [(rng.randrange(count), rng.randrange(width), rng.randrange(width)) for _ in range(rng.randint(0, 6))]
    return LabelledGraph(
        count,
        rng.randint(0, count),
        sources,
        targets,
        (),
        (1 << width) - 1,
        {v: rng.getrandbits(width) & rng.getrandbits(width) for v in some[: 1 + count // 5]},
        {v: rng.getrandbits(width) for v in some[count // 3 :]},
        derivations,
    )


@given(st.integers(0, 2**32), st.integers(1, 40), st.integers(0, 120), st.integers(1, 200))
def test_both_forms_give_the_same_in_the_same_order(seed: int, count: int, edges: int, width: int) -> None:
    graph = random_graph(seed, count, edges, width)
    on_integers, on_arrays = worklist(graph), solved(graph)
    assert on_integers == on_arrays
    assert [list(bits) for bits in on_integers] == [list(bits) for bits in on_arrays]


@given(systems())
def test_a_system_spreads_alike_in_both_forms(system: System) -> None:
    try:
        small = spread(system.graph(), system.bound(), system.hierarchy)
    except InputErrors:  # labels that contradict each other
        return
    places = {v: bits for v, bits in small.leaks.items() if bits}
    opened = Opened(dict.fromkeys(list(small.keeps)[:2], small.all_bits))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(chosen, "SMALL", -1)
        large = spread(system.graph(), system.bound(), system.hierarchy)
        behind = backward(small, places), backward(small, places, opened)
    for name in ("arrives", "leaves", "sent"):
        assert list(getattr(small, name).items()) == list(getattr(large, name).items())
    assert (backward(small, places), backward(small, places, opened)) == behind


@pytest.mark.parametrize(("edges", "imported"), [(SMALL, "False"), (SMALL + 1, "True")])
def test_size_alone_chooses_the_form(edges: int, imported: str) -> None:
    code = (
        "import sys\nfrom rosprivacy.analysis.kernel.labelled_graph import LabelledGraph\n"
        "from rosprivacy.analysis.kernel.least_solution import least_solution\n"
        f"graph = LabelledGraph(2, 2, [0] * {edges}, [1] * {edges}, (), 1, {{0: 1}}, {{}}, [])\n"
        "assert least_solution(graph) == ({1: 1}, {0: 1, 1: 1})\nprint('numpy' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == imported


def test_flows_that_are_vertices_are_not_in_the_solution() -> None:
    graph = LabelledGraph(2, 2, [0, 2], [2, 1], (0,), 1, {0: 1}, {2: 1}, [])
    assert least_solution(graph) == ({1: 1}, {0: 1, 1: 1})
