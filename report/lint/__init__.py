"""Broken rules in, out come lines for the terminal, the JSON document and SARIF."""
