"""The problem as immutable data: shell, supports, loads, field, and the course of the loading."""
