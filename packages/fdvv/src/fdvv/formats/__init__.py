"""Foreign files: readers of measured force curves, and exchange with other programs."""
