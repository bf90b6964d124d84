"""The parts of `make_path_study.py`: runs, arch, strip, pump, turning field and weight, energy, multipliers."""
