"""Types are checked with the stubs of new packages: older ones say less of arrays."""

import numpy as np
import pytest

LOWEST = "2.4"
needs_new_stubs = pytest.mark.skipif(
    np.lib.NumpyVersion(np.__version__) < f"{LOWEST}.0",
    reason=f"types are checked with the stubs of NumPy {LOWEST} or newer",
)
