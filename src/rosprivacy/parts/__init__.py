"""A fleet in parts, for fleets past one machine: each part is analysed where it is, and only its border travels.

In: a fleet file. Out: the answer of ``systems/fleet_system.py``, and results as Parquet. ``workers.py`` is what is
done with one part, ``border.py`` and ``part_patterns.py`` are what its border says,
``distributed.py`` puts the parts together. ``fleet_in_parts.py`` is the way through. Parts are handed out to processes
of this machine (``processes.py``, and ``kept_parts.py`` for a run that goes on), or to Apache Spark, which
``session.py`` and ``parquet.py`` alone know.
"""
