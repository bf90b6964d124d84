"""Sweeps: a problem solved for every combination of values of some of its keys."""
