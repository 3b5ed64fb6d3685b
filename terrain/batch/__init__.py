"""Many runs: the jobs, who does them, and what comes of all of them together."""
