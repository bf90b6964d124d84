"""What a solve leaves behind: histories, summaries, files for ParaView and pictures."""
