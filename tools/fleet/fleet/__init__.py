"""Many runs of leonav's programs, spread over worker processes: the modules of leonav-fleet."""
