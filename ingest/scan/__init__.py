"""A checkout -> the systems that it starts: nodes, channels, what lies outside ROS, and what could not be resolved.

In: a folder of sources, launch files, parameter files, descriptions, compose files. Out: facts of ``scan_facts.py``,
each with its place in the code; joined, one observation a system (rule S16).
"""
