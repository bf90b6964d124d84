"""The built-in problems, solved."""
