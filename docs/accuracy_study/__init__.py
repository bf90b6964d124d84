"""The parts of `make_accuracy_study.py`: one module for each question, and what they share."""
