"""What an element type is worth: locking, order of convergence, patterns that its points do not see."""
