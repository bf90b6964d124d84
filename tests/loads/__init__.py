"""Mechanical loads."""
