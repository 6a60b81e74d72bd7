"""What only ``mitigate`` reads and writes: limits in, out come lines to deny and a patch."""
