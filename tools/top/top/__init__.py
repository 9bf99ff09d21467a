"""leonav-top: health, solution, satellites and streams in a terminal."""
