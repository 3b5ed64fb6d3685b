"""Skid-steer vehicles on frictional contacts, from Newton's laws: the truth for tests of models.

Nothing here is taken from `odometry.models`. Vectors in the contact plane are complex numbers in
this folder: the real part is forward, the imaginary part to the left.
"""
