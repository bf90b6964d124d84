"""Output of a solve: histories, summaries, files for ParaView and pictures."""
