"""Pictures that a person explores: an analysis and an element in, out comes SVG whose boxes can be reached by keys."""
