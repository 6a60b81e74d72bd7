"""Policies in, out comes what is wrong with how they are written: rules with an id, each at its line (rules S4, S5)."""
