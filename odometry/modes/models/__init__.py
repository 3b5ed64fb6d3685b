"""Sets of modes: their models, their files, how alike they are, and whether any fits."""
