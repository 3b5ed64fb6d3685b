"""Terrain ahead of a skid-steer robot: features, classifier, camera, and the main job.

Names are imported when they are first used, so that `import terrain` costs nothing.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
