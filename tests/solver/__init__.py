"""Newton's method, load stepping and what they say when they fail."""
