"""The commands, by subject. cli.py names them."""
