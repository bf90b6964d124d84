"""The examples of the source paper, reproduced: its numbers and figures beside what is computed here."""
