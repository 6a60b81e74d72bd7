"""Kinds of personal data: Turtle -> the hierarchy of categories, with their names and labels.

In: ``categories.ttl``. Out: a ``Vocabulary``.
"""
