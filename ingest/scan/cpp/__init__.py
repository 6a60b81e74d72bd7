"""C++ code -> the nodes that it can make, their ends of channels, and what could not be resolved.

In: files of a checkout, parsed by tree-sitter. Out: ``CodeFacts`` of ``scan_facts.py``. Nothing is built or run.
"""
