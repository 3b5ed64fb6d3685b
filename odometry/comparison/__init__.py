"""Models side by side on runs that they were not identified on.

In order: `split` (what each fit may use), `candidates` (models and parameter sets), `fitting` (the
models of each split), `evaluation` (errors on held-out windows), `whole_runs` (errors of whole
runs), `summary` and `statistics` (means, differences, intervals), `sentences`, `result`, `files`.
`compare` takes these steps.
"""
