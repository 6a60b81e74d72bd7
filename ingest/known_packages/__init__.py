"""What well-known packages say of their nodes: the shipped catalogue, a vendor's file, those of installed packages."""
