"""Many runs: the jobs, the processes that do them, and the results of all together."""
