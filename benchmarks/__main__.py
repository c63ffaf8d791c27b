"""Run the benchmarks that need no other data: ``python -m benchmarks``."""

from benchmarks import fit, twin, velocity_interpolation

for part in (fit, twin, velocity_interpolation):
    part.main()
    print()
