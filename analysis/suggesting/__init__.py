"""What a person could say of elements, as questions with their reasons; nothing here labels anything.

A provider is a pure function from facts to ``Evidence``; ``weighing.py`` joins what all of them found into proposals.
"""
