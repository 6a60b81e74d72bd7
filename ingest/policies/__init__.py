"""SROS 2 policies in, out comes the flow graph (rules S1 to S6)."""
