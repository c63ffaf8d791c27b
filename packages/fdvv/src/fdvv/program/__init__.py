"""Programs a device runs: model, file, compiler, checks, shipped library."""
