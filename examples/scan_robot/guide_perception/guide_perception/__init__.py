"""What the guide sees and hears."""
