"""Many runs of a scene at once: maps over its ranges, samples of what scatters."""
