"""Fleets past one machine: the analysis in parts, on Apache Spark.

In: a fleet file. Out: the answer of ``reading/fleet_system.py``, and results as Parquet. ``fleet_on_spark.py`` is the
way through, ``distributed.py`` what is put together, ``workers.py`` what is done with each part, ``session.py`` all
that is Spark.
"""
