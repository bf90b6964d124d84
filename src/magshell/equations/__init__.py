"""From a model to equations: unknowns, their numbers, and the terms of the residual."""
