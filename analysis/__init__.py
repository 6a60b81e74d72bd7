"""What the program means: graph and labels in, findings out.

In: a ``FlowGraph`` and the statements that labels make about its elements. Out: an ``Analysis``.
Pure: no files, no database; imports nothing of ours.
"""
