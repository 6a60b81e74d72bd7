"""A ``Document`` in, out comes a file that the PIA tool of the CNIL imports."""
