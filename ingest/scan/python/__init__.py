"""Python code -> the nodes that it can create, their ends of channels, and what could not be resolved.

In: syntax trees of the files of a checkout. Out: ``CodeFacts`` of ``scan_facts.py``. Nothing is run: what an expression
can be is worked out from the text, over files, classes and callers.
"""
