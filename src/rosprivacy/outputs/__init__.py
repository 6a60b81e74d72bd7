"""What an answer gives beside its formats: an answer in, out come a table, a graph, reasons, files for a browser."""
