"""What comes in: policies, label files and saved graphs -> the model; the model -> Neo4j.

In: files that anybody may have written. Out: ``Policy``, ``Labels``, ``FlowGraph``, each fact with file and line.
"""
