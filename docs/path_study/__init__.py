"""The parts of `make_path_study.py`: runs, the arch, the strip, the pump, turning field and weight, energy."""
