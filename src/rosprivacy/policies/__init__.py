"""Policies themselves: policies in, out comes what breaks a rule, is not deployed as written, or was never used."""
