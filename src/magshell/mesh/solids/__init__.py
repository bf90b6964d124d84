"""Mid-surfaces of solids of constant thickness."""
