"""Elastic supports."""
