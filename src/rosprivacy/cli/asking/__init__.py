"""The conversation of ``suggest --ask``: single keys of a person, or of a file of keys, become labels in a file.

In: what is suggested, and a label file. Out: the file with each answer, written at once. ``dialogue.py`` is the way
through; what is asked, and what an answer means, stands in ``labelling``.
"""
