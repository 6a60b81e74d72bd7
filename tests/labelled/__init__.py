"""Nodes of public systems that two readers labelled without knowing the rules: how good suggestions are."""
