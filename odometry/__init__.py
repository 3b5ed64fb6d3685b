"""Motion of skid-steer robots: runs, kinematic models, filters and evaluation.

Names are imported when they are first used, so that `import odometry` costs nothing.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
