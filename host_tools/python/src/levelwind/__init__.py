"""The laptop tool of the levelwind controller."""
