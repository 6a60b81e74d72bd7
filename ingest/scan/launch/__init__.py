"""Launch files in Python, XML and YAML -> the nodes that they start, with names, remappings and parameters.

In: launch files and packages of a checkout. Out: ``LaunchedSystem`` of ``scan_facts.py``, one for each launch file at
the top. Nothing is run: what an argument or a condition leaves open is kept in every way.
"""
