"""What differs between two states: for CI (``diff``), and for whom assessed the earlier one (``report --since``).

In: two JSON documents of the contract. Out: what is new, gone and changed.
"""
