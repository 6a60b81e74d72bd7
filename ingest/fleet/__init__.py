"""A fleet file in, out comes one graph, in which a robot stands for all that are alike (S1, S9, S10)."""
