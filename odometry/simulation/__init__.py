"""Skid-steer drives made from first principles, to test estimators that know nothing of them."""
