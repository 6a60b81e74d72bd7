"""What labels mean on a graph: a graph and statements in, out comes what arrives where (rules S7, S8)."""
