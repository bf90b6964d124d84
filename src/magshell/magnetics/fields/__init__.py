"""Magnetic fields: uniform, of magnets and coils, with a constant gradient, sampled on a grid, of any function."""
