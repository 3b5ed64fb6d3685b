"""Effects that can be added to a kinematic model, one file each, by what they act on.

Names are imported when they are first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
