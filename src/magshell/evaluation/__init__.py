"""Quantities of a converged state: point values, balance, and the outputs that files and pictures show."""
