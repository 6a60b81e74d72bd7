"""Help with labels: policies, label files and source code in, out come suggestions, and lines for a label file."""
